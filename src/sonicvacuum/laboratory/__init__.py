"""The laboratory in one vocabulary: materials, beads, specimens and strikers in SI units.

`specimen` has the words, `bodies` the lazy row of beads, `blocks` the YAML that users write, `ranges` what no
laboratory has.
"""
