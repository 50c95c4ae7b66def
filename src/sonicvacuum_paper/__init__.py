"""The reproduction's own numbers: what the simulated cases give, and how that compares with the paper.

`metrics` reads one simulated card (gauges, contacts, sweeps); `theory_rows`, `arithmetic`, `audit` and
`compare` add what Eqs. (1)–(7), the printed numbers, geometry and pairs of cases give; `ledger` and
`assumptions` hold all of it against `workflow/resources/claims.csv` and `assumptions.csv`. Every metric is
defined in `claims.md` beside them.
"""
