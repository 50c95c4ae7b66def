"""One hypothesis against the data: normal equations, refit, evidence, held-out runs, goodness of fit."""
