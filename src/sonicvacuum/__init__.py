"""Strongly nonlinear waves in chains of polymer coated beads.

A chain of beads that touch without static compression has no linear sound: its long-wave sound speed is zero
(a "sonic vacuum"), and its elementary signal is a compact solitary wave whose speed depends on its amplitude.
The package simulates such chains and reads the simulated signals as the gauges of C. Daraio and
V. F. Nesterenko, Phys. Rev. E 73, 026612 (2006), would. It looks for the effects that a model of measured
signals lacks.

The library is in SI units throughout. Importing the package loads nothing else: import the module you need,
for example ``sonicvacuum.physics``.
"""

__version__ = "0.1.0"
