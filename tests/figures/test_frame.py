"""Axes of the pictures that are written as text: round ticks, places, curves that stay small."""

from xml.etree import ElementTree

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sonicvacuum.figures.drawing import Drawing, Stroke, Text
from sonicvacuum.figures.frame import Frame, Scale, thinned

LOWERED = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")
WHOLE = st.floats(-1e6, 1e6).map(lambda v: round(v, 3))


@given(low=WHOLE, size=st.floats(1e-2, 1e6), most=st.integers(2, 9))
def test_ticks_are_round_even_and_told_apart(low, size, most):
    scale = Scale(low, low + size)
    ticks = scale.ticks(most)
    assert len(ticks) <= most
    values, texts = zip(*ticks, strict=True)
    assert len(set(texts)) == len(texts)
    # Ends count as inside to the rounding of the steps.
    assert all(low - 1e-6 * size <= v <= low + size + 1e-6 * size for v in values)
    if len(values) > 2:
        assert np.diff(values) == pytest.approx(np.diff(values)[0], rel=1e-6)  # rounding of the multiples
    for value, text in zip(values, texts, strict=True):
        front, _, power = text.replace("−", "-").partition("·10")
        # Steps are written whole.
        told = float(front) * 10.0 ** int((power or "⁰").translate(LOWERED))
        assert told == pytest.approx(value, abs=1e-6 * size)


def test_numbers_are_written_as_people_do():
    assert [text for _, text in Scale(-1.1, 1.1).ticks(5)] == ["−1.0", "−0.5", "0.0", "0.5", "1.0"]
    assert [text for _, text in Scale(0.9, 1100.0, log=True).ticks(9)] == ["1", "10", "100", "10³"]
    assert [text for _, text in Scale(0.0, 2.1e-6).ticks(3)] == ["0", "1·10⁻⁶", "2·10⁻⁶"]
    # Less than a decade has no two powers of ten: ticks are then those of an even scale.
    assert [text for _, text in Scale(2.0, 8.5, log=True).ticks(4)] == ["2", "4", "6", "8"]


def test_values_stand_where_the_scales_say():
    frame = Frame(Drawing(100.0, 50.0), (10.0, 5.0, 80.0, 40.0), Scale(0.0, 4.0), Scale(1.0, 100.0, log=True))
    assert frame.place([0.0, 2.0, 4.0], [1.0, 10.0, 100.0]) == pytest.approx(
        np.array([(10.0, 5.0), (50.0, 25.0), (90.0, 45.0)])
    )
    # An SVG counts points from the upper left corner.
    assert frame.drawing.places([(25.4, 50.0)]) == pytest.approx(np.array([(72.0, 0.0)]))


def test_a_million_samples_stay_a_small_curve_with_all_its_peaks():
    x = np.arange(1e6)
    y = np.zeros(len(x))
    y[[123_456, 777_777]] = 5.0, -3.0
    shown = thinned(x, y)
    assert len(shown[0]) <= 2400
    assert (shown[1].max(), shown[1].min()) == (5.0, -3.0)
    assert np.all(np.diff(shown[0]) > 0.0)


def test_words_are_text_and_gaps_in_a_curve_stay_gaps():
    page = Drawing(50.0, 20.0)
    page.add(Text(5.0, 5.0, "<b> & \"'\nsecond", turned=60.0))
    frame = Frame(page, (10.0, 5.0, 30.0, 10.0), Scale(0.0, 3.0), Scale(0.0, 3.0))
    frame.curve([0.0, 1.0, 2.0, 3.0, 3.0], [0.0, 1.0, np.nan, 2.0, 3.0], Stroke())
    tree = ElementTree.fromstring(page.svg())
    name = "{http://www.w3.org/2000/svg}"
    assert [t.text for t in tree.iter(f"{name}text")] == ["<b> & \"'", "second"]
    assert [p.get("d").count("M") for p in tree.iter(f"{name}path")][-1] == 2
