"""Map, deciding experiment and relaxing solid: limits that are known, and the sentences of the report."""

import numpy as np
import pandas as pd
import pytest

from sonicvacuum import config
from sonicvacuum.effects.coating_thickness import layer_factor
from sonicvacuum.physics import layer_law
from sonicvacuum.report import inline
from sonicvacuum_paper.columns import column_cards
from sonicvacuum_paper.report import answer, rivals, uncertain
from sonicvacuum_paper.uncertainty import (
    decide,
    formats,
    identify,
    layer_viscosity,
    losses,
    picture,
    viscoelastic,
)


@pytest.fixture(scope="module")
def cards(cases):
    return column_cards(cases, "fig3a")


@pytest.fixture(scope="module")
def solids(cards):
    return viscoelastic.table(cards["matched"])


@pytest.fixture(scope="module")
def experiments(cards):
    return decide.table(cards)


def test_content_of_a_normal_density():
    # Two independent normals: the region within radius r holds 1 - exp(-r^2/2).
    x = np.linspace(-6.0, 6.0, 241)
    square = x[:, None] ** 2 + x[None, :] ** 2
    content = identify.contained(np.exp(-0.5 * square))
    assert content[120, 140] == pytest.approx(1.0 - np.exp(-0.5), abs=2e-3)  # a cell holds up to 4e-4


def test_stiffening_spread_evenly_means_the_loss_tangent_of_a_power_law(solids):
    # E ~ omega^n has tan(n pi/2); to first order n pi/2, with n = ln r/ln(rates).
    one = solids[(solids.solid == formats.BROAD) & (solids.static_GPa == 2.76)].iloc[-1]
    n = np.log(15.0 / 2.76) / np.log(1e3 / 1e-3)
    assert one.loss_tangent == pytest.approx(np.tan(np.pi * n / 2.0), rel=0.02)  # tan x = x + x^3/3


def test_a_slow_solid_is_an_elastic_one_under_a_softer_preload(solids):
    elastic = solids[solids.solid == "elastic"].iloc[0]
    slow = solids[solids.time_us == 1e4]
    assert (slow.loss_tangent < 0.003).all()
    # Stiffer than the elastic chain only by the deeper rest, which the weight makes on the soft modulus.
    assert (slow.speed_m_s > elastic.speed_m_s).all() and (slow.speed_m_s < 1.06 * elastic.speed_m_s).all()
    assert slow.decay.to_numpy() == pytest.approx(elastic.decay, abs=0.01)


def test_no_relaxing_solid_meets_both_speeds_and_the_duration(solids):
    told = rivals.relaxing(solids)
    assert told["fits"] == 0 and told["sound"] == ["2053", "4786"]


def test_series_separate_and_a_model_not_from_itself(cards, experiments):
    assert (experiments.all_sigma >= experiments.speeds_sigma).all()  # more data never separate less
    same = {"layer_loss": cards["layer_loss"], "matched_loss": cards["layer_loss"]}
    assert decide.table(same).all_sigma.max() < 0.3 * experiments.all_sigma.min()


def test_hertz_speeds_hardly_know_the_thickness_and_the_layer_s_do(experiments):
    speeds = experiments[experiments.unit == "um"].groupby("model").speed_m_s.agg(["min", "max"])
    spread = speeds["max"] / speeds["min"]
    assert spread["layer_loss"] > 1.7 and spread["matched_loss"] < 1.1


@pytest.fixture(scope="module")
def contours():
    """A map on which all that is allowed lies near the printed film."""
    axes = [np.geomspace(a[0], a[-1], 9) for a in identify.AXES.values()]
    names = list(identify.AXES)
    rows = []
    for one, other in identify.PAIRS:
        x, y = np.meshgrid(*(axes[names.index(n)] for n in (one, other)), indexing="ij")
        content = np.clip(np.hypot(np.log(x / 2.76), 4.0 * np.log(y / 42.0)) / 2.0, 0.0, 1.0)
        rows += [(one, other, *cells) for cells in zip(x.flat, y.flat, content.flat, strict=True)]
    return pd.DataFrame(rows, columns=formats.MAP)


def test_the_map_is_drawn_and_told_from_its_table_alone(contours):
    told = rivals.allowed(contours)
    assert told["handbook"] and not told["matched"] and told["matched_range"] == "none"
    assert len(picture.draw(contours).axes) == 3


@pytest.fixture(scope="module")
def laws():
    """The table of the laws of loss, in round numbers."""
    rows = [
        (contact, law, name, 1.0, fast, slow, 130.0, 2.5, 0.87, 0.8, 1.0)
        for contact, fast, slow in (("layer", 197.0, 130.0), ("matched", 209.0, 153.0))
        for law, name in losses.ALL.items()
    ]
    return pd.DataFrame(rows, columns=formats.LOSSES)


def test_a_law_speaks_for_the_layer_where_hertz_misses_a_speed(laws):
    told = rivals.of_laws(laws)["by_law"]
    assert (told["speaks"], told["of"]) == (5, 5)
    assert told["ratios"] == ["1.52", "1.37"]
    changed = laws.assign(low_speed_m_s=laws.low_speed_m_s.where(laws.law != "tsuji", 130.0))
    assert rivals.of_laws(changed)["by_law"]["speaks"] == 4


def test_how_many_laws_keep_a_pulse_whole_on_the_layer_is_said(laws):
    told = rivals.of_laws(laws)
    assert told["by_law"]["whole"] == 5
    assert [row[2] for row in told["laws"][:2]] == ["1 kg/s", "1"]
    assert answer._laws(told["by_law"]).endswith("on Hertz.")
    split = (laws.contact == "layer") & laws.law.isin(("tsuji", "hunt-crossley"))
    changed = laws.assign(pulses_fig6b=laws.pulses_fig6b.mask(split, 3.0))
    told = rivals.of_laws(changed)["by_law"]
    assert told["whole"] == 3
    assert answer._laws(told).endswith("stays whole on the layer with 3 of them.")


