"""Slips of the laboratory: what is wrong with a record, not with the model.

A gauge on the wrong cable, a bead miscounted, a scope triggered late: each would be explained by some effect
that is not there. Slips that traces show by themselves (`traces`, `expected`) are put right first; the others
are hypotheses (`slips`) that change the record, are judged by the fit of the model to the changed record
(`judging`), and compete with the effects of the catalogue (`competition`).
"""
