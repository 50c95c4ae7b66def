"""Columns of the tables that `sonicvacuum paper rivals` writes, and the names that stand in them."""

# The two models that the experiments are to tell apart: columns of the ledger.
MODELS = ("layer_loss", "matched_loss")
# Effects of the readings that are held against each other: what the contact is, and the ladder's loss.
MODULUS, LAYER, LOSS = "dynamic-modulus", "coating-thickness", "kuwabara-kono"
# Solids that relax.
BROAD, SINGLE = "even over all decades", "one relaxation time"
MAP = ["x", "y", "x_value", "y_value", "content"]
EXPERIMENTS = [
    "series",
    "unit",
    "at",
    "model",
    "speed_m_s",
    "half_duration_us",
    "decay",
    "speeds_sigma",
    "all_sigma",
]
RELAXATION = [
    "solid",
    "static_GPa",
    "time_us",
    "loss_tangent",
    "speed_m_s",
    "gauge_N",
    "decay",
    "half_duration_us",
    "duration_us",
    "low_speed_m_s",
]
LOSSES = [
    "contact",
    "law",
    "parameter",
    "value",
    "speed_m_s",
    "low_speed_m_s",
    "duration_us",
    "gauge_N",
    "decay",
    "split_g9",
    "pulses_fig6b",
]
EXPLAINED = [
    "effects",
    "parameters",
    "misfit",
    "log10_bayes",
    "run",
    "quantity",
    "bound",
    "unit",
    "measured",
    "sigma",
    "nominal",
    "extended",
    "held_out",
]
HEADERS = {
    "map": MAP,
    "experiments": EXPERIMENTS,
    "relaxation": RELAXATION,
    "losses": LOSSES,
    "explained": EXPLAINED,
}
