"""Which hypotheses are tried: screen of the catalogue, single effects, pairs, larger sets, unnamed shapes."""
