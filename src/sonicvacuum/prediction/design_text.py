"""A design in words and as JSON; both say the same numbers."""

from collections.abc import Sequence
from typing import Any

from sonicvacuum.prediction.design import TARGET, Design, Layout


def content(found: Design) -> dict[str, Any]:
    """Numbers by name, units in the names; separations in standard errors."""
    return {
        "format": 1,
        "effects": list(found.effects),
        "beads": found.beads,
        "target_sigma": TARGET,
        "enough": found.enough,
        "advised": _layout(found.advised),
        "best": [_layout(one) for one in found.best],
        "single": {gauge: round(value, 3) for gauge, value in found.single.items()},
    }


def _layout(one: Layout):
    apart = [{"truth": a, "rival": b, "sigma": round(v, 3)} for (a, b), v in one.apart.items()]
    return {
        "gauges": list(one.gauges),
        "speeds_m_s": [float(f"{v:.4g}") for v in one.speeds_m_s],
        "least_sigma": round(one.least, 3),
        "apart": apart,
    }


def text(found: Design) -> str:
    """The same for reading."""
    advised = found.advised
    verdict = (
        f"tells them apart by at least {advised.least:.3g} standard errors"
        if found.enough
        else f"is the best there is and tells them apart by {advised.least:.3g} standard errors only; "
        f"{TARGET:g} are wanted: less noise, more gauges (--most) or stronger effects are needed"
    )
    lines = [f"{_named(found)}: {_told(advised)} {verdict}", ""]
    truth, rival = min(advised.apart, key=advised.apart.get)
    lines += [f"hardest: {truth} taken for {rival}", "", "best choices, standard errors of the hardest pair:"]
    lines += [f"{one.least:8.3g}  {_told(one)}" for one in found.best]
    lines += ["", "one gauge alone, in the run at the given speed:"]
    lines += [f"{value:8.3g}  {place(gauge)}" for gauge, value in found.single.items()]
    return "\n".join(lines)


def _named(found):
    return found.effects[0] if len(found.effects) == 1 else " against ".join(found.effects)


def _told(one: Layout):
    """Gauges and runs in words."""
    gauges, speeds = places(one.gauges), " and ".join(f"{v:.3g}" for v in one.speeds_m_s)
    return f"{gauges}, {'a run' if len(one.speeds_m_s) == 1 else 'runs'} at {speeds} m/s"


def places(gauges: Sequence[str]) -> str:
    """What some gauges are called together: beads 8 and 10, or beads 8, 10 and wall."""
    beads = [g for g in gauges if g.isdigit()]
    others = [place(g) for g in gauges if not g.isdigit()]
    if len(beads) > 1:
        named = [*beads, *others]
        return f"beads {', '.join(named[:-1])} and {named[-1]}"
    return " and ".join([*map(place, beads), *others])


def place(gauge: str) -> str:
    """What a gauge is called."""
    return f"bead {gauge}" if gauge.isdigit() else gauge
