"""The mechanics of a chain of beads in contact: forces, motion, and the theory to hold them against."""
