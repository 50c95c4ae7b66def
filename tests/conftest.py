"""Settings of all tests: property tests draw the same examples on every machine and are never timed."""

from hypothesis import settings

settings.register_profile("ci", derandomize=True, deadline=None)
settings.load_profile("ci")
