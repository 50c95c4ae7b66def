"""Tektronix scopes: keys beside the samples (TDS, DPO) or above them (TBS, MSO), then TIME and channels."""

from sonicvacuum.scope.layouts.base import Layout

LAYOUT = Layout(
    "tektronix",
    r"Model( Number)?,\W*(TDS|TBS|MSO|DPO|MDO|TPS|LPD|DSA)|^\"?Record Length\"?,.*\n\"?Sample Interval"
    r"|(?-i:^\W*TIME,(CH|REF|MATH)\d)|Tektronix",
)
