"""Simpler rules on the cases of the blind study, so that the study says what the method adds.

best-chi2, bic: the fits of single effects that `discover` made, chosen without evidences, alarms or priors.
nearest-shape: the effect whose signature is most like the nominal model's residual.
forest: a random forest on features of that residual, which learns names from cases of known truth.
state: sparse regression (SINDy) on the full motion of the same chains, which no gauge shows.

`calibrate` learns from the training cases too: how stated probabilities come true.
"""
