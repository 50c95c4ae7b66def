"""Strongly nonlinear waves in chains of polymer coated beads.

A chain of beads that touch without static compression has no linear sound: its long-wave sound speed is zero
(a "sonic vacuum"), and its elementary signal is a compact solitary wave whose speed depends on its amplitude.
The package simulates such chains and reads the simulated signals as the gauges of C. Daraio and
V. F. Nesterenko, Phys. Rev. E 73, 026612 (2006), would. It looks for the effects that a model of measured
signals lacks.

SI units throughout, except where a key carries its unit in its name. What a model of measured data lacks:

    import sonicvacuum as sv
    found = sv.discover(sv.read("my-record"))
    print(found.verdict.named, found.verdict.probabilities)
    sv.write_verdict(found, "found")  # verdict.json, model.json, tables, pictures and page

The signals of Fig. 3(a) of that paper, gauge by gauge in N, over `seen.time` in s:

    card = sv.read_case("config.yaml", "fig3a", "layer")
    seen = sv.simulate(card)
    for gauge, reading in seen.readings().items():
        print(gauge, reading.max())

A dimer, and the velocity of its bead 15 as a laser vibrometer sees it, in m/s:

    big, small = (sv.bead(diameter_mm=d, material="bearing-steel") for d in (20.0, 10.0))
    dimer = sv.chain(pattern=[big, small], beads=20)
    laser = sv.gauge("velocity", bead=15)
    card = sv.case(dimer, sv.striker(big, speed_m_s=0.5), [laser], duration_us=800)
    velocity = sv.simulate(card).readings()["velocity-15"]

What ten steel beads of 20 mm will show, before they are bought:

    seen = sv.predict(beads=10, diameter="20mm", material="bearing-steel", speed=0.5)
    print(seen.wave_speed_m_s, seen.gauges)

Everything below is loaded when it is first used; importing the package loads nothing else.

Examples:
    >>> import sonicvacuum as sv
    >>> round(float(sv.theory.speed_from_force(1.0, 193e9, 0.3, 4.76e-3, 0.44e-3)))  # Eq. (6), steel, 1 N
    344
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

__version__ = "0.1.0"

if TYPE_CHECKING:
    from sonicvacuum.api import catalogue, compare, read, read_case, simulate, write_verdict
    from sonicvacuum.builders import bead, case, chain, gauge, striker
    from sonicvacuum.card import Card
    from sonicvacuum.discover.session import discover
    from sonicvacuum.files import InputError
    from sonicvacuum.physics import solitary, theory
    from sonicvacuum.physics.chain import Chain
    from sonicvacuum.prediction import predict
    from sonicvacuum.prediction.design import design
    from sonicvacuum.records import Record
    from sonicvacuum.simulation import Simulation

# Name → module, or module:attribute.
_PUBLIC = {
    "Card": "sonicvacuum.card:Card",
    "Chain": "sonicvacuum.physics.chain:Chain",
    "InputError": "sonicvacuum.files:InputError",
    "Record": "sonicvacuum.records:Record",
    "Simulation": "sonicvacuum.simulation:Simulation",
    "bead": "sonicvacuum.builders:bead",
    "case": "sonicvacuum.builders:case",
    "catalogue": "sonicvacuum.api:catalogue",
    "chain": "sonicvacuum.builders:chain",
    "compare": "sonicvacuum.api:compare",
    "design": "sonicvacuum.prediction.design:design",
    "discover": "sonicvacuum.discover",
    "gauge": "sonicvacuum.builders:gauge",
    "predict": "sonicvacuum.prediction:predict",
    "read": "sonicvacuum.api:read",
    "read_case": "sonicvacuum.api:read_case",
    "simulate": "sonicvacuum.api:simulate",
    "solitary": "sonicvacuum.physics.solitary",
    "striker": "sonicvacuum.builders:striker",
    "theory": "sonicvacuum.physics.theory",
    "write_verdict": "sonicvacuum.api:write_verdict",
}

__all__ = [
    "Card",
    "Chain",
    "InputError",
    "Record",
    "Simulation",
    "bead",
    "case",
    "catalogue",
    "chain",
    "compare",
    "design",
    "discover",
    "gauge",
    "predict",
    "read",
    "read_case",
    "simulate",
    "solitary",
    "striker",
    "theory",
    "write_verdict",
]


def __getattr__(name: str) -> Any:
    """A public name, loaded now (PEP 562)."""
    if name not in _PUBLIC:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    module, _, attribute = _PUBLIC[name].partition(":")
    found = import_module(module)
    return getattr(found, attribute) if attribute else found


def __dir__() -> list[str]:
    """The public names among the others."""
    return sorted({*globals(), *_PUBLIC})
