"""Hidden-effect data: chains with something in them that the nominal model lacks, made to test `discover`
blind.

Force laws and integrator are written a second time here, from the papers and the catalogue's formulas, and
share nothing with the engine (`physics`) or the catalogue (`effects`): an import contract forbids it. A data
set is a record as a laboratory would hand it over, with noise, trigger, gain, speed and modulus errors drawn;
what was hidden, and how strongly, goes to a separate folder that `discover` is never given.
"""

# What was hidden in a record, in a folder of its own.
TRUTH = "truth.json"
