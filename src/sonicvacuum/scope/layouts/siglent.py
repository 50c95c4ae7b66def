"""Siglent scopes, all generations: keys, `Source`, then `Second` and `Volt` or `Value`."""

from sonicvacuum.scope.layouts.base import Layout

LAYOUT = Layout(
    "siglent",
    r"^Record Length,(Analog:)?.*(\n.*){0,14}\n\W*Second|Analog:\d|^Source,.*\n\W*Second"
    r"|Model Number,\W*(SDS|SHS|ADS)|SIGLENT",
)
