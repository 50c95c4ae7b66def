"""The smallest record there is, for tests of the flow: one ball on a wall, rebounding as it should."""

RECORD = """\
format: 1
title: Steel ball on a steel wall
chain:
  beads: 0
  orientation: vertical
  bead: {diameter_mm: 10.0, mass_g: 4.0, material: stainless-steel}
  wall: {material: stainless-steel}
sensors: []
runs:
  - id: slow
    striker: {shape: sphere, diameter_mm: 10.0, material: stainless-steel, mass_g: 4.0, speed_m_s: 0.5}
    observables:
      - {quantity: restitution, value: 0.99, sigma: 0.01, unit: 1}
"""
