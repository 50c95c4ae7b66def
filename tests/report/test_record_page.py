"""The page of a record says what its verdict says, whatever the outcome, and needs nothing but itself."""

import pytest
from made_verdicts import KINDS, verdict, write
from read_pages import Page, told

from sonicvacuum.discover.judge.strained import ONLY_WITH
from sonicvacuum.discover.verdict import write_json
from sonicvacuum.figures import discovery
from sonicvacuum.files import InputError
from sonicvacuum.physics import compiled
from sonicvacuum.report import misfit, record, words
from sonicvacuum.report.record import write_page


def test_what_the_nominal_model_strains_stands_where_it_disagrees_nowhere():
    said = f"{ONLY_WITH} the gain of gauge wall 1.93 times the stated one, 35 of its stated errors away"
    v = verdict(named=["kuwabara-kono"], where=[])
    cells = [{"sensor": "g1", "feature": "amplitude", "q_before": "0.9"}]
    plain = misfit.where(v, cells)
    v.reasons.append(said)
    assert "spread over them" in plain
    strained = misfit.where(v, cells)
    assert strained.endswith("The" + said[3:] + ": that is what speaks against it.")
    assert "spread over them" not in strained


SENTENCES = {
    "none": (
        "Nothing is named: the nominal model explains these data",
        "That none of the effects that these data could show is missing is probable (0.91)",
        "Nowhere: of 8 comparisons",
        "The nearest single effect: damping with constant restitution (0.08)",
        "No proposal: no rivals are left",
    ),
    "single": (
        "What is missing: Viscoelastic Hertz contact (kuwabara-kono)",
        "very probable (0.97)",
        "In 1 of 8 comparisons (run, gauge and feature of the trace)",
        "run fast, gauge g1: the data show a lower peak than predicted, by 12 standard errors",
        "1.980 ± 0.060 µs",
        "1.881 to 2.079",
        "falls from 80.70 to 1.050 (99.9 % of the gap closed)",
        "No other effect comes near",
        "with the striker at 1.25 m/s would most likely leave one explanation alone: viscoelastic Hertz "
        "contact and damping with constant restitution, its nearest rival there, would differ by about 5 "
        "standard errors",
        "Beside what was named these data cannot test: gravity along the chain",
    ),
    "class": (
        "one of viscoelastic Hertz contact or damping with constant restitution, which these data cannot",
        "together practically certain (0.99)",
        "These data cannot tell viscoelastic Hertz contact from damping with constant restitution.",
    ),
    "pair": (
        "Two effects are missing: Mass defect at bead 6 (mass-defect)",
        "sits at bead",
        "These data cannot tell viscoelastic Hertz contact from damping with constant restitution.",
        "mass-defect + kuwabara-kono",
    ),
    "unknown": (
        "Something is missing, and it is unknown",
        "practically certain (above 0.99)",
        "The nearest model that was found, which is not named, leaves 1.02",
    ),
    "scalars": (
        "In 1 of 2 comparisons (run and measured quantity)",
        "run fast: the measured restitution is lower than predicted",
        "restitution at most 0.85 ± 0.01 0.99 0.84 –",
        "Only the last column is a prediction",
        "There is one run only",
        "this record has none",
    ),
    "ball": ("(hunt-crossley)", "practically certain (above 0.99)", "0.0270 ± 0.0014"),
}


@pytest.mark.parametrize("kind", KINDS)
def test_the_page_can_be_read_aloud(folders, kind):
    text = told(folders[kind])
    for sentence in SENTENCES[kind]:
        assert sentence in text
    assert "nan" not in text.lower().replace("nanosecond", "")
    assert "None" not in text


@pytest.mark.parametrize("kind", KINDS)
def test_the_page_needs_nothing_but_itself_and_no_id_stands_twice(folders, kind):
    page = Page((folders[kind] / "index.html").read_text())
    assert page.fetched == []
    assert len(page.ids) == len(set(page.ids))


