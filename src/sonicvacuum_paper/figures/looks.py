"""How the models of the reproduction, variants of its cases, are drawn and called: alike in all figures."""

from dataclasses import dataclass

from sonicvacuum.figures.colours import BLUE, GREEN, ORANGE, PURPLE


@dataclass(frozen=True)
class Look:
    """How one model is drawn, and what it is called in a legend."""

    color: str
    width: float
    dashes: object
    marker: str
    name: str

    @property
    def line(self) -> dict:
        """Keywords of a line."""
        return {"color": self.color, "lw": self.width, "ls": self.dashes}

    @property
    def pale(self) -> dict:
        """Keywords of what is drawn for completeness."""
        return {**self.line, "lw": 0.7 * self.width, "alpha": 0.45}


_LOOKS = {
    "matched": Look(BLUE, 1.2, "-", "o", "Hertz, 15 GPa"),
    "membrane": Look(GREEN, 0.9, (0, (5, 1.2, 1, 1.2)), "^", "Hertz, 4.75 GPa"),
    "handbook": Look(ORANGE, 0.9, (0, (3.5, 1.2)), "s", "Hertz, 2.76 GPa"),
    "layer": Look(PURPLE, 1.0, (0, (1.2, 1.0)), "v", "layer, 2.76 GPa"),
    "layer-loss": Look("#000000", 1.3, "-", "D", "layer, 2.76 GPa, loss"),
    "layer-loss-geometry": Look("#8C6D1F", 0.9, (0, (6, 1.5)), "P", "the same, geometric masses"),
    "nominal": Look("#000000", 1.1, "-", "o", "steel, 193 GPa"),
}
_OTHER = Look("#7F7F7F", 1.0, (0, (1, 1)), "D", "another model")


def look(model: str) -> Look:
    """The look of a model, the variant of a case; those without a look of their own share one."""
    return _LOOKS.get("nominal" if model == "horizontal" else model.removesuffix("-horizontal"), _OTHER)
