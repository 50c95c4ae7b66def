"""What is wrong with a record is said in one line: file, key or line, value and cure."""

import re

import numpy as np
import pytest
from record_cases import BALL, CONTENT, SCALARS, STRIKER, TRACES, content, put

from sonicvacuum.files import InputError
from sonicvacuum.records import read, signals
from sonicvacuum.records.reader import parse
from sonicvacuum.records.signals import Signals

SPEED = SCALARS[0]
SPHERE = STRIKER | {"shape": "sphere", "diameter_mm": 4.76}

# (changed keys, parts of the message in order)
WRONG_KEYS = [
    ({"colour": "red"}, ["colour", "unknown key"]),
    ({"chain__bead__radius_mm": 2.4}, ["chain.bead.radius_mm", "unknown key"]),
    ({"sensors__0__rc_us": 1000.0}, ["sensors[0].rc_us", "unknown key"]),
    ({"sensors__0__droop_us": 1e-3}, ["sensors[0].droop_us", "0.001", "convert it to us"]),
    ({"runs__1__observables__0__sensor": "near"}, ["runs[1].observables[0].sensor", "unknown key"]),
    ({"materials": {"brass": {"density_kg_m3": 8.5}}}, ["materials.brass.density_kg_m3", "in g/cm3"]),
    ({"materials": {"brass": {"yield_MPa": 2e8}}}, ["materials.brass.yield_MPa", "in Pa"]),
    ({"chain__beads": 10**30}, ["chain.beads", "1e+30", "correct the number"]),
    ({"sensors__0__sigma_N": 1e300}, ["sensors[0].sigma_N", "1e+300 N", "correct the number"]),
    ({"sensors__0__sigma_N": 1e-300}, ["sensors[0].sigma_N", "1e-300 N", "correct the number"]),
    ({"sensors__2__baseline_sigma_N": 1e300}, ["sensors[2].baseline_sigma_N", "1e+300 N"]),
    ({"sensors__2__drift_sigma_N": 1e300}, ["sensors[2].drift_sigma_N", "1e+300 N"]),
    ({"runs__1__observables__0__sigma": 1e-300}, ["runs[1].observables[0].sigma", "1e-300 m/s"]),
    ({"trigger_sigma_us": 1e-320}, ["trigger_sigma_us", "nearer to 0 than 1e-15", "write 0"]),
    ({"clock_rel_sigma": 1e-300}, ["clock_rel_sigma", "1e-300", "write 0"]),
    ({"runs__0__striker__speed_rel_sigma": 1e-320}, ["runs[0].striker.speed_rel_sigma", "write 0"]),
    ({"tolerances": {"bead_mass_rel": 1e-320}}, ["tolerances.bead_mass_rel", "write 0"]),
    ({"format": None}, ["format", "missing"]),
    ({"format": 2}, ["format", "2", "format: 1"]),
    ({"chain__wall": None}, ["chain.wall", "missing"]),
    ({"runs": []}, ["runs", "[]"]),
    ({"runs__0__id": 7}, ["runs[0].id", "7", "quote it"]),
    ({"runs__0__id": "größe 6"}, ["runs[0].id", "'größe 6'", "letters, digits and _ . + - only (a to z"]),
    (
        {"runs__1__observables__0__shared": {"gauge places": 0.04}},
        ["observables[0].shared", "'gauge places'", "letters, digits and _ . + - only"],
    ),
    ({"sensors__0__kind": 3}, ["sensors[0].kind", "is 3", "write embedded or wall"]),
    ({"chain__beads": 16.5}, ["chain.beads", "16.5", "write a whole number"]),
    ({"runs__0__signals": "../x.csv"}, ["runs[0].signals", "'../x.csv'", "beside record.yaml"]),
    ({"runs__0__signals": "record.yaml"}, ["runs[0].signals", "record.yaml itself"]),
    ({"chain__orientation": "upright"}, ["chain.orientation", "'upright'", "vertical or horizontal"]),
    ({"runs__0__striker__shape": "cylinder"}, ["runs[0].striker.shape", "'cylinder'", "flat or sphere"]),
    ({"chain__bead__mass_g": "0.44 g"}, ["chain.bead.mass_g", "'0.44 g'", "without quotes or unit"]),
    ({"chain__bead__mass_g": "4e-1"}, ["chain.bead.mass_g", "'4e-1'", "YAML reads this as text"]),
    ({"chain__bead__mass_g": -0.4}, ["chain.bead.mass_g", "-0.4", "> 0", "write a number above 0"]),
    ({"chain__static_force_N": float("inf")}, ["chain.static_force_N", "inf", "finite"]),
    ({"runs__1__observables__0__value": float("nan")}, ["runs[1].observables[0].value", "nan", "finite"]),
    ({"chain__beads": 0}, ["sensors", "sensors: []"]),
    ({"chain__bead__coating_um": 50}, ["chain.bead", "coating_um is given without core"]),
    ({"chain__bead__core": "brass"}, ["chain.bead", "core is given without coating_um"]),
    ({"chain__bead__material": "unobtainium"}, ["chain.bead.material", "'unobtainium'", "modulus_GPa"]),
    ({"runs__1__striker__material": "cheese"}, ["runs[1].striker.material", "'cheese'", "not in the table"]),
    ({"sensors__0__bead": 11}, ["sensors[0].bead", "11", "10 beads"]),
    ({"sensors__0__bead": None}, ["sensors[0].bead", "missing"]),
    ({"sensors__2__bead": 10}, ["sensors[2].bead", "drop the key"]),
    ({"sensors__1__id": "near"}, ["sensors[1].id", "'near'", "must differ"]),
    ({"sensors__1__id": "time_us"}, ["sensors[1].id", "column of the times"]),
    ({"runs__1__id": "slow"}, ["runs[1].id", "'slow'", "must differ"]),
    ({"sensors__0__sigma_N": 0.0}, ["sensors[0].sigma_N", "noise"]),
    ({"runs__0__signals": None}, ["runs[0]", "'slow'", "neither signals nor observables"]),
    ({"runs__0__striker": STRIKER | {"shape": "sphere"}}, ["runs[0].striker.diameter_mm", "missing"]),
]

