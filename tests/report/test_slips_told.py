"""Slips of the laboratory on the page and in the sentence of the command line."""

import math
from types import SimpleNamespace

import made_chains
import msgspec
import pytest
from made_verdicts import KINDS, model, verdict, write

from sonicvacuum.cli.discover import _sentence
from sonicvacuum.discover.faults.table import FAULTS, told
from sonicvacuum.discover.verdict import PUT_RIGHT, Fault, Verdict, write_json
from sonicvacuum.report import bench, record

SWAPPED = Fault(fault="gauges-swapped", run=None, sensor=["g9", "g5"], probability=0.998, value=None)


@pytest.mark.parametrize("fault", FAULTS)
def test_every_slip_has_words_for_the_bench(fault):
    # One id for a slip of all gauges in all runs and for that of one in one run.
    run, sensor = (None, None) if fault in map(told, set(FAULTS) - {fault}) else ("v1", "g4")
    one = Fault(fault=told(fault), run=run, sensor=sensor, probability=0.9, value=1.03)
    (line,) = bench.slips(verdict(faults=[one]))
    assert FAULTS[fault].check in line
    assert "{" not in line
    everywhere = Fault(fault=told(fault), run=None, sensor=None, probability=0.9, value=None)
    assert "None" not in bench.slips(verdict(faults=[everywhere]))[0]


def test_the_sentence_names_slips_first():
    text = _sentence(verdict(faults=[SWAPPED]))
    assert text.startswith(
        "check first: gauges g9 and g5 look swapped, or one of them taken for both (probability above 0.99); "
        "missing: kuwabara"
    )


def test_the_page_says_what_to_check_first_and_escapes_it(tmp_path):
    folder = write(tmp_path / "one", next(iter(KINDS)))
    odd = Fault(fault="run-off", run="<b>v1</b>", sensor=None, probability=0.9, value=1.2)
    reasons = [f"{PUT_RIGHT}: gauges-swapped"]
    write_json(verdict(faults=[SWAPPED, odd], reasons=reasons), folder / "verdict.json")
    text = record.write_page(folder).read_text()
    assert text.index("Check your set-up first") < text.index("Where they disagree")
    assert "Gauges g9 and g5 look swapped, or one of them taken for both: check the cables" in text
    assert "<b>v1</b>" not in text
    assert "All that follows is of the record with this put right: gauges swapped." in text


def test_a_time_zero_that_was_put_right_is_no_strain_besides():
    moved = msgspec.structs.replace(model(verdict()), speed_ratio={}, trigger_us={"fast": 9.0})
    late = [Fault(fault="time-zero", run="fast", sensor=None, probability=0.99, value=-13.0)]
    (line,) = bench.strained(verdict(faults=late), moved, made_chains.record())
    assert "time zero of run fast" in line
    right = verdict(faults=late, reasons=[f"{PUT_RIGHT}: time-zero"])
    assert bench.strained(right, moved, made_chains.record()) == []


def test_verdicts_without_slips_and_of_older_days_are_read():
    content = msgspec.to_builtins(verdict())
    del content["faults"]
    assert msgspec.convert(content, Verdict).faults == []
    with pytest.raises(msgspec.ValidationError, match="faults"):
        msgspec.convert(
            {**content, "faults": [{**msgspec.to_builtins(SWAPPED), "fault": "gremlins"}]}, Verdict
        )


def test_the_sentence_says_what_of_a_set_could_be_something_else():
    alike = [["kuwabara-kono", "tsuji"]]
    assert _sentence(verdict(confusable=alike)).endswith("(probability 0.97); could also be tsuji")
    pair = verdict(named=["gravity", "kuwabara-kono"], confusable=alike)
    assert _sentence(pair).endswith("; kuwabara-kono could also be tsuji")


@pytest.mark.parametrize(("kind", "unit"), [("embedded", "8.77 N"), ("acceleration", "8.77 m/s²")])
def test_what_a_gauge_reads_is_told_in_its_unit(kind, unit):
    drift = Fault(fault="drift", run=None, sensor="g1", probability=0.9, value=8.77)
    known = SimpleNamespace(gauges=[SimpleNamespace(id="g1", kind=kind, gain_rel_sigma=0.02)])
    assert bench.slip(drift, (known,)) == f"g1 drifts by {unit} over the record"
    uncalibrated = SimpleNamespace(gauges=[SimpleNamespace(id="g1", kind=kind, gain_rel_sigma=math.inf)])
    assert bench.slip(drift, (uncalibrated,)) == bench.slip(drift) == "g1 drifts by 8.77 over the record"


def test_no_verdict_is_certain_in_the_terminal():
    sure = _sentence(verdict(probabilities={"kuwabara-kono": 0.9999, "none": 0.0001}))
    assert sure == "kuwabara-kono (probability above 0.99)"


def test_spikes_are_counted_in_one_phrase():
    one = Fault(fault="spikes", run="shot1", sensor="p1", probability=0.999, value=4.0)
    (line,) = bench.slips(verdict(faults=[one]))
    assert line.startswith("Gauge p1 has 4 samples far off their neighbours in run shot1: check shielding")
