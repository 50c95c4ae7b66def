"""The catalogue: every effect that the nominal model may lack, in fixed order.

The nominal model is a chain of Hertz contacts with the record's constants, under gravity and preload as
recorded, read by ideal gauges. An effect is one file here with one header (`effects.base.Effect`): what is
missing, the equation, its energy, the reference, parameters with unit, off value, bounds, prior and scale,
what it moves in the readings and which way, when to use it and when not. At its off value an effect returns
the setup untouched, so that off and absent are the same to the bit.

    from sonicvacuum.effects import Setup, effect

    setup = Setup(chain, sensors)
    setup = effect("kuwabara-kono").apply(setup, time_us=2.0)                        # in all lanes
    setup = effect("mass-defect").apply(setup, mass_ratio=np.array([1.0, 1.2]), bead=13)   # lane by lane
    simulate(setup.chain, contacts=[12, 13], duration=6e-4, interval=1e-6)

Adding an effect: one file, one line. Suppose contacts that are damped in proportion to their compression,
F = K delta^{3/2} + b delta v. Write `deep_damping.py`:

    from sonicvacuum.effects.base import Effect, Parameter, add_term
    from sonicvacuum.physics.laws import Term

    def deep_force(delta, rate, elastic, damping):       # arithmetic, physics.lanes, functions made of these
        return damping * delta * rate

    TERM = Term("deep-damping", "force", deep_force, 1)  # slots and their arguments: physics.laws

    def coefficients(chain, stiffness, mass, damping):   # one array per coefficient, per contact and lane
        return [damping]

    def change(setup, damping_kg_s_m):                   # in the unit of the name; SI from here on
        return add_term(setup, TERM, coefficients, damping=damping_kg_s_m)

    EFFECT = Effect(id="deep-damping", title="Deep damping", ..., change=change)

with the whole header filled in. A file of your own may be used at once: `sonicvacuum effects --effects
deep_damping.py` checks it, `sonicvacuum discover ... --effects deep_damping.py` searches for it, as does
`sv.discover(record, catalogue=sv.catalogue("deep_damping.py"))`; a package offers it under the entry-point
group `sonicvacuum.effects` (see `sonicvacuum.plugins`). To make it part of the project, put the file here and
add `deep_damping` to the import and to `CATALOGUE` below. The contract tests run over the catalogue; they ask
for one thing more, the law written a second time in `tests/effects/reference.py`. What needs no new force is
shorter: change masses, stiffnesses, loads or sensors with `dataclasses.replace`, as `mass_defect.py`,
`static_preload.py` and `sensor_gain.py` do. The order of the catalogue is the order of reports and of ties:
append at the end, and never give an id another meaning.
"""

from sonicvacuum.effects import (
    coating_thickness,
    contact_exponent,
    contact_gap,
    dynamic_modulus,
    free_form,
    gravity,
    guide_friction,
    hunt_crossley,
    kuwabara_kono,
    linear_dashpot,
    mass_defect,
    plastic_contact,
    relaxing_contact,
    sensor_droop,
    sensor_gain,
    sensor_lowpass,
    sensor_offset,
    static_preload,
    striker_error,
    tsuji,
    velocity_power,
    viscous_drag,
    wall_compliance,
)
from sonicvacuum.effects.base import Effect, Parameter, Setup, Source
from sonicvacuum.effects.catalogue import Catalogue

CATALOGUE = Catalogue(
    tuple(
        module.EFFECT
        for module in (
            dynamic_modulus,
            contact_exponent,
            coating_thickness,
            plastic_contact,
            linear_dashpot,
            kuwabara_kono,
            tsuji,
            hunt_crossley,
            velocity_power,
            relaxing_contact,
            viscous_drag,
            guide_friction,
            static_preload,
            gravity,
            contact_gap,
            mass_defect,
            wall_compliance,
            striker_error,
            sensor_lowpass,
            sensor_droop,
            sensor_gain,
            sensor_offset,
        )
    ),
    besides=(free_form.EFFECT,),
)
IDS: tuple[str, ...] = CATALOGUE.ids


def effect(id: str) -> Effect:
    """The effect of the project with that id; ValueError where there is none."""
    return CATALOGUE.effect(id)


__all__ = ["CATALOGUE", "IDS", "Catalogue", "Effect", "Parameter", "Setup", "Source", "effect"]
