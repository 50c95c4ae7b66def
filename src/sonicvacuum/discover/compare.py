"""Score a model on a record: only the record's own nuisances are fitted, effects and their parameters
stay.
"""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import msgspec
import numpy as np
from msgspec import Struct

from sonicvacuum.blas import one_thread
from sonicvacuum.discover.fit import wide
from sonicvacuum.discover.fit.heldout import per_datum
from sonicvacuum.discover.fit.reach import Reach, reach
from sonicvacuum.discover.fit.refit import Fit
from sonicvacuum.discover.model import window
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Component, Hypothesis
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.discover.search.starts import setup_of
from sonicvacuum.discover.verdict import Gap, Model, Sources, gap
from sonicvacuum.effects import CATALOGUE, Catalogue, Setup, free_form
from sonicvacuum.effects import whereabouts as where
from sonicvacuum.files import InputError, reading
from sonicvacuum.laboratory import ranges
from sonicvacuum.laboratory.ranges import Range
from sonicvacuum.physics.extent import estimate
from sonicvacuum.records import Record

# What nuisances of a model may be: a thousand times what was stated is no chain (`forward.NO_CHAIN`); of a
# gauge that nobody calibrated the gain may be in any unit.
RATIO = Range("(a ratio)", 1e-4, 1e4, {})
GAIN = Range("(a ratio)", 1e-15, 1e15, {})
TRIGGER = Range("us", -1e9, 1e9, {})
# Simulations of every run that a comparison takes, at most.
SIMULATIONS = 1000
# Contacts that go farther than known by less than this part are not told of: runs alike differ by as much.
FURTHER = 0.05


