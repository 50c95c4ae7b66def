"""From a record of measured data to a verdict: where model and data disagree, what is missing, how sure.

`experiment` holds the data, `forward` the simulator as a function of parameters, `gram` the algebra of the
linearised model; `locate`, `screen`, `refit`, `evidence`, `unknown`, `decide`, `degenerate` and
`next_experiment` are the steps, `rounds` their order, `verdict` what is written.
"""

import sys
from importlib import import_module
from types import ModuleType


class _Callable(ModuleType):
    """This package, which is also the public function of its name: `sonicvacuum.discover(record)`."""

    def __call__(self, *records, threads=None):
        """What `session.discover` returns."""
        return import_module(f"{__name__}.session").discover(*records, threads=threads)


sys.modules[__name__].__class__ = _Callable
