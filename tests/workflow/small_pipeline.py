"""Two cases and two records, small enough to be run in the tests of the workflow."""

import json
import re

# A folder's name may be anything; of this one a shell would make commands.
ODD = """a b; touch pwned $(touch pwned) `touch pwned` 'q' "d" * ü"""

CONFIG = (
    f"""\
discover: [records/ball, {json.dumps("records/" + ODD, ensure_ascii=False)}]
"""
    + """\
ledger:
  handbook: [soft, nominal]
  matched: [hard, nominal]
  named: [found]
cases:
  coated:
    title: Five coated beads
    chain: &chain
      beads: 5
      orientation: horizontal
      bead: {diameter_mm: 4.86, mass_g: 0.44, material: parylene-c, coating_um: 50, core: stainless-steel}
      wall: {material: stainless-steel}
    striker: {shape: flat, material: alumina, mass_g: 0.47, speed_m_s: 0.44}
    sensors: [{id: g2, kind: embedded, bead: 3}, {id: wall, kind: wall}]
    duration_us: 400
    variants:
      soft: {}
      hard: {materials: {parylene-c: {modulus_GPa: 15.0}}}
      found: {model: {record: ball}}
  sweep:
    title: Two speeds
    chain: *chain
    striker: {shape: flat, material: alumina, mass_g: 0.47, speed_m_s: [0.3, 0.6]}
    sensors: [{id: g2, kind: embedded, bead: 3}, {id: wall, kind: wall}]
    duration_us: 400
"""
)

TARGET = "results/metrics.csv"


# Cards are made in three batches: two variants of one case, the other case, what takes the model of a record.
ALL = {"discover": 1, "card": 3, "simulate": 3, "observe": 3, "metrics": 1}


def without_batch(rule):
    """Name of a rule but for the number of its batch of cards."""
    return re.sub(r"_\d+$", "", rule)