class Comparison(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A model against one record, with the nominal model beside it.

    Attributes:
        model: record from which the model comes, and its effects.
        gap: χ² per datum of the nominal model (before) and of this one (after).
        chi2, data: of this model.
        runs: run → gap.
        warnings: where the record goes beyond what the model was made of.
    """

    format: int = 1
    record: str
    model: str
    effects: list[str]
    gap: Gap
    chi2: float
    data: int
    runs: dict[str, Gap]
    warnings: list[str] = []


def read_model(path, catalogue: Catalogue = CATALOGUE) -> Model:
    """The model of a `model.json`, whose effects a catalogue holds; InputError names file and key."""
    try:
        with reading(path, "sonicvacuum discover writes a model.json"):
            text = Path(path).read_bytes().decode()
        found = msgspec.json.decode(text, type=Model)
    except (msgspec.DecodeError, msgspec.ValidationError) as error:
        raise InputError(f"{path}: not a model ({error}); sonicvacuum discover writes one") from None
    for name, given in found.effects.items():
        check_source(path, name, found.sources, catalogue)
        one = catalogue.effect(name)
        known = [p.name for p in one.parameters] + [one.sits]
        for key in given:
            if key not in known:
                raise InputError(
                    f"{path}: effects.{name}.{key}: unknown key; {name} has {', '.join(filter(None, known))}"
                )
        _check_values(path, one, given)
    _check_nuisances(path, found)
    return found


def check_source(path, name: str, sources: Sources, catalogue: Catalogue) -> None:
    """Refuse (InputError) an effect of a file that the catalogue lacks, or holds from another source than
    the file says.
    """
    told = (sources or {}).get(name)
    if name not in catalogue and told is None:
        raise InputError(f"{path}: effects.{name}: no such effect; {catalogue.meant(name)}")
    if name not in catalogue:
        raise InputError(
            f"{path}: effects.{name}: comes from {told.name} (SHA-256 {told.sha256[:12]}); "
            "give its file with --effects (in Python catalogue=sv.catalogue(FILE)), or install its package"
        )
    given = catalogue.effect(name).source
    if told and given and told.sha256 != given.sha256:
        raise InputError(
            f"{path}: effects.{name}: was made with {told.name} of SHA-256 {told.sha256[:12]}, {given.name} "
            f"given has {given.sha256[:12]}; give the file it was made with, or run discover again"
        )


def _check_values(path, one, given):
    """InputError for a parameter without meaning, or an effect whose place is missing or no whole number."""
    for key, value in given.items():
        told = None if key == one.sits else one.parameter(key).refused(value)
        if told:
            raise InputError(f"{path}: effects.{one.id}.{key}: {told}")
    if not one.sits:
        return
    at = given.get(one.sits, 0.0 if one.of_several else None)
    if isinstance(at, str) and one.of_several:
        return  # a name, of which no more is known without a chain
    if isinstance(at, str) or at is None or not (0.0 <= at <= ranges.BEADS.high and at.is_integer()):
        told = "is missing" if at is None else f"is {at!r}" if isinstance(at, str) else f"is {at:g}"
        name = f"the {one.sits}'s name or " if one.of_several else ""
        raise InputError(f"{path}: effects.{one.id}.{one.sits}: {told}; give {name}a whole number from 0 on")


def _check_nuisances(path, found):
    """InputError for a ratio or a time zero that no laboratory has."""
    for key, ratios, limits in (
        ("modulus_ratio", {"": found.modulus_ratio}, RATIO),
        ("speed_ratio", found.speed_ratio, RATIO),
        ("gain", found.gain, GAIN),
        ("trigger_us", found.trigger_us, TRIGGER),
    ):
        for one, value in ratios.items():
            try:
                limits.check(f"{key}.{one}".rstrip("."), value)
            except ranges.LaboratoryError as error:
                raise InputError(f"{path}: {error}") from None


def hypothesis(model: Model, setup: Setup, catalogue: Catalogue = CATALOGUE) -> Hypothesis:
    """The model's effects in a record's nominal setup, nothing free.

    Raises:
        ValueError: for an effect of a material of which no bead is, or one that cannot act in this setup.
    """
    components = []
    for name, given in model.effects.items():
        one = catalogue.effect(name)
        fixed = {k: float(v) for k, v in given.items() if k != one.sits}
        if told := one.refused(setup, **fixed):
            raise ValueError(f"effects.{name}: {told}")
        components.append(Component(one.located(setup.chain), (), fixed, _place(one, given, setup)))
    return Hypothesis(tuple(components))


def _place(one, given, setup):
    """Where an effect of a model sits; None where it sits nowhere."""
    if one.places:
        return int(given[one.places])
    if one.of_several is None:
        return None
    try:
        at = where.place(one.sits, given.get(one.sits, 0), one.choices(setup), setup)
    except ValueError as error:
        raise ValueError(f"effect {one.id}: {error}") from None
    return int(at) if one.located(setup.chain).places else None


@one_thread
def compare(model: Model, record: Record, threads: int = 1, catalogue: Catalogue = CATALOGUE) -> Comparison:
    """The model's score on a record; the catalogue knows its effects."""
    forward = Forward(experiment(window.fitted(record, catalogue)[0], catalogue), threads)
    sizes = np.array([forward.experiment.size(k) for k in range(len(forward.experiment.runs))])
    known = forward.experiment.present
    more = {name: given for name, given in model.effects.items() if name not in known}
    more = msgspec.structs.replace(model, effects=more)
    nominal = _fit(forward, Hypothesis())
    extended = _fit(forward, _made(forward, more, catalogue))
    before, after = nominal.normal.chi2[:, 0], extended.normal.chi2[:, 0]
    runs = {
        run.id: gap(*(per_datum(one[k], sizes[k]) for one in (before, after)))
        for k, run in enumerate(forward.experiment.runs)
    }
    return Comparison(
        record=forward.experiment.name,
        model=model.record,
        effects=list(model.effects),
        gap=gap(*(per_datum(one.sum(), sizes.sum()) for one in (before, after))),
        chi2=float(after.sum()),
        data=int(sizes.sum()),
        runs=runs,
        warnings=_beyond(model.effects.get(free_form.EFFECT.id, {}), forward, extended),
    )


def _beyond(law: Mapping[str, float | str], forward: Forward, one: Fit) -> list[str]:
    """Whether contacts go farther than those of the data that a free-form law was fitted to."""
    known = Reach.of({key: float(value) for key, value in law.items()})
    if known is None:
        return []
    seen = reach(forward, one)
    if not seen.exceeds(known, FURTHER):
        return []
    return [
        f"contacts reach {seen}, those of the data that the free-form law was fitted to {known}; "
        "beyond, the law stays what it is there"
    ]


def _made(forward, model, catalogue):
    """The model's effects on a record; InputError where they do not fit it, or its chains with them ask for
    more than a computer gives.
    """
    nu = np.zeros((1, forward.layout.size))
    try:
        one = hypothesis(model, setup_of(forward), catalogue)
        change = one.change(np.zeros((1, 0)))
        for batch in forward.experiment.batches:
            chain = change(forward.nominal(batch, nu), np.zeros(len(batch.runs), dtype=int)).chain
            asked = estimate(chain, 2 * len(forward.experiment.gauges) + 1, batch.duration, batch.interval)
            replace(asked, work=SIMULATIONS * asked.work).check("a model with weaker effects")
    except ValueError as error:
        told = f"{forward.experiment.name}: the model of {model.record} does not fit this record: {error}"
        raise InputError(told) from None
    return one


def _fit(forward, one):
    try:
        return wide.nominal(forward, one)
    except (ValueError, FloatingPointError) as error:
        raise InputError(f"the model does not fit this record: {error}") from None
