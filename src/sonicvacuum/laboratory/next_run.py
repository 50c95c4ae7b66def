"""What the laboratory may run next: the changes that `discover` may propose and the blind test can make."""

# A next run changes one quantity of the last one: factors on the striker's speed and mass, newtons added to
# the static force. Speeds (m/s) stay within what a dropped or pushed striker reaches.
SPEEDS = (0.2, 0.5, 2.0, 5.0)
SLOWEST, FASTEST = 0.02, 20.0
MASSES = (0.25, 4.0)
PRELOADS = (0.5, 5.0)


def gauge_beads(beads: int) -> list[int]:
    """Beads to which a next run may move an embedded gauge: a quarter into the chain, and near the wall."""
    return sorted({max(1, beads // 4), max(1, beads - 2)})