def test_the_viscous_force_of_a_layer_is_the_slope_of_its_elastic_force():
    limit, powers = layer_law.coefficients(0.388, [0.015], 0.3)
    shape = (np.sqrt(1.2e-3) / (50e-6 * layer_law.SCALE), limit[0], *powers[0])
    delta, step = np.geomspace(1e-9, 1e-5, 9), 1e-5

    def force(x):
        return 5e7 * x**1.5 * layer_factor(x, *shape)

    slope = (force(delta * (1.0 + step)) - force(delta * (1.0 - step))) / (2.0 * step * delta)
    given = layer_viscosity.viscous_force(delta, 0.3, force(delta), 2e-6, *shape)
    assert given == pytest.approx(2e-6 * slope * 0.3, rel=1e-4)  # a difference over a part of 1e-4
    # Narrow contacts are those of a half-space: 3/2 F/delta.
    assert given[0] == pytest.approx(2e-6 * 0.3 * 1.5 * force(delta[0]) / delta[0], rel=0.02)


def test_a_loss_is_calibrated_on_the_printed_duration(cases):
    # The number that the ladder uses, found there by another search.
    own = config.card(cases, "fig3a", "layer-loss").effects["kuwabara-kono"]["time_us"]
    assert losses.calibrated(column_cards(cases, "fig3a")["layer"], "kuwabara-kono") == pytest.approx(
        own, rel=0.02
    )


@pytest.fixture(scope="module")
def fits():
    """The table of the fits to the record, in round numbers."""
    rows = [
        (names, said, 4.0, 300.0, "light", "speed g9-g5", "", "m/s", 197.0, 2.0, 113.0, 196.0, held)
        for names, said, held in (
            ("dynamic-modulus", "dynamic-modulus modulus_ratio 3.7", 190.0),
            ("coating-thickness+kuwabara-kono", "coating-thickness layer_thickness_um 50", np.nan),
        )
    ]
    return pd.DataFrame(rows, columns=formats.EXPLAINED)


def test_the_section_of_the_report_says_what_the_tables_say(
    contours, experiments, solids, laws, fits, tmp_path
):
    names = ("map.csv", "experiments.csv", "relaxation.csv", "losses.csv", "explained.csv")
    paths = [tmp_path / name for name in names]
    for path, table in zip(paths, (contours, experiments, solids, laws, fits), strict=True):
        table.to_csv(path, index=False)
    ledger = pd.DataFrame(
        [
            ("fig3a-speed", "It runs at 197 m/s.", "layer 0.01; matched 0.3", "matched", "within", "197"),
            ("shares", "The order holds.", "layer 0; matched 0.01", "", "order", "1"),
        ],
        columns=["claim", "statement", "probability", "fitted", "test", "measured"],
    )
    template = inline.environment("sonicvacuum_paper.report").get_template("uncertainty.html.j2")
    page = template.render(
        **uncertain.context(ledger), **rivals.context(*paths), map_picture=None, alone=False
    )
    assert "<h3>What can be told apart</h3>" in page  # in a report; on a page of its own below its h1:
    own = template.render(**uncertain.context(ledger), **rivals.context(*paths), map_picture=None, alone=True)
    assert "<h2>What can be told apart</h2>" in own and "<h3>" not in own
    assert "0.3 (fitted)" in page and "±1 mm each" in page
    assert '"n">≤ 0.01</td>' in page and '"n">&lt; 0.0052</td>' in page and '"n">0.01</td>' in page
    assert "By them the thickness of the coating separates best,\nsince a Hertz half-space" in page
    assert "196 | 190" in page and "196 | –" in page and "modulus over handbook value = 3.7" in page
    assert "1.52 on the layer and 1.37 on Hertz" in page and "in proportion to the force" in page
    assert "None of the solids tried meets both speeds and the duration" in page
    assert "Nothing has been drawn" in template.render(probable=(), allowed=None, alone=False)


def test_what_the_comparison_needs_is_named_where_it_is_missing(cases, tmp_path):
    from sonicvacuum.files import InputError
    from sonicvacuum_paper.uncertainty.rivals import write_rivals

    without = config.Config(**{**{f: getattr(cases, f) for f in cases.__struct_fields__}, "cases": {}})
    with pytest.raises(InputError, match=r"cases\.fig3a: no variant for the ledger's column layer_loss"):
        write_rivals(without, None, dict.fromkeys(formats.HEADERS, str(tmp_path / "x")))


def test_no_share_of_draws_is_nothing_or_certain():
    row = {"test": "order", "measured": "0"}
    assert uncertain._share("1.0", row) == "> 0.995" and uncertain._share("0.0", row) == "< 0.0052"
    assert uncertain._share("0.92", row) == "0.92"


def test_an_explanation_is_neither_certain_nor_told_where_it_cannot_be():
    """Where the layer is known to be there, a modulus alone has no probability, and a sure one none of 1."""
    table = pd.DataFrame(
        {
            "effects": ["coating-thickness", "dynamic-modulus", "coating-thickness+kuwabara-kono"],
            "log10_bayes": ["0", "1", "9"],
            "misfit": ["38", "10", "0.3"],
            "parameters": ["", "", ""],
        }
    )
    found = list(rivals.weighed(table).values())
    assert found[1][-1] == "–" and found[2][-1] == "above 0.99"
