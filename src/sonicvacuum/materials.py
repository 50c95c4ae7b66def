"""The table of materials: elastic constants of what touches, each with its source.

A record or case may override any number; what a name means by default stands here and nowhere else, and so
does how far the modulus of a piece at hand may be from what a handbook says of its material.
"""

from dataclasses import dataclass

# Relative error of a modulus of which nothing better is known: ceramics and glasses by what is in them,
# textured metals by how they were made, polymers by temperature and rate.
MODULUS_REL_SIGMA = 0.05
# Steels: of 20 samples of AISI 304 acquired at random Young's modulus varied by 1 % or less (Ledbetter,
# Frederick & Austin, J. Appl. Phys. 51, 305 (1980)); that of other steels is taken to do so too.
STEEL_REL_SIGMA = 0.01


@dataclass(frozen=True)
class Material:
    """Isotropic elastic material.

    Attributes:
        modulus: Young's modulus in Pa.
        poisson: Poisson's ratio.
        density: kg/m³.
        yield_strength: Pa, None where unknown.
        source: where the numbers come from.
        modulus_rel_sigma: relative standard error of the modulus of a piece that nobody measured.
    """

    modulus: float
    poisson: float
    density: float
    yield_strength: float | None
    source: str
    modulus_rel_sigma: float = MODULUS_REL_SIGMA


def modulus_rel_sigma(name: str) -> float:
    """Relative standard error of the modulus of a material of which only the name is given.

    What is not in the table and is called a steel of some kind ("steel", "steel-440c") is as well known as
    those that are.
    """
    if name in MATERIALS:
        return MATERIALS[name].modulus_rel_sigma
    return STEEL_REL_SIGMA if "steel" in name.lower() else MODULUS_REL_SIGMA


MATERIALS = {
    "parylene-c": Material(
        2.76e9,
        0.388,
        1289.0,
        59e6,
        "Daraio & Nesterenko 2006: manufacturer's E, ν, density; yield of thin films",
    ),
    "stainless-steel": Material(
        193e9,
        0.30,
        8000.0,
        290e6,
        "AISI 316; E as in Daraio & Nesterenko 2006; Daraio et al., PRE 73, 026610 (2006); error: "
        "Ledbetter et al., J. Appl. Phys. 51, 305 (1980)",
        STEEL_REL_SIGMA,
    ),
    "bearing-steel": Material(
        210e9,
        0.30,
        7810.0,
        2.0e9,
        "AISI 52100, manufacturers' data; error as of stainless steel",
        STEEL_REL_SIGMA,
    ),
    "alumina": Material(370e9, 0.22, 3900.0, None, "sintered alumina of 99.5 %, manufacturers' data"),
    "ptfe": Material(1.46e9, 0.46, 2178.0, 9e6, "Daraio et al., PRE 72, 016603 (2005)"),
    "nylon": Material(3.55e9, 0.40, 1140.0, 60e6, "Coste & Gilles, Eur. Phys. J. B 7, 155 (1999)"),
    "brass": Material(103e9, 0.34, 8500.0, 200e6, "alloy 260, manufacturers' data"),
    "aluminium": Material(70e9, 0.33, 2700.0, 275e6, "alloy 6061-T6, manufacturers' data"),
    "glass": Material(63e9, 0.23, 2500.0, None, "soda-lime glass, manufacturers' data"),
    "tungsten-carbide": Material(600e9, 0.22, 14900.0, None, "6 % cobalt, manufacturers' data"),
    "titanium": Material(114e9, 0.34, 4430.0, 880e6, "Ti-6Al-4V, manufacturers' data"),
    "delrin": Material(3.1e9, 0.35, 1410.0, 65e6, "acetal homopolymer, manufacturers' data"),
    "polycarbonate": Material(2.35e9, 0.37, 1200.0, 62e6, "manufacturers' data"),
    "pmma": Material(3.0e9, 0.37, 1180.0, 70e6, "manufacturers' data"),
}
