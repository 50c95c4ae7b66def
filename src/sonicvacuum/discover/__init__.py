"""From a record of measured data to a verdict: where model and data disagree, what is missing, how sure.

Five rooms, each of which knows only those before it: `model` (the experiment, and the simulator as a function
of what is unknown), `fit` (one hypothesis against the data), `search` (which hypotheses are tried), `judge`
(what is concluded from them) and `faults` (slips made in measuring, in competition with effects). Every
constant that decides stands in `policy`. `rounds` runs the search, `unnamed` holds a contact law without a
name against what was named, `session` runs the whole; `verdict` is what is written, `compare` scores a model
on a record, `next_experiment` proposes what to measure next.
"""

import sys
from importlib import import_module
from inspect import signature
from types import ModuleType


class _Callable(ModuleType):
    # This package, which is also the public function of its name, `sonicvacuum.discover(record)`: who asks
    # what it takes is told of the function, which is loaded then.

    def __call__(self, *records, **how):
        """What `session.discover` returns, which says what it takes."""
        return self._function(*records, **how)

    @property
    def _function(self):
        return import_module(f"{__name__}.session").discover

    @property
    def __signature__(self):
        return signature(self._function)

    @property
    def __doc__(self):
        return self._function.__doc__


sys.modules[__name__].__class__ = _Callable
