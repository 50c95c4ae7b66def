"""What to expect of a chain that is still to be built or measured, from a few numbers of the bench.

`setup` turns the numbers into a case, masses from densities where none is given; `measure` simulates the case
and measures it as an experiment is measured; `text` says the result in words and as JSON.
"""

from sonicvacuum.prediction.measure import ChainPrediction, GaugePrediction, predict

__all__ = ["ChainPrediction", "GaugePrediction", "predict"]
