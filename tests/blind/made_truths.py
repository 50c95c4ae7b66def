"""Truths and verdicts of a blind test, made up for their scores."""


def truth(id="x", kind="single", effects=("tsuji",), d_prime=10.0, **changes):
    hidden = [{"id": e, "parameters": {"alpha": 0.1}, "d_prime": d_prime} for e in effects]
    base = {
        "id": id,
        "kind": kind,
        "design": "traces",
        "noise": "white",
        "effects": list(effects),
        "d_prime": d_prime,
        "hidden": hidden,
        "leftover_d_prime": 9.0 if kind == "foreign" else 0.5,
        "nearest": {"id": "viscous-drag", "leaves_d_prime": 3.0},
    }
    return base | changes


def verdict(named=("tsuji",), probabilities=None, **changes):
    base = {
        "named": list(named),
        "probabilities": probabilities or {"none": 0.0, "unknown": 0.02, "tsuji": 0.98},
        "confusable": [],
        "parameters": {"tsuji": {"alpha": {"value": 0.11, "sigma": 0.01}}},
        "gap": {"held_out": {"before": 50.0, "after": 1.02, "floor": 1.0, "closed": 0.9996}},
        "timing_s": {"total": 2.0},
        "simulations": 100,
    }
    return base | changes


IDEAL = {"ideal": "0.9", "before": "0.3", "cells": "r1/g1=9 r1/wall=2 r2/g1=0.2 r2/wall=6"}
