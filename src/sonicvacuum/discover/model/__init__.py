"""The measured experiment, and the simulator as a function of all that is unknown about it."""
