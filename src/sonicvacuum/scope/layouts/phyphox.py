"""phyphox on a phone: quoted names with units in brackets, times from the sensor and thus uneven."""

from sonicvacuum.scope.layouts.base import Layout

LAYOUT = Layout(
    "phyphox", r"phyphox|^\W*Time \(s\)\W+(Linear |Absolute )?(acceleration|gyroscope|magnetic)", unit=""
)
