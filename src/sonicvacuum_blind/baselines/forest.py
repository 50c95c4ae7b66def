"""Random forest on features of the residual (Breiman, Machine Learning 45, 5, 2001; scikit-learn's).

It learns from cases whose truth it is told: those of a training family, or of the study itself in folds, each
case then named by a forest that has not seen it. Cases of several effects take no part; cases from outside
the catalogue are the class unknown. The table kept of the ninth sample (docs/again.md) is of an earlier
forest: to it each set of three, six of its 269 training cases, was a class of its own.
"""

import numpy as np

from sonicvacuum_blind.baselines.cases import Case
from sonicvacuum_blind.baselines.features import vector
from sonicvacuum_blind.breakdown import label_of_truth

TREES, SEED, FOLDS = 500, 20061, 5


def trained(training: list[Case], cases: list[Case]) -> dict[str, str]:
    """Case id → name, learned from other cases."""
    model = _forest().fit(_table(training), _labels(training))
    return dict(zip(_ids(cases), model.predict(_table(cases)).tolist(), strict=True))


def cross_validated(cases: list[Case]) -> dict[str, str]:
    """Case id → name, learned from four fifths of the same cases.

    Each class is shared out evenly where all have as many cases as there are folds. Otherwise folds are drawn
    whatever the classes, and a rare one is missing from some.
    """
    from sklearn.model_selection import KFold, StratifiedKFold, cross_val_predict

    labels = _labels(cases)
    folds = min(FOLDS, len(cases))
    rarest = min(np.unique(labels, return_counts=True)[1])
    split = (StratifiedKFold if rarest >= folds else KFold)(folds, shuffle=True, random_state=SEED)
    return dict(
        zip(_ids(cases), cross_val_predict(_forest(), _table(cases), labels, cv=split).tolist(), strict=True)
    )


def _forest():
    from sklearn.ensemble import RandomForestClassifier

    return RandomForestClassifier(
        TREES, class_weight="balanced", max_features=0.2, random_state=SEED, n_jobs=1
    )


def _table(cases):
    return np.stack([vector(c) for c in cases])


def _labels(cases):
    return np.array([label_of_truth(c.row) for c in cases])


def _ids(cases):
    return [c.row.id for c in cases]
