"""One line of the table of the simpler rules: read without loading what makes it."""

from dataclasses import dataclass


@dataclass(frozen=True)
class RuleLine:
    """Share of a group of cases: the name is exact (singles), there is a name (nulls, foreign).

    Attributes:
        rule: who names; `measure`, `group`: what is counted, on which cases.
        count, value, low, high: share with 95 % interval (none for the ideal rule, which is computed).
        note: on what the rule was set, and on which part of the cases it was tried.
    """

    rule: str
    measure: str
    group: str
    count: int
    value: float
    low: float
    high: float
    note: str
