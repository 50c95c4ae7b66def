"""What the table of the gap says of the models of each round."""

from types import SimpleNamespace

import numpy as np
import pytest

from sonicvacuum.discover import written


@pytest.mark.parametrize(
    ("adopted", "rounds"),
    [
        ((), ["nominal", "a", "a+b"]),
        (("a",), ["nominal", "a", "a+b"]),
        (("b", "a"), ["nominal", "a", "a+b"]),
        (("a", "c"), ["nominal", "a", "a+b", "a+c"]),
    ],
)
def test_the_adopted_model_is_among_those_of_the_rounds(adopted, rounds):
    """Friction was adopted in a real record, beside much that is left; the gap stood for a heavier bead."""

    def model(*ids):
        chi2 = SimpleNamespace(chi2=np.array([[10.0 - len(ids)]]))
        return SimpleNamespace(effect="+".join(ids), effects=ids, fit=SimpleNamespace(normal=chi2))

    final = SimpleNamespace(hypothesis=SimpleNamespace(ids=adopted), normal=model(*adopted).fit.normal)
    found = SimpleNamespace(
        null=model().fit, candidates=[model("a"), model("b")], combinations=[model("a", "b")], final=final
    )
    told = written.rounds_of(found)
    assert [name for name, _ in told] == rounds
    assert [chi2 for _, chi2 in told[:3]] == [10.0, 9.0, 8.0]
