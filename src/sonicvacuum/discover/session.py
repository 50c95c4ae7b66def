"""One record from reading to its verdict: search, places, limits, next run; `written` makes files of it."""

import time
from dataclasses import dataclass

import numpy as np
from msgspec import UNSET

from sonicvacuum import plugins, stages
from sonicvacuum.blas import one_thread
from sonicvacuum.discover import (
    hidden,
    law,
    next_experiment,
    posterior,
    unnamed,
    upper,
    verdict,
)
from sonicvacuum.discover.draws import Draws
from sonicvacuum.discover.faults import competition
from sonicvacuum.discover.fit import goodness, heldout
from sonicvacuum.discover.fit.refit import Fit
from sonicvacuum.discover.judge import degenerate, locate, strained, whereabouts
from sonicvacuum.discover.model import window
from sonicvacuum.discover.model.abreast import processors
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.nuisances import assumed, exact
from sonicvacuum.discover.rounds import Investigation
from sonicvacuum.discover.search.free_law import FreeLaw
from sonicvacuum.discover.verdict import Model, Verdict
from sonicvacuum.effects import Catalogue
from sonicvacuum.physics import validity
from sonicvacuum.records import Record, check_records
from sonicvacuum.records.extent import check_extent
from sonicvacuum.records.suspects import copies
from sonicvacuum.records.unshown import unshown


@dataclass(frozen=True)
class Result:
    """What `discover` found in one record, with all that tables and figures need.

    Attributes:
        record: the record put right; of several taken together the first.
        given: the records as they were given.
        notes: what was done to their traces before anything else.
        found: the search.
        places: disagreements of the nominal model with the data.
        after: those of the extended model.
        limits: of all effects that were not named.
        verdict: what is written.
        law: the free-form law, where one was needed.
        posterior: weighted draws of each parameter of what is named.
    """

    record: Record
    given: tuple[Record, ...]
    notes: tuple[str, ...]
    found: Investigation
    places: list[locate.Place]
    after: list[locate.Place]
    limits: list[degenerate.Limit]
    verdict: Verdict
    law: FreeLaw | None = None
    posterior: tuple[Draws, ...] = ()

    def __repr__(self) -> str:
        named, sure = " + ".join(self.verdict.named) or "none", self.verdict.probability
        return f"<Result {self.verdict.record}: {named}{'' if sure is None else f', probability {sure:.2f}'}>"

    @property
    def extended(self) -> tuple[Forward, Fit]:
        """The extended model as it was fitted: what is named, and the free-form law where one was needed."""
        return (self.law.forward, self.law.fit) if self.law else (self.found.forward, self.found.final)

    @property
    def model(self) -> Model:
        """The extended model in numbers, as in `model.json`; `sv.compare` and `sv.simulate` take it."""
        return verdict.model(self.found, self.law)