WRONG_OBSERVABLES = [
    ({"quantity": "velocity"}, ["quantity", "'velocity'", "known: speed, amplitude"]),
    ({"quantity": 3}, ["quantity", "3", "known: speed"]),
    ({"to": None}, ["to", "missing"]),
    ({"quantity": None}, ["quantity", "missing"]),
    ({"unit": "km/h"}, ["unit", "'km/h'", "given in m/s"]),
    ({"bound": "below"}, ["bound", "'below'"]),
    ({"shared": {"places": 4.1}}, ["shared.places", "4.1", "in %: divide it by 100"]),
    ({"shared": {"gauge": 0.1, "places": "4%"}}, ["shared.places", "'4%'", "float"]),
    ({"shared": {"places": -0.1}}, ["shared.places", "-0.1", ">"]),
    (
        SCALARS[4] | {"from": None, "to": None, "shared": {"places": 0.1}},
        ["shared", "a count has no relative error"],
    ),
    ({"from": "nowhere"}, ["from", "'nowhere'", "near, far, wall"]),
    ({"to": "near"}, ["to", "same place"]),
    ({"sigma": 0.0}, ["sigma", "standard error"]),
    ({"sigma": -1.0}, ["sigma", "-1.0"]),
    ({"quantity": "contact_duration", "from": None, "to": None, "unit": "us"}, ["quantity", "beads: 0 only"]),
]

