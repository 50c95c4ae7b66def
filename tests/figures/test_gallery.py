"""The gallery of effects: every effect has its entry, and a picture is drawn from its numbers alone."""

from sonicvacuum.effects import CATALOGUE
from sonicvacuum.figures import gallery


def test_every_effect_has_its_entry_with_equation_and_picture():
    text = gallery.page("pictures")
    for effect in CATALOGUE:
        assert f"(`{effect.id}`)" in text
        assert effect.equation.replace("*", "&#42;") in text
        assert f"](pictures/{effect.id}.svg)" in text


def test_every_effect_can_be_shown_on_some_chain():
    known = list(gallery.setups())
    assert all(any(effect.why_not(setup) is None for setup in known) for effect in CATALOGUE)


def test_a_picture_is_drawn_from_its_table(tmp_path):
    table = tmp_path / "one.csv"
    rows = ["g6,0,0,0", "g6,1,2,1", "wall,0,0,0", "wall,1,4,3"]
    table.write_text("\n".join([",".join(gallery.COLUMNS), *rows]) + "\n")
    gallery.draw(table, tmp_path / "one.svg")
    first = (tmp_path / "one.svg").read_bytes()
    gallery.draw(table, tmp_path / "one.svg")
    assert (tmp_path / "one.svg").read_bytes() == first
