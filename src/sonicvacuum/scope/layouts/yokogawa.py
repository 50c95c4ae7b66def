"""Yokogawa DL recorders: quoted keys with one value per trace, samples without times."""

from sonicvacuum.scope.layouts.base import Layout

LAYOUT = Layout("yokogawa", r"^\"?Header Size\"?|^\"?TraceName\"?\s*,|HResolution")