WRONG_UNITS = [
    ({"chain__bead__diameter_mm": 0.00476}, ["chain.bead.diameter_mm", "0.00476 mm", "in m "]),
    ({"chain__bead__diameter_mm": 4760.0}, ["chain.bead.diameter_mm", "in um:"]),
    ({"chain__bead__diameter_mm": 0.476}, ["chain.bead.mass_g", "density", "diameter in cm"]),
    ({"chain__bead__mass_g": 0.00044}, ["chain.bead.mass_g", "density", "mass in kg"]),
    ({"chain__bead__mass_g": 440.0}, ["chain.bead.mass_g", "density", "mass in mg"]),
    (
        {"materials__stainless-steel__modulus_GPa": 193e9},
        ["materials.stainless-steel.modulus_GPa", "in Pa:", "convert it to GPa"],
    ),
    ({"materials__stainless-steel__modulus_GPa": 193e3}, ["stainless-steel.modulus_GPa", "in MPa"]),
    ({"materials__ptfe": {"modulus_GPa": 500.0}}, ["materials.ptfe.modulus_GPa", "the table has", "in MPa:"]),
    (
        {"materials__stainless-steel__modulus_rel_sigma": 5.0},
        ["modulus_rel_sigma: is 5, outside 0 to 2; ", "in %: divide it by 100"],
    ),
    ({"runs__0__striker__speed_m_s": 440.0}, ["runs[0].striker.speed_m_s", "mm/s"]),
    ({"runs__0__striker__speed_rel_sigma": 3.0}, ["runs[0].striker.speed_rel_sigma", "in %:"]),
    ({"runs__0__striker__mass_g": 0.00047}, ["runs[0].striker.mass_g", "in kg:"]),
    ({"runs__0__striker": SPHERE | {"mass_g": 0.00044}}, ["runs[0].striker.mass_g", "mass in kg"]),
    ({"chain__bead__coating_um": 5e-5, "chain__bead__core": "brass"}, ["chain.bead.coating_um", "in m "]),
    ({"chain__static_force_N": 2e4}, ["chain.static_force_N", "in mN:"]),
]

WRONG_VALUES = [
    (SCALARS[0] | {"value": 0.58}, ["0.58 m/s", "km/s"]),
    (SCALARS[0] | {"value": 580e3}, ["mm/s"]),
    (SCALARS[1] | {"value": 13000.0}, ["N", "in mN:"]),
    (SCALARS[1] | {"value": 0.013}, ["N", "in kN:"]),
    (SCALARS[2] | {"value": 32e-6}, ["us", "in s:"]),
    (SCALARS[2] | {"value": 0.032}, ["us", "in ms:"]),
    (SCALARS[2] | {"value": 32e3}, ["us", "in ns:"]),
    (SCALARS[5] | {"value": 980.0}, ["in %:"]),
    (SCALARS[7] | {"value": 95.0}, ["is 95, outside -1 to 1.2; ", "in %: divide it by 100"]),
]


def refused(folder, parts, file="record.yaml", base=CONTENT, **changes):
    with pytest.raises(InputError) as caught:
        read(put(folder, base, **changes))
    said(str(caught.value), [file, *parts])


def said(message, parts):
    """All parts, in this order, on one line."""
    assert "\n" not in message
    assert re.search(".*".join(re.escape(p) for p in parts), message), message


@pytest.mark.parametrize(("changes", "parts"), WRONG_KEYS, ids=lambda c: " ".join(c)[:40])
def test_wrong_key(tmp_path, changes, parts):
    refused(tmp_path, parts, **changes)


@pytest.mark.parametrize(("changes", "parts"), WRONG_OBSERVABLES, ids=lambda c: " ".join(c)[:40])
def test_wrong_observable(tmp_path, changes, parts):
    changed = {k: v for k, v in (SPEED | changes).items() if v is not None}
    refused(tmp_path, ["runs[1].observables[0]", *parts], runs__1__observables=[changed])


@pytest.mark.parametrize(("changes", "parts"), WRONG_UNITS, ids=lambda c: " ".join(c)[:40])
def test_suspected_unit(tmp_path, changes, parts):
    refused(tmp_path, parts, **changes)


@pytest.mark.parametrize(("observable", "parts"), WRONG_VALUES, ids=lambda c: str(c)[:30])
def test_suspected_unit_of_a_scalar(tmp_path, observable, parts):
    refused(tmp_path, ["runs[1].observables[0].value", *parts], runs__1__observables=[observable])


@pytest.mark.parametrize(
    ("changes", "parts"),
    [
        ({"runs__0__striker__shape": "flat"}, ["runs[0].striker.shape", "the striker is the ball"]),
        ({"runs__0__observables": [SPEED]}, ["quantity", "'speed'", "restitution or contact_duration"]),
        ({"runs__0__signals": "x.csv"}, ["runs[0].signals", "no sensors"]),
    ],
)
def test_one_ball_has_its_own_rules(changes, parts):
    with pytest.raises(InputError) as caught:
        parse(content(BALL, **changes), "record.yaml")
    said(str(caught.value), ["record.yaml", *parts])


