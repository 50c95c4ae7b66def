"""Rigol scopes: quoted keys (DS1000E), sample numbers with start and increment (DS1000Z, DS2000), times."""

from sonicvacuum.scope.layouts.base import Layout

LAYOUT = Layout(
    "rigol",
    r"^\W*X,\s*(CH|MATH)\W?\d|^\"?Number of Data points|^,CH\d.*\n\W*Second|tInc\s*=|^Time\(s\),CH\dV|RIGOL",
)