def test_no_colour_of_one_theme_is_spoken_of(tmp_path):
    """Cells without a comparison are white on white pages only."""
    folder = write(tmp_path / "gaps", "single")
    lines = (folder / "where.csv").read_text().splitlines()
    (folder / "where.csv").write_text("\n".join(lines[:-1]) + "\n")
    text = told(write_page(folder).parent)
    assert "unshaded where there is nothing to compare" in text
    assert "white where" not in text


def test_times_do_not_enter_the_page(folders):
    assert "12.345" not in told(folders["single"])


def test_the_same_verdict_gives_the_same_bytes(folders, tmp_path):
    again = write(tmp_path / "again", "pair")
    discovery.draw(again)
    record.write_page(again)
    for path in again.iterdir():
        assert path.read_bytes() == (folders["pair"] / path.name).read_bytes(), path.name


def test_a_folder_of_something_else_is_refused_with_the_file(tmp_path):
    with pytest.raises(InputError, match=r"verdict\.json: No such file"):
        record.write_page(tmp_path)
    folder = write(tmp_path / "made", "none")
    (folder / "verdict.json").write_text('{"named": 3}')
    with pytest.raises(InputError, match=r"verdict\.json: not what sonicvacuum discover writes"):
        record.write_page(folder)


def test_sets_that_come_near_are_told_where_no_single_effect_does():
    odds = {"unknown": 0.7, "mass-defect + tsuji": 0.2, "gravity + unknown": 0.1}
    told = words.alternatives(verdict(named=["unknown"], probabilities=odds, parameters={}))
    assert told == (
        "No single effect comes near. "
        "The nearest sets: mass defect and damping with constant restitution (0.20); gravity along the chain "
        "and something unknown (0.10)."
    )


def test_all_significant_comparisons_are_counted_and_not_only_those_kept():
    """The verdict keeps 40 at most; the page counts what where.csv holds."""
    cell = {"sensor": "g1", "feature": "amplitude", "z_before": "-9"}
    cells = [{**cell, "run": f"r{k}", "q_before": "1e-9" if k < 45 else "0.5"} for k in range(60)]
    told = misfit.where(verdict(where=KINDS["single"].where * 40), cells)
    assert "In 45 of 60 comparisons" in told
    assert "amplitude (45)" in told


def test_what_leaves_the_range_of_the_physics_stands_on_the_page(tmp_path):
    folder = write(tmp_path / "made", "single")
    told = "contact 3 is pressed by 200 um, 0.17 of its <effective> radius"
    write_json(verdict(warnings=[told]), folder / "verdict.json")
    page = write_page(folder).read_text(encoding="utf-8")
    assert "Beware: contact 3 is pressed by 200 µm, 0.17 of its &lt;effective&gt; radius." in page


def test_a_page_of_kept_templates_is_the_same(tmp_path, monkeypatch):
    folder = write(tmp_path / "found", "single")
    monkeypatch.setattr(compiled, "cache_folder", lambda: None)
    plain = write_page(folder).read_bytes()
    monkeypatch.setattr(compiled, "cache_folder", lambda: tmp_path)
    pages = [write_page(folder).read_bytes()]
    kept = sorted(tmp_path.glob("page-*.bin"))
    pages.append(write_page(folder).read_bytes())
    for one in kept:
        one.write_bytes(b"damaged")
    pages.append(write_page(folder).read_bytes())
    assert kept
    assert pages == 3 * [plain]


def test_sets_of_more_than_two_are_no_pairs(tmp_path):
    folder = write(tmp_path / "made", "pair")
    assert ">Pair tried<" in write_page(folder).read_text(encoding="utf-8")
    rows = (folder / "candidates.csv").read_text() + "gravity+mass-defect+tsuji,5700,1210,,gravity 1,\n"
    (folder / "candidates.csv").write_text(rows)
    assert ">Set tried<" in write_page(folder).read_text(encoding="utf-8")
