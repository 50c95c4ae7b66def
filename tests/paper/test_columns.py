"""The columns of the ledger in a configuration: what is misspelt is told, what a case lacks is not."""

import pytest

from sonicvacuum.files import InputError
from sonicvacuum_paper.columns import read


@pytest.fixture
def written(pytestconfig, tmp_path):
    """Call: path of the project's configuration with one text in place of another."""
    text = (pytestconfig.rootpath / "config.yaml").read_text(encoding="utf-8")

    def write(before, after):
        assert before in text
        path = tmp_path / "config.yaml"
        path.write_text(text.replace(before, after), encoding="utf-8")
        return path

    return write


@pytest.mark.parametrize(
    ("before", "after", "told"),
    [
        ("  layer: [", "  layr: [", r"ledger\.layr: the ledger has no such column; did you mean layer\?"),
        ("  ideal: [", "  own: [", r"ledger\.own: the ledger has no such column; the columns are handbook, "),
        (
            "[matched, nominal]",
            "[mached, nominal]",
            r"ledger\.matched\[0\]: is 'mached', which no case has as a variant; did you mean matched\?",
        ),
    ],
)
def test_a_misspelt_column_or_variant_is_told(written, before, after, told):
    with pytest.raises(InputError, match=f"config.yaml: {told}"):
        read(written(before, after))


def test_a_variant_that_no_case_has_leaves_its_column_empty(written):
    config = read(written("      matched-loss:", "      of-its-own:"))
    assert config.ledger["matched_loss"] == ["matched-loss", "nominal"]
