"""What the lines of the blind studies' tables ask, in plain words; the tables themselves keep short keys."""

import re

from sonicvacuum_blind.baselines.names import DESIGNS

# Measure → what it asks.
MEASURES = {
    "exact name": "one hidden effect named exactly",
    "exact pair": "two hidden effects named exactly",
    "exact set of three": "three hidden effects named exactly",
    "place right": "put at the right bead, contact or gauge",
    "place in its 90 % set": "that place among those that have 90 % together",
    "size of that set": "how many explanations these are",
    "named on null": "effect named where none is hidden",
    "slip named on null": "slip of the laboratory named where nothing is hidden",
    "unknown on null": "something unknown told of where nothing is hidden",
    "says unknown": "something unknown told of",
    "exact name and unknown": "the effect named exactly, and something unknown",
    "effect named beside unknown is there": "of what is named beside something unknown the effect is part",
    "no other effect is named": "no other effect is named beside something unknown",
    "wrong name, unqualified": "wrong name, nothing unknown told of beside it",
    "the same with probability 0.9": "such a name with a probability of 0.9 or more",
    "slip named where none is": "slip of the laboratory named where none was made",
    "calibration error (ECE)": "stated probabilities, distance from what comes true (ECE)",
    "Brier score": "stated probabilities, mean squared error (Brier)",
    "PIT-ECDF inside its band": "truths lie in stated posteriors as they should (PIT inside its band)",
    "upper limit holds truth": "the stated upper limit holds the truth",
    "localisation F1": "runs and gauges where it shows found (F1)",
    "false discoveries": "runs and gauges told of where it does not show",
    "record's own errors, in stated ones": "striker speeds, moduli and the like are off by (stated errors)",
    "held-out gap closed": "share of the misfit closed on runs left out of the fit",
    "held-out chi2/N": "misfit left on these, over the noise (χ²/N)",
    "seconds per record": "seconds that a verdict takes",
    "resolved by one more run": "one more run leaves the right name alone",
    "resolved, but for limits": "the same, or beside a general law of which it is a limit",
    "resolved, ratio": "how much oftener the proposed run does so",
    "resolved by this run alone": "this run does so, and the other does not",
    "exact name of ambiguous cases": "the right name, of records that left several",
    "chi2/N of a fresh run": "misfit of a fresh run, over the noise (χ²/N)",
    "gap closed on fresh runs": "share of the misfit closed on fresh runs",
}
# Part of a group → words.
GROUPS = {
    **DESIGNS,
    "single": "one effect",
    "pair": "two effects",
    "set": "three effects",
    "null": "nothing hidden",
    "foreign": "outside the catalogue",
    "beside": "an effect and one from outside the catalogue",
    "white": "white noise",
    "ar1": "correlated noise",
    "quantised": "coarse steps of the recorder",
    "leftover d' 8 and more": "the best of the catalogue leaves d′ 8 or more",
    "stated below 0.9": "those stated below 0.9",
    "with the records added": "with the records that were added to the list",
    "right probabilities": "what right probabilities would show in as many records",
    "base rates: half empty": "if half of all records hid nothing",
    "base rates: nine in ten empty": "if nine in ten hid nothing",
    "base rates: a third foreign": "if a third hid what the catalogue lacks",
    "all parameters": "all parameters (1: yes, 0: no)",
    "effects whose ECDF leaves it": "number of effects of which they do not",
    "cells": "runs by gauges",
    "of sets named exactly": "of sets named exactly",
    "truths at an end left out": "chains that lie flat or stand left out",
    "proposed": "the proposed run",
    "random": "a run drawn at random",
    "before": "before one more run",
}


def asked(measure: str) -> str:
    """What a measure asks; the measure itself where no words are known."""
    found = re.fullmatch(r"(?:truth in the (\d+) % credible set)|(?:(\d+) % interval holds truth)", measure)
    if found and found[1]:
        return f"truth among the explanations that hold {found[1]} % of the probability"
    if found:
        return f"the stated {found[2]} % interval holds the truth"
    return MEASURES.get(measure, measure)


def group(name: str) -> str:
    """Of which records or numbers a line is, part by part; ids of hidden effects without their hyphens."""
    first, *rest = parts = name.split(", ")
    if first == "outside" and len(parts) == 2:
        return f"outside the catalogue: {rest[0].replace('-', ' ')}"
    return ", ".join(GROUPS.get(part, part) for part in parts).replace("d'", "d′")
