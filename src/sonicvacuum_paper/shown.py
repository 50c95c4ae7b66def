"""What the pages of the reproduction show: the paper's cases, and moving pictures. Loads nothing else."""

# The cases of the paper; any other in `config.yaml` is the user's own.
PAPER_CASES = (
    *("fig3a", "fig3b", "fig4a", "fig4b", "small-amplitude", "fig5a", "fig5b"),
    *("ratio-2", "ratio-5", "fig6a", "fig6b"),
)
# Moving picture → mass of the striker over that of a bead, and what is seen.
ANIMATIONS = {
    "solitary": (1.0, "A ball as heavy as a bead: one solitary wave, five beads long, at constant shape."),
    "train": (
        5.0,
        "A ball as heavy as five beads: a train of solitary waves, the strongest and fastest first.",
    ),
}


def own(card: str) -> bool:
    """Whether a card, `case.variant`, is of a case that the paper does not have."""
    return card.split(".")[0] not in PAPER_CASES
