"""Time zeros that are stated as exact, or nearly, and are not: no verdict for minutes before."""

from dataclasses import replace
from types import SimpleNamespace

import msgspec
import numpy as np
import pytest
from made_records import DAMPING, made
from made_slips import altered

from sonicvacuum.discover import session
from sonicvacuum.discover.faults import changes, lines, timing, zeros
from sonicvacuum.discover.faults.competition import Search
from sonicvacuum.discover.faults.found import Bench, Finding
from sonicvacuum.discover.faults.judged import Judged
from sonicvacuum.discover.faults.judging import Judge
from sonicvacuum.discover.faults.slips import Slip
from sonicvacuum.discover.faults.weights import as_likely
from sonicvacuum.discover.model.nominal import predicted
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.effects import CATALOGUE
from sonicvacuum.report.bench import slip


def off(record, late_us, stated=0.0):
    """The record with each run's time zero off by so many us, and stated as known."""
    later = changes.time_zero(record, dict(zip(record.signals, late_us, strict=True)), 0.0)
    return replace(later, block=msgspec.structs.replace(later.block, trigger_sigma_us=stated))


def asked(record):
    """What is asked of a record."""
    return timing.unknown_zeros(record, predicted(experiment(record)))


def test_nothing_is_asked_where_time_zeros_are_not_known(empty):
    assert asked(off(empty, (0.0, 0.0), 50.0)) == []
    assert asked(off(empty, (0.0, 0.0), "unknown")) == []


def test_time_zeros_count_as_known_to_a_pulse(empty):
    (one,) = asked(off(empty, (5.0, -4.0)))
    right = one.change(off(empty, (5.0, -4.0)), 0.0)
    assert 20.0 < right.block.trigger_sigma_us < 100.0
    assert one.occam < 0.0


@pytest.mark.parametrize(("effects", "named"), [((), []), ([("kuwabara-kono", {"time_us": DAMPING})], None)])
@pytest.mark.parametrize("stated", [pytest.param(0.0, marks=pytest.mark.long), 0.01])
def test_time_zeros_of_runs_that_are_stated_as_exact_are_told(effects, named, stated):
    record = off(made(effects, seed=12, speeds=(0.3, 0.5, 0.9))[0], (5.0, -4.0, 3.0), stated)
    v = session.discover(record).verdict
    ((fault, run, value),) = [(f.fault, f.run, f.value) for f in v.faults if f.probability > 0.9]
    assert (fault, run, value) == ("time-zero", None, None)
    assert v.named == (["kuwabara-kono"] if named is None else named)
    assert slip(v.faults[0]) == "time zeros are not known as well as stated, each run having its own"


def test_the_time_zero_told_is_that_beside_the_effects():
    """Beside the nominal model alone damped pulses seem to come 12 us later."""
    record = off(made([("kuwabara-kono", {"time_us": 1.0})], seed=12)[0], (-130.0, -130.0), 1.0)
    v = session.discover(record).verdict
    ((fault, value),) = [(f.fault, f.value) for f in v.faults if f.probability > 0.9]
    assert (fault, v.named) == ("time-zero", ["kuwabara-kono"])
    # Triggers scatter by 1 us, by which the mean of two is off.
    assert value == pytest.approx(130.0, abs=2.0)


@pytest.mark.parametrize(("late", "kept"), [((0.0, 0.0), 0), ((9.0, -8.0), 1)])
def test_time_zeros_that_effects_find_as_stated_were_no_slip(late, kept):
    """A slip that was told before the effect was known is withdrawn, unless the effect needs it too."""
    record = off(made([("kuwabara-kono", {"time_us": DAMPING})], seed=12)[0], late, 1.0)
    search = Search(Bench(record), CATALOGUE, 1, [])
    search.bench = Bench(changes.time_zero(record, {}, 60.0))
    search.findings = [Finding("time-zero", corrected=True)]
    found = search._zeros_as_stated(search._investigate())
    assert (found.named, len(search.findings)) == (["kuwabara-kono"], kept)
    assert search.bench.record.block.trigger_sigma_us == (60.0 if kept else 1.0)


def test_time_zeros_that_effects_find_as_stated_but_for_one_run_are_that_run_s():
    """A pulse that the effect delays in all runs hid by how much one was late, and in which."""
    record, nu = made([("kuwabara-kono", {"time_us": DAMPING})], seed=12)
    search = Search(Bench(off(record, (0.0, 9.0), 1.0)), CATALOGUE, 1, [])
    search.bench = Bench(changes.time_zero(search.bench.record, {}, 60.0))
    search.findings = [Finding("time-zero", probability=0.9, corrected=True)]
    found = search._zeros_as_stated(search._investigate())
    (told,) = search.findings
    assert (found.named, told.run, told.corrected) == (["kuwabara-kono"], "v1", True)
    assert told.value == pytest.approx(-9.0 - nu[found.forward.layout.trigger(1)], abs=1.0)
    assert told.probability == 0.9
    assert search.bench.record.block.trigger_sigma_us == 1.0