def test_duplicate_key_and_broken_yaml_name_their_line(tmp_path):
    folder = put(tmp_path)
    text = (folder / "record.yaml").read_text()
    (folder / "record.yaml").write_text(text + "title: again\n")
    with pytest.raises(InputError, match=r"record\.yaml, line \d+: key 'title' stands here twice"):
        read(folder)
    (folder / "record.yaml").write_text(text + "runs: [\n")
    with pytest.raises(InputError, match=r"record\.yaml, line \d+: not valid YAML"):
        read(folder)


@pytest.mark.parametrize("name", ["record.yaml", "slow.csv", "fast.csv"])
def test_a_file_that_is_written_while_it_is_read_is_told(tmp_path, monkeypatch, name):
    """Else its SHA-256, which a verdict keeps, would be that of other numbers."""
    folder, whole = put(tmp_path), signals.read

    def read_while_someone_writes(path, ids):
        found = whole(path, ids)
        if path.name == "fast.csv":  # the last one
            (folder / name).write_text((folder / name).read_text() + "\n")
        return found

    monkeypatch.setattr(signals, "read", read_while_someone_writes)
    with pytest.raises(InputError, match=rf"{name}: was changed while it was read; try again"):
        read(folder)


def test_missing_folder_record_and_signals(tmp_path):
    with pytest.raises(InputError, match=r"nothing: no such folder"):
        read(tmp_path / "nothing")
    with pytest.raises(InputError, match=r"has no record\.yaml; sonicvacuum record new"):
        read(tmp_path)
    folder = put(tmp_path)
    (folder / "fast.csv").unlink()
    with pytest.raises(InputError, match=r"record\.yaml: runs\[1\]\.signals: is 'fast\.csv', .*put it there"):
        read(folder)
    (folder / "Fast.CSV").write_text("")
    with pytest.raises(InputError, match=r"did you mean Fast\.CSV\? Otherwise put it there"):
        read(folder)


def changed_rows(change):
    """fast.csv with its lines changed."""

    def edit(folder):
        lines = (folder / "fast.csv").read_text().splitlines()
        return "\n".join(change(lines)) + "\n"

    return edit


def cell(row, column, value):
    def change(lines):
        cells = lines[row].split(",")
        cells[column] = value
        return [*lines[:row], ",".join(cells), *lines[row + 1 :]]

    return changed_rows(change)


def header(text):
    return changed_rows(lambda lines: [text, *lines[1:]])


def scaled(column, factor):
    def edit(folder):
        trace = TRACES["fast"]
        time = trace.time_us * (factor if column == "time_us" else 1.0)
        forces = {k: r * (1.0 if column == "time_us" else factor) for k, r in trace.readings.items()}
        signals.write(Signals(time, forces), folder / "fast.csv")
        return (folder / "fast.csv").read_text()

    return edit


