"""Single effects and pairs on the paper's own record: what each makes of the printed numbers, and predicts.

The record says that the coating is there as a layer, and `discover` judges all else beside it. Here nothing
is taken as known: the readings of the paper that the ladder knows are fitted one by one to Hertz's chain of
the handbook: a modulus, the layer of the printed thickness, or both; the first two also with each law of
loss.
"""

import math
from collections.abc import Iterator
from dataclasses import replace
from itertools import product

import msgspec
import numpy as np
import pandas as pd

from sonicvacuum.discover import quantities
from sonicvacuum.discover.fit import evidence
from sonicvacuum.discover.fit.refit import fit
from sonicvacuum.discover.fit.wide import nominal
from sonicvacuum.discover.model.forward import Forward
from sonicvacuum.discover.model.hypothesis import Component, Hypothesis
from sonicvacuum.discover.model.parameters import coordinate
from sonicvacuum.discover.model.problem import experiment
from sonicvacuum.discover.search.singles import setup_of
from sonicvacuum.records import Record
from sonicvacuum_paper.uncertainty.formats import EXPLAINED, LAYER, LOSS, MODULUS
from sonicvacuum_paper.uncertainty.losses import LAWS

SETS = (
    (MODULUS,),
    (LAYER,),
    (MODULUS, LOSS),
    (LAYER, LOSS),
    (MODULUS, LAYER),
    *((contact, law) for contact in (MODULUS, LAYER) for law in LAWS if law != LOSS),
)
# Values of the one parameter of each from which a fit starts.
STARTS = {
    MODULUS: (3.0, 5.0),
    LAYER: (50.0,),
    LOSS: (1.0, 5.0),
    "linear-dashpot": (0.6, 1.3),
    "tsuji": (0.1, 0.25),
    "hunt-crossley": (0.2, 0.4),
}


def table(record: Record) -> pd.DataFrame:
    """One row for each set of effects and printed number; columns in `formats.EXPLAINED`."""
    forward = Forward(experiment(nothing_known(record)))
    null = nominal(forward)
    return pd.DataFrame([row for names in SETS for row in _rows(forward, null, names)], columns=EXPLAINED)


def nothing_known(record: Record) -> Record:
    """The record as it is without what it says of effects that act for sure."""
    block = msgspec.structs.replace(record.block, priors=record.priors)
    return replace(record, block=block)


def _rows(forward, null, names) -> Iterator[tuple]:
    hypothesis = _hypothesis(forward, names)
    starts = [
        [c.inverse(v) for c, v in zip(hypothesis.coordinates, values, strict=True)]
        for values in product(*(STARTS[n] for n in names))
    ]
    found = fit(forward, hypothesis, np.array(starts), np.zeros((len(starts), forward.layout.size)))
    gain = null.objective - found.objective
    worth = evidence.log_bayes(found, gain) / math.log(10.0)
    said = "; ".join(f"{effect} {n} {v:.6g}" for effect, given in hypothesis.values(found.u).items()
                     for n, v in given.items())  # fmt: skip
    for row in quantities.rows((forward, null), (forward, found)):
        told = dict(zip(quantities.HEADER, row, strict=True))
        yield ("+".join(names), said, found.objective, worth, *(told[key] for key in EXPLAINED[4:]))


def _hypothesis(forward, names):
    """The effects with all their parameters free; those of the record's own catalogue."""
    setup, catalogue = setup_of(forward), forward.experiment.catalogue
    effects = [catalogue.effect(name) for name in names]
    return Hypothesis(tuple(Component(e, tuple(coordinate(p, setup) for p in e.parameters)) for e in effects))
