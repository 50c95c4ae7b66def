"""What kinds of record, rules and the three counts of the baselines' table are called where people read."""

# Kind of record → words.
DESIGNS = {
    "traces": "traces, several speeds",
    "varied": "other set-ups",
    "one-speed": "one speed",
    "scalars": "scalars only",
    "ball": "one ball",
}
EXACT, ALARM, WRONG = "exact name", "named on null", "wrong name"
SINGLES, NULLS, OUTSIDE = "singles, all", "nulls", "outside the catalogue"
# Rule in the table → words, in the order shown.
RULES = {
    "sonicvacuum": "this method",
    "ideal rule": "ideal rule (computed)",
    "best-chi2": "best χ²",
    "bic": "BIC",
    "nearest-shape": "nearest residual shape",
    "forest, trained": "random forest, training cases",
    "forest, cross-validated": "random forest, cross-validated",
    "state": "SINDy, full motion",
    "state, expressible": "SINDy, laws it can express",
    "state, noise / 100": "SINDy, 1/100 of the noise",
    "state, noise / 100, expressible": "SINDy, 1/100 noise, expressible",
}
# Measure and group of the table, title and unit of a panel.
PANELS = (
    (EXACT, SINGLES, "(a) Exact name", "of single effects"),
    (ALARM, NULLS, "(b) False alarm", "of records without effect"),
    (WRONG, OUTSIDE, "(c) Wrong name", "of foreign effects"),
)