@pytest.mark.parametrize(("late", "told"), [((0.0, 12.0), "v1"), ((-14.0, 0.0), "v0"), ((9.0, -8.0), None)])
def test_a_run_that_is_late_alone_leaves_the_others_zeros_as_stated(late, told):
    """The zeros of all runs explain as much, and shared what one run's time zero is."""
    search = Search(Bench(off(made((), seed=12)[0], late, 1.0)), CATALOGUE, 1, [])
    ranked = search.ranked(search.nominal())
    assert (ranked[0].slip.fault, ranked[0].slip.run) == ("time-zero", told)
    assert (None in {j.slip.run for j in ranked if j.slip.fault == "time-zero"}) is (told is None)
    assert [j.slip.fault for j in search.aside] == ([] if told is None else ["time-zero"])


@pytest.mark.parametrize("gain", [98.7, 80.0])
def test_zeros_that_are_all_off_are_told_with_how_far_at_the_price_of_those_without(empty, gain):
    """At that of all places in a record an empty one was a faster striker and a lighter bead."""
    record = off(empty, (-6.0, -6.0), 1.0)
    own = Judged(*asked(record), 0.0, 98.7, 40.0, SimpleNamespace(bench=Bench(record)))
    far = Judged(Slip("time-zero", None, value=lambda _: 12.0, occam=-19.0), 0.0, gain, 30.0)
    clock = Judged(Slip("clock", None, width=1.0), 0.1, 20.0, 9.0)
    (first, second), aside = zeros.simplest([own, far, clock])
    assert (second, aside) == (clock, [])
    if gain < 90.0:
        assert first is own
    else:
        assert (first.slip.value(0.0), first.log_odds, first.slip.occam) == (
            12.0,
            own.log_odds,
            own.slip.occam,
        )


@pytest.mark.parametrize("level", [0.0, 3.0])
def test_what_never_moves_lies_nowhere_in_time_and_along_no_line(empty, level):
    """Traces of zeros lay a whole record early, along lines of infinite weight; one at a level drowned the
    others.
    """
    model, still = predicted(experiment(empty)), empty
    for gauge in ("g4", "g7", "wall"):
        still = altered(still, gauge, lambda y: np.full_like(y, level))
    assert set(timing.shifts(still, model).values()) == {0.0}
    assert timing.time_zero(still, model) == lines.drifts(still, model) == []
    late = off(empty, (-90.0, -80.0))
    stuck = altered(late, "g4", lambda y: np.full_like(y, level))
    # Two gauges know when a pulse comes to a sample or two.
    assert timing.shifts(stuck, model) == pytest.approx(timing.shifts(late, model), abs=2.0)


def test_slips_as_likely_as_the_first_are_those_that_explain_alike():
    rivals = [SimpleNamespace(log_odds=odds) for odds in (487.8, 487.6, 456.3)]
    assert as_likely(rivals) == rivals[:2]


def test_a_look_at_unknown_time_zeros_keeps_shifts_in_microseconds():
    """Nuisances count standard errors: -8 us of 1 us became -210 us of 25 us, so that this was never fitted,
    and an empty record was a striker of 2.6 times its speed beside a bead of a third of its mass, with 0.95.
    """
    record = off(made((), seed=12)[0], (-8.0, -8.0), 1.0)
    search = Search(Bench(record), CATALOGUE, 1, [])
    judge = Judge(search.nominal(), search.judged)
    looked = judge.look(*asked(record))
    (followed,) = judge.follow_all([looked])
    assert looked.gain == pytest.approx(followed.gain, abs=5.0)  # slopes, near the fit
    assert followed.gain > 30.0


@pytest.mark.parametrize(
    ("late", "value"), [((3.1, 2.9, 3.0), -3.0), ((3.0, 1.0, 2.0), None), ((3.0, 3.0), None)]
)
def test_zeros_that_turn_out_to_be_off_alike_are_told_with_how_far(late, value):
    """Less than eight samples off, all runs were said to have a time zero of their own each."""
    record = made((), seed=12, speeds=(0.3, 0.5, 0.9)[: len(late)])[0]
    found = Search(Bench(record), CATALOGUE, 1, []).nominal()
    layout, nu = found.forward.layout, np.zeros_like(found.fit.nu)
    for k, us in enumerate(late):
        nu[layout.trigger(k)] = 1e-6 * us / found.forward.nuisance_sigma[layout.trigger(k)]
    beside = SimpleNamespace(forward=found.forward, final=SimpleNamespace(nu=nu))
    told, other = Finding("time-zero", corrected=True), Finding("spikes", corrected=True)
    first, second = timing.counted_on((told, other), beside)
    assert first.value == (value if value is None else pytest.approx(value))
    assert second == other
    assert timing.counted_on((replace(told, corrected=False),), beside)[0].value is None
