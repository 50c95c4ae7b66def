"""The gallery of effects: what each moves in the reading of two gauges, and its equation and limits beside.

One chain of steel beads is simulated without and with each effect, at its typical strength; an effect that
such a chain cannot have (a coating's, a resting load's) is shown on one that can. Numbers first, as CSV, then
the picture drawn from them.
"""

from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np

from sonicvacuum.card import CaseBlock, resolve
from sonicvacuum.effects import CATALOGUE, Effect, Setup
from sonicvacuum.figures.style import DOUBLE, ORANGE, canvas, context, panel, save
from sonicvacuum.files import convert
from sonicvacuum.gauges import needed, reading
from sonicvacuum.physics.run import simulate
from sonicvacuum.physics.scales import passage_of, sampling_of
from sonicvacuum.simulation import set_up
from sonicvacuum.tables import read_csv, write_csv

COLUMNS = ("gauge", "time_us", "nominal_N", "effect_N")
_STRENGTH = 1.0
_HEIGHT = 52.0
_BALL = {"diameter_mm": 5.0, "mass_g": 0.51, "material": "bearing-steel"}
_COATED = {
    "diameter_mm": 5.0,
    "mass_g": 0.5,
    "material": "parylene-c",
    "coating_um": 50,
    "core": "stainless-steel",
}


def setups() -> Iterator[Setup]:
    """The chains that effects are shown on, plain ones first."""
    for bead, load, orientation in (
        (_BALL, 0.0, "horizontal"),
        (_BALL, 2.0, "horizontal"),
        (_COATED, 0.0, "horizontal"),
        (_BALL, 0.0, "vertical"),
        (_COATED, 2.0, "vertical"),
    ):
        block = {
            "title": "gallery",
            "chain": {
                "beads": 12,
                "orientation": orientation,
                "bead": bead,
                "wall": {"material": "bearing-steel"},
                "static_force_N": load,
            },
            "striker": {"shape": "sphere", **_BALL, "speed_m_s": 0.5},
            "sensors": [{"id": "g6", "kind": "embedded", "bead": 6}, {"id": "wall", "kind": "wall"}],
            "duration_us": 1.0,
        }
        yield set_up(resolve("gallery", "one", convert(block, CaseBlock, "gallery")))


def write(folder) -> list[str]:
    """Write `<id>.csv` and `<id>.svg` of every effect into a folder; their ids."""
    known = list(setups())
    for effect in CATALOGUE:
        setup = next((s for s in known if effect.why_not(s) is None), known[0])
        path = Path(folder) / f"{effect.id}.csv"
        write_csv(path, COLUMNS, _rows(effect, setup))
        draw(path, path.with_suffix(".svg"))
    return [effect.id for effect in CATALOGUE]


def _rows(effect: Effect, setup: Setup):
    """Rows of the table: readings without and with the effect, on one time axis."""
    place = {"bead": 7, "contact": 6, "sensor": 0}.get(effect.places)
    given = {p.name: p.at(_STRENGTH, setup) for p in effect.parameters}
    given |= {effect.places: place} if effect.places else {}
    changed = effect.apply(setup, **given)
    interval, duration = 8.0 * sampling_of(setup.chain), 0.7 * passage_of(setup.chain)
    plain, other = (_readings(one, interval, duration) for one in (setup, changed))
    for gauge, values in plain.items():
        for k, (a, b) in enumerate(zip(values, other[gauge], strict=True)):
            yield gauge, f"{1e6 * k * interval:.4f}", f"{a:.6g}", f"{b:.6g}"


def _readings(setup: Setup, interval, duration):
    beads = setup.chain.beads
    contacts, bodies = needed(setup.sensors, beads)
    history = simulate(setup.chain, contacts, duration, interval, bodies=bodies)
    return {g.id: np.asarray(reading(g, history, beads))[:, 0] for g in setup.sensors}


def draw(table, path) -> None:
    """Draw a table that `write` wrote: both gauges side by side, the nominal chain in grey."""
    rows = read_csv(table)
    with context():
        figure = canvas(DOUBLE, _HEIGHT)
        for k, gauge in enumerate(dict.fromkeys(row["gauge"] for row in rows)):
            own = [row for row in rows if row["gauge"] == gauge]
            axes = panel(figure, (14.0 + 88.0 * k, 11.0, 70.0, _HEIGHT - 18.0))
            time = [float(row["time_us"]) for row in own]
            for name, color, label in (
                ("nominal_N", "#999999", "nominal"),
                ("effect_N", ORANGE, "with it"),
            ):
                axes.plot(time, [float(row[name]) for row in own], color=color, lw=1.1, label=label)
            axes.set_title(gauge, fontsize=8.0, loc="left")
            axes.set_xlabel("time after the impact (µs)")
            axes.set_ylabel("reading (N)")
        axes.legend(loc="upper right")
        save(figure, path)


def page(pictures: str, typeset: Callable[[str], str] = str) -> str:
    """The gallery as Markdown; pictures stand in the folder `pictures` beside it.

    `typeset` sets what effects write in plain letters: powers, Greek letters, signs.
    """
    head = """# Gallery of effects

What an ideal chain may lack: grey without, orange with the effect at its typical strength.
"""
    return head + "\n".join(_entry(effect, pictures, typeset) for effect in CATALOGUE)


def _entry(effect: Effect, pictures, typeset):
    def told(text):
        return str(typeset(text)).replace("*", "&#42;")  # a radius of curvature is no emphasis

    units = {p.name: "" if p.unit == "1" else f" {p.unit}" for p in effect.parameters}
    parameters = "\n".join(
        f"* `{p.name}`: {told(f'{p.help}; searched from {p.low:g} to {p.high:g}{units[p.name]}')}"
        for p in effect.parameters
    )
    if effect.of_several:
        parameters += f"\n* `{effect.of_several}`: which one, of beads of several"
    return f"""
## {effect.title} (`{effect.id}`)

Lacking: {told(effect.missing)}.

> {told(effect.equation)}

![{effect.title}]({pictures}/{effect.id}.svg)

**What it moves**: {told(effect.signature)}. **Energy**: {told(effect.energy)}.

{parameters}

**When to think of it**: {told(effect.when_to_use)}. **When not**: {told(effect.when_not)}.

Source: {told(effect.reference)}. Numbers: [{effect.id}.csv]({pictures}/{effect.id}.csv)
"""