WRONG_TRACES = {
    "empty": (lambda folder: "", ["the file is empty", "time_us,near,far,wall"]),
    "header only": (changed_rows(lambda lines: lines[:1]), ["0 samples"]),
    "few samples": (changed_rows(lambda lines: lines[:10]), ["9 samples", "at least 16"]),
    "no header": (changed_rows(lambda lines: lines[1:]), ["line 1", "header is missing"]),
    "unknown column": (header("time_us,near,far,wall2"), ["line 1", "'wall2'", "no sensor"]),
    "no sensor at all": (
        changed_rows(lambda lines: [line.partition(",")[0] for line in lines]),
        ["line 1", "no sensor has a column", "time_us,near,far,wall"],
    ),
    "column twice": (header("time_us,near,near,wall"), ["line 1", "'near'", "twice"]),
    "time in s": (header("time_s,near,far,wall"), ["line 1", "time_us is missing", "'time_s'"]),
    "no time": (header("near,far,wall,x"), ["line 1", "time_us is missing"]),
    "semicolons": (changed_rows(lambda rows: [r.replace(",", ";") for r in rows]), ["line 1", "semicolons"]),
    "tabs": (changed_rows(lambda rows: [r.replace(",", "\t") for r in rows]), ["line 1", "tabs"]),
    "digits of another script": (
        changed_rows(lambda lines: [*lines[:4], lines[4] + "\u0663", *lines[5:]]),
        ["line 5", "not a number"],
    ),
    "row cut short": (changed_rows(lambda lines: [*lines[:-1], "189.75,0.1"]), ["line 801", "2 of 4"]),
    "decimal commas": (cell(20, 1, "0,5"), ["line 21", "5 cells", "decimal point"]),
    "text": (cell(33, 2, "overflow"), ["line 34", "column far", "'overflow'", "not a number"]),
    "unit": (cell(33, 2, "0.1 N"), ["line 34", "column far", "without unit"]),
    "no cell": (cell(33, 3, ""), ["line 34", "column wall", "empty"]),
    "NaN": (cell(50, 1, "nan"), ["line 51", "column near", "nan", "finite"]),
    "infinite": (cell(50, 1, "-inf"), ["line 51", "column near", "-inf"]),
    "too large": (cell(50, 1, "1e999"), ["line 51", "column near", "1e999", "finite"]),
    "row twice": (
        changed_rows(lambda lines: [*lines[:100], lines[99], *lines[100:]]),
        ["line 101", "column time_us", "must increase"],
    ),
    "row missing": (
        changed_rows(lambda lines: [*lines[:100], *lines[101:]]),
        ["line 101", "column time_us", "0.5 us", "0.25 us", "equidistant"],
    ),
    "uneven": (cell(400, 0, "89.6"), ["line 401", "column time_us", "equidistant"]),
    "times in s": (scaled("time_us", 1e-6), ["column time_us", "look like", "s"]),
    "times in ms": (scaled("time_us", 1e-3), ["column time_us", "look like ms"]),
    "times in ns": (scaled("time_us", 1e3), ["column time_us", "look like ns"]),
    "forces in mN": (scaled("force", 1e3), ["forces reach", "mN"]),
    "forces in kN": (scaled("force", 1e-3), ["forces reach", "kN"]),
    "clock time": (
        changed_rows(
            lambda rows: [
                rows[0], *(f"{1e6 + 0.25 * k},{r.split(',', 1)[1]}" for k, r in enumerate(rows[1:]))
            ]
        ),
        ["column time_us", "starts at", "moment of impact"],
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", WRONG_TRACES)
def test_wrong_trace(tmp_path, name):
    edit, parts = WRONG_TRACES[name]
    folder = put(tmp_path, sensors__0__sigma_N=1e-6, sensors__1__sigma_N=1e-6, sensors__2__sigma_N=1e-6)
    (folder / "fast.csv").write_text(edit(folder))
    with pytest.raises(InputError) as caught:
        read(folder)
    said(str(caught.value), ["fast.csv", *parts])


def test_binary_file_is_refused(tmp_path):
    folder = put(tmp_path)
    (folder / "fast.csv").write_bytes(bytes(np.arange(256, dtype=np.uint8)))
    with pytest.raises(InputError, match=r"fast\.csv: not a text file"):
        read(folder)


@pytest.mark.parametrize("mark", ["\ufeff", ""])
@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_byte_order_mark_windows_lines_blank_lines_and_column_order_do_not_matter(tmp_path, mark, end):
    folder = put(tmp_path)
    rows = [line.split(",") for line in (folder / "fast.csv").read_text().splitlines()]
    text = mark + end.join(", ".join((r[3], r[0], r[2], r[1])) for r in rows) + end + end
    (folder / "fast.csv").write_bytes(text.encode())
    found = read(folder).signals["fast"]
    assert np.array_equal(found.time_us, TRACES["fast"].time_us)
    assert all(np.array_equal(r, TRACES["fast"].readings[s]) for s, r in found.readings.items())


def test_times_printed_with_few_digits_are_equidistant_still(tmp_path):
    folder = put(tmp_path)
    time = np.round(TRACES["fast"].time_us * 1.3, 1)
    signals.write(Signals(time, TRACES["fast"].readings), folder / "fast.csv")
    found = read(folder).signals["fast"]
    # Errors of up to 0.05 us on 800 times leave the fitted interval uncertain by 6 * 0.05/800/0.325.
    assert found.interval_s == pytest.approx(0.325e-6, rel=1.2e-3)
