"""National Instruments LabVIEW measurement files (.lvm): two headers that end in ***End_of_Header***.

Layout: National Instruments, "Specification for the LabVIEW Measurement File (.lvm)". Without a column of
times, X0 and Delta_X give them.
"""

from sonicvacuum.scope.layouts.base import Layout

LAYOUT = Layout("lvm", r"^LabVIEW Measurement", unit="")
