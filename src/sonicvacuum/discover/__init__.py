"""From a record of measured data to a verdict: where model and data disagree, what is missing, how sure.

`experiment` holds the data, `forward` the simulator as a function of parameters, `gram` the algebra of the
linearised model; `locate`, `screen`, `refit`, `evidence`, `unknown`, `decide`, `degenerate` and
`next_experiment` are the steps, `rounds` their order, `verdict` what is written.
"""