@one_thread
def discover(
    *records: Record, threads: int | None = None, catalogue: Catalogue | None = None, limits: bool = True
) -> Result:
    """What the nominal model of measured data lacks.

    Args:
        *records: one record, or records of one chain and its gauges, which get one verdict.
        threads: processors to use, by threads of the compiled engine and, on Linux, copies of this process
            that follow hypotheses side by side; all of them by default. The result does not depend on it.
        catalogue: the effects that may be missing, as of `sv.catalogue("my_law.py")`; by default the
            project's and those of installed packages.
        limits: refuse a search that asks for more memory than the machine has.

    Returns:
        Result: `verdict` (named effects, probabilities, parameters, gap before and after, limits, next run),
        `model` (what `sv.compare` and `sv.simulate` take), and all that tables and pictures need.

    Raises:
        InputError: for no record or processor, or records that cannot be simulated, do not belong together,
            or (`limits`) ask too much, or what is no catalogue.
    """
    check_records(records, "discover")
    catalogue = plugins.given(catalogue, "discover")
    clock = Clock()
    ready, notes = zip(*(window.fitted(one, catalogue) for one in records), strict=True)
    for one in ready if limits else ():
        check_extent(one)
    outcome = competition.discover(ready, catalogue, processors(threads, "discover"))
    found, forward = outcome.found, outcome.found.forward
    clock.mark("search")
    stages.begin("places and limits")
    places = locate.locate(forward, found.null)
    found, free = unnamed.with_law(found)
    found, scores = hidden.told(found, upper.screened(found))
    clock.mark("free-form law")
    model, final = (free.forward, free.fit) if free else (forward, found.final)
    after = locate.locate(model, final) if final is not found.null else places
    clock.mark("locate")
    fits = [goodness.goodness(forward, found.null), goodness.goodness(model, final)]
    limits, untestable, wider = upper.limits(found, fits[1], scores)
    alike = degenerate.confusable(
        found.named, found.candidates, found.combinations, found.alike, found.probabilities
    )
    before = heldout.held_out(found.null, found.sizes)
    left = (
        heldout.HeldOut(free.held_out, found.sizes) if free else heldout.held_out(final, found.sizes, before)
    )
    told = law.told(free, found) if free else UNSET
    clock.mark("limits")
    named, counted, e = verdict.named_effects(found), found.counted or found, forward.experiment
    rivals, drawn = posterior.of_named(found)
    clock.mark("posterior")
    stages.begin("next experiment")
    proposal = next_experiment.propose(found, alike, rivals)
    clock.mark("next experiment")
    result = Verdict(
        record=found.forward.experiment.name,
        named=found.named,
        probabilities=found.probabilities,
        confusable=alike,
        parameters=verdict.parameters(counted.final, rivals, drawn, e.materials) if named else {},
        gap=verdict.gaps(found.null, final, found.sizes, before, left),
        where=verdict.where(places),
        upper_limits=verdict.upper_limits(limits),
        not_testable=untestable,
        next_experiment=proposal,
        reasons=[
            *found.reasons,
            *(whereabouts.doubts(rivals, counted.final, e) if named else ()),
            *_taken_as_stated(found, records),
            *(law.reasons(told) if free else ()),
            *verdict.corrections(outcome.findings),
        ],
        alarms=found.alarms,
        timing_s=clock.seconds(),
        law=told,
        simulations=forward.chains
        + (free.forward.chains if free else 0)
        + outcome.simulations
        + (found.counted.forward.chains if found.counted else 0),
        faults=verdict.faults(outcome.findings),
        fit=verdict.goodness_of_fit(*fits, found.smooth or forward.experiment.model_floor_rel or 0.0, wider),
        sources=verdict.sources(catalogue),
        warnings=_doubts(found, records[0]) or UNSET,
        nuisances=verdict.nuisances(counted.forward, counted.final, rivals),
    )
    said = tuple(line for lines in notes for line in lines)
    return Result(outcome.record, records, said, found, places, after, limits, result, free, tuple(drawn))


def _taken_as_stated(found: Investigation, records: tuple[Record, ...]) -> list[str]:
    """What was taken as exact, or as known so well, where something is named: a tolerance might explain it
    instead. And what the nominal model would have of the record otherwise than stated, or does not show at
    all, and files read twice.
    """
    e, said = found.forward.experiment, []
    if found.named and e.record is not None:
        said = [exact(e.record, e.shared), assumed(e.record, [b.chain for b in e.batches])]
    final = found.final if verdict.named_effects(found) else None
    known = final is not None or not found.named
    moved = strained.lines(found.forward, found.null, final) if known else []
    return [*filter(None, said), *moved, *(line for one in records for line in (*copies(one), *unshown(one)))]


def _doubts(found: Investigation, record: Record) -> list[str]:
    """What in the motion of the final model leaves the range of its physics, see `physics.validity`."""
    forward, final = found.forward, found.final
    surfaces = [bead.surface for bead in record.specimen.bodies.kinds]
    yields = {surface.name: surface.yield_Pa for surface in surfaces}
    doubts = []
    for batch in forward.experiment.batches:
        nominal = forward.nominal(batch, final.nu[None])
        setup = final.hypothesis.change(final.u[None])(nominal, np.zeros(len(batch.runs), dtype=int))
        history = forward.simulate(batch, setup).history
        try:
            doubts += validity.warnings(setup.chain, history, yields)
        except validity.MeaninglessError as error:
            doubts.append(str(error))
    return list(dict.fromkeys(doubts))


class Clock:
    """Seconds by step."""

    def __init__(self):
        self._start = self._last = time.perf_counter()
        self._steps: dict[str, float] = {}

    def mark(self, step: str) -> None:
        """End a step."""
        now = time.perf_counter()
        self._steps[step], self._last = round(now - self._last, 3), now

    def seconds(self) -> dict[str, float]:
        """Seconds of each step and in total."""
        return {"total": round(time.perf_counter() - self._start, 3), **self._steps}
