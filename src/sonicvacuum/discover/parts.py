"""The parts of a verdict and of a model, as they are written: values, gaps, places, fits, slips, sources."""

from typing import Literal

from msgspec import UNSET, Struct, UnsetType

from sonicvacuum.discover.faults.table import FAULTS, told

FaultId = Literal[tuple(dict.fromkeys(map(told, FAULTS)))]


class Part(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """One closed object of the JSON."""


class Value(Part, kw_only=True):
    """A parameter with its standard error; of a bead or contact how far off it may be, 0 of a gauge or of a
    material, which has its `name` besides.
    """

    value: float
    sigma: float
    name: str | UnsetType = UNSET


class Gap(Part, kw_only=True):
    """Mean squared residual over its noise variance, nuisances fitted; closed = 1 − (after − floor)/(before
    − floor).
    """

    before: float
    after: float
    floor: float
    closed: float | None


class Gaps(Part, kw_only=True):
    """Over all data as fitted, and over runs left out; null where there is a single run."""

    fitted: Gap
    held_out: Gap | None


class Where(Part, kw_only=True):
    """One significant disagreement of the nominal model."""

    run: str
    sensor: str
    feature: str
    z: float
    p: float


class CellFit(Part, kw_only=True):
    """Residual of one run at one gauge: χ² per datum with its p, p of its whiteness."""

    run: str
    sensor: str
    chi2: float
    p: float
    whiteness: float


class GoodnessOfFit(Part, kw_only=True):
    """The gap of the nominal and of the extended model, by run and gauge.

    Attributes:
        nominal, extended: cells.
        p: test → p of what the extended model leaves, over all runs and gauges.
        smooth_rel: standard deviation of the smooth misfit that is left, as a share of the peak, stated or
            inferred; upper limits count it as noise. 0 where there is none.
        wider: factor on the errors behind the upper limits, for what else is left.
    """

    nominal: list[CellFit]
    extended: list[CellFit]
    p: dict[str, float]
    smooth_rel: float
    wider: float


class Known(Part, kw_only=True):
    """What the data say of something that the record leaves open, and no effect.

    Attributes:
        value: over the recorded one; a delay in µs, a clock's relative error.
        sigma: its standard error, relative; of delays in µs.
        prior: the error that the record states; null where it is unknown.
    """

    value: float
    sigma: float
    prior: float | None


class Next(Part, kw_only=True):
    """The change of the experiment that most likely leaves one explanation alone; the best one and its
    nearest rival there, and the `delta_chi2` predicted between them. Where these are one explanation at two
    places, `places` has the bead, contact, gauge or material of each of its effects at either.
    """

    change: dict[str, float | int | str]
    separates: list[str]
    delta_chi2: float
    places: list[dict[str, int | str]] | UnsetType = UNSET


class Source(Part, kw_only=True):
    """Where a law that does not come with the project is from: name of its file or package, and the SHA-256
    digest of its text.
    """

    name: str
    sha256: str


Sources = dict[str, Source] | UnsetType


class Fault(Part, kw_only=True):
    """One slip of the laboratory; `sensor` one id or several, null where it concerns none; `quantity` where
    it concerns one of a table without traces, `all values` where it concerns all rows of some runs.
    """

    fault: FaultId
    run: str | None
    sensor: str | list[str] | None
    probability: float
    value: float | None
    quantity: str | UnsetType = UNSET
