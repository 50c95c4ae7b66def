"""Every case of the paper under every model of the ladder, simulated with the same draws."""

from collections.abc import Iterable, Iterator, Mapping

import numpy as np

from sonicvacuum.blas import one_thread
from sonicvacuum.card import Card
from sonicvacuum.config import Config
from sonicvacuum_paper.columns import column_cards
from sonicvacuum_paper.ladder import MODELS, NAMED
from sonicvacuum_paper.uncertainty import loss, reading, sweeps
from sonicvacuum_paper.uncertainty.batch import LOSS, Batch, Draws, set_up
from sonicvacuum_paper.uncertainty.inputs import neutral

MAIN = (
    ("speed", reading.BETWEEN),
    ("amplitude", "g9"),
    ("decay", reading.BETWEEN),
    ("arrival", "wall"),
    ("width_02", "g9"),
    ("pulse_count", "g9"),
    ("pulse_count_05", "wall"),
    ("extra_pulse_fraction", "g9"),
    ("extra_pulses_upper_stronger", reading.BETWEEN),
)
COUNT = (("pulse_count_05", "wall"),)
TRAIN = (
    ("speed", reading.BETWEEN),
    ("pulse_count", "wall"),
    ("pulse_count_05", "wall"),
    ("third_pulse_fraction", "wall"),
    ("valley_depth", "wall"),
    ("valley_depth", "g9"),
)
WALL = (("pulse_count", "wall"), ("duration_half", "wall"), ("amplitude", "wall"))
# Case → what is measured on its lanes.
CASES = {
    "fig3a": (*MAIN, ("duration_02", "g9")),
    "fig3b": MAIN,
    "fig5a": TRAIN,
    "fig5b": TRAIN,
    "fig6a": WALL,
    "fig6b": WALL,
    "ratio-2": COUNT,
    "ratio-5": COUNT,
}
BARE = ("fig3b", "fig5b", "fig4b")
# Cases whose contacts matter.
LOADED = ("fig3a", "fig6a")
# Time simulated, in nominal arrivals at the wall: until the reflection is back, or the train is in.
LASTING = {"fig3a": 1.7, "fig3b": 1.7, "fig4a": 1.5, "fig4b": 1.5, "ratio-5": 3.2}
LONG = 2.6
Found = dict[tuple[str, str, str], np.ndarray]


@one_thread
def sample(cards: Mapping[str, Mapping[str, Card]], draws: Draws) -> dict[str, Found]:
    """Column of the ledger → (case, quantity, sensor) → (draws,) values, NaN where there is none.

    Args:
        cards: case → column → card, see `cards_of`. The model that `discover` names keeps the numbers that it
            was fitted with: fitted anew in each draw it would agree more often, not less.
        draws: from `inputs.draws`.
    """
    columns = [c for c, m in MODELS.items() if m.counted and c in cards["fig3a"]]
    bare = _of_cards({case: found["handbook"] for case, found in cards.items() if case in BARE}, draws)
    sampled = {}
    for column in columns:
        apart = () if column == NAMED else BARE
        own = {case: found[column] for case, found in cards.items() if case not in apart and column in found}
        sampled[column] = {**bare, **_of_cards(own, draws, calibrated=column != NAMED)}
    return sampled


def cards_of(config: Config, named: Iterable[Card] = ()) -> dict[str, dict[str, Card]]:
    """Case → column → card, of all cases that are drawn.

    `named` are the cards with the model that `discover` names in them; without them that column is left out.
    """
    found = {case: column_cards(config, case) for case in (*CASES, "fig4a", "fig4b")}
    for of_case in found.values():
        of_case.pop(NAMED, None)
    for card in named:
        if card.case in found:
            found[card.case][NAMED] = card
    return found


def _of_cards(cards: Mapping[str, Card], draws: Draws, calibrated: bool = True) -> Found:
    """The values of the cases of one model; its loss is calibrated in each draw as it was for the ladder."""
    times = None
    if calibrated and "fig3a" in cards and LOSS in cards["fig3a"].effects:
        times = loss.calibrated(cards["fig3a"], draws, lasting(cards["fig3a"]))
    found = {}
    for case, card in cards.items():
        of_case = _sweep(card, draws, times) if case.startswith("fig4") else _case(card, draws, times)
        found |= {(where, *key): values for (where, key), values in of_case}
    return found


def _case(card, draws, times) -> Iterator:
    batch = Batch.of(card, set_up(card, draws, loss_us=times), lasting(card))
    found = reading.of_lanes(batch, CASES[card.case], draws)
    if card.case in LOADED:
        found |= reading.of_contacts(batch)
    if ("amplitude", "wall") in found:
        static = batch.seen.setup.chain.load
        found["preload_over_amplitude", "wall"] = static / found["amplitude", "wall"]
    if times is not None and card.case == "fig3a":
        found["loss_us", ""] = times
    return (((card.case, key), values) for key, values in found.items())


def _sweep(card, draws, times) -> Iterator:
    end = lasting(card, sweeps.SPEEDS[0])
    points = []
    for speed in sweeps.SPEEDS:
        batch = Batch.of(card, set_up(card, draws, speed, times), end)
        points.append(reading.of_peaks(batch, draws) | reading.of_contacts(batch))
    yield from (((card.case, key), values) for key, values in sweeps.of_points(card, points).items())
    if card.case == "fig4a":
        yield ("small-amplitude", ("speed", reading.BETWEEN)), sweeps.low_speed(points)


def lasting(card: Card, speed: float | None = None) -> float:
    """Seconds to simulate of a card, by the nominal arrival at the wall."""
    batch = Batch.of(card, set_up(card, neutral(1), speed), card.duration_s)
    names = [s.id for s in batch.seen.setup.sensors]
    arrival = batch.seen.history.time[1] * int(batch.seen.readings[0, names.index("wall")].argmax())
    return LASTING.get(card.case, LONG) * arrival
