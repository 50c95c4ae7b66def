"""Mistakes of a configuration are named by the file and by the block in which they were written."""

import json
import re

import pytest

from sonicvacuum.config import Config, model, read
from sonicvacuum.files import InputError

STEEL = "stainless-steel"
CHAIN = {
    "beads": 10,
    "orientation": "vertical",
    "bead": {"diameter_mm": 4.76, "mass_g": 0.44, "material": STEEL},
    "wall": {"material": STEEL},
}
CASE = {
    "title": "steel",
    "chain": CHAIN,
    "striker": {"shape": "flat", "material": STEEL, "mass_g": 0.47, "speed_m_s": 0.44},
    "sensors": [{"id": "wall", "kind": "wall"}],
    "duration_us": 100.0,
}
HEAVY = CHAIN | {"bead": CHAIN["bead"] | {"mass_g": "heavy"}}


@pytest.mark.parametrize(
    ("overrides", "place"),
    [
        ({"model": {"record": "r", "specimen": 3}}, "variants.soft.model.specimen: is 3"),
        ({"model": {"specimen": "other"}}, "variants.soft.model.record: missing"),
        ({"striker": {"speed_m_s": "fast"}}, "variants.soft.striker.speed_m_s: is 'fast'"),
        ({"striker": {"speed_m_s": 1e4}}, "variants.soft.striker.speed_m_s: is 10000 m/s"),
        ({"chain": {"bead": {"mass_g": 0.001}}}, "variants.soft.chain.bead.mass_g: is 0.001 g"),
        ({"sensors": [{"id": "g", "kind": "embedded"}]}, "variants.soft.sensors[0].bead"),
    ],
)
def test_a_mistake_of_a_variant_is_named_where_it_was_written(tmp_path, overrides, place):
    path = tmp_path / "other.yaml"
    path.write_text(json.dumps({"cases": {"one": CASE | {"variants": {"nominal": {}, "soft": overrides}}}}))
    with pytest.raises(InputError, match=re.escape(f"{path}: cases.one.{place}")):
        read(path)


def test_a_mistake_of_the_case_is_not_laid_to_a_variant(tmp_path):
    path = tmp_path / "other.yaml"
    case = CASE | {"chain": HEAVY} | {"variants": {"soft": {"chain": {"beads": 9}}}}
    path.write_text(json.dumps({"cases": {"one": case}}))
    with pytest.raises(InputError, match=re.escape("cases.one.chain.bead.mass_g: is 'heavy'")):
        read(path)


def test_the_model_of_a_record_is_refused_by_file_and_variant():
    case = CASE | {"variants": {"soft": {"model": {"record": "r", "losses": "none"}}}}
    with pytest.raises(InputError, match=r"other\.yaml: cases\.one\.variants\.soft\.model\.losses"):
        model(Config(cases={"one": case}), "one", "soft", "other.yaml")


@pytest.mark.parametrize(
    ("changes", "place"),
    [
        ({"variants": -1}, "variants: expected name"),
        ({"variants": True}, "variants: expected name"),
        (
            {"effects": "tsuji", "variants": {"a": {"effects": {"tsuji": {"alpha": 0.1}}}}},
            "effects: is 'tsuji'",
        ),
        (
            {"chain": 7, "variants": {"a": {"chain": CHAIN}}},
            "chain: is 7; write keys and values, as variants.a",
        ),
    ],
)
def test_nothing_of_a_case_goes_unread(tmp_path, changes, place):
    path = tmp_path / "other.yaml"
    path.write_text(json.dumps({"cases": {"one": CASE | changes}}))
    with pytest.raises(InputError, match=re.escape(f"{path}: cases.one.{place}")):
        read(path)
