"""Points read off the paper's figures: refused without provenance, drawn, and held against each model.

The points of these tests are the simulation's own, so that what must come out is known.
"""

import pandas as pd
import pytest
import yaml
from click.testing import CliRunner

from sonicvacuum.files import InputError
from sonicvacuum_paper import digitised, figures
from sonicvacuum_paper.cli.draw import digitised as verb

PROVENANCE = {"who": "A. Reader", "how": "ruler", "scale": "two ticks an axis", "date": "2026-01-31"}


def block(points, **keys):
    return {
        "format": 1,
        "figure": "fig4",
        "panel": "a",
        "what": "Solid dots",
        "provenance": PROVENANCE,
        "error": {"x": 0.01, "y": 1.0},
        "points": points,
    } | keys


@pytest.fixture
def written(tmp_path):
    def write(content):
        path = tmp_path / "points.yaml"
        path.write_text(yaml.safe_dump(content))
        return path

    return write


@pytest.fixture(scope="module")
def sweep(drawn):
    """Readings and speeds of the layer with a loss in Fig. 4(a)."""
    table = drawn["fig4"][0]
    own = table[(table.series == "simulated") & (table.panel == "a") & (table.model == "layer-loss")]
    return [(float(a), float(b)) for a, b in zip(own.gauge_N, own.speed_m_s, strict=True)][2:-2]


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"provenance": {"who": "A. Reader"}}, "provenance.how"),
        ({"error": {"x": 0.0, "y": 1.0}}, "error.x"),
        ({"colour": "red"}, "colour"),
        ({"points": []}, "points"),
        ({"points": [[0.25, -1.0]]}, "points: forces and speeds of fig4 must be positive"),
        ({"sensor": "g9"}, "points of fig4 have none"),
        ({"figure": "fig3"}, "sensor: is missing"),
        ({"figure": "fig6", "sensor": "g9"}, "fig6 shows the wall alone"),
        ({"figure": "fig7"}, "figure"),
    ],
)
def test_what_is_wrong_is_named(written, change, told):
    path = written(block([[0.25, 130.0]]) | change)
    with pytest.raises(InputError) as caught:
        digitised.read(path)
    assert str(path) in str(caught.value) and told in str(caught.value)


def test_points_on_a_model_s_own_curve_leave_nothing_of_it(written, sweep, drawn):
    found = digitised.left(digitised.read(written(block(sweep))), drawn["fig4"][0])
    assert found["layer-loss"] < 1e-6  # the points themselves, to seven digits
    assert found["handbook"] > 100.0 and found["matched"] > 10.0


def test_points_are_drawn_at_the_force_that_their_reading_means(written, sweep, simulations, tmp_path):
    points = [digitised.read(written(block(sweep)))]
    path, *_ = figures.make("fig4", simulations, tmp_path, points)
    table = pd.read_csv(path)
    read = table[table.series == digitised.SERIES]
    own = table[
        (table.series == "simulated") & (table.model == "layer-loss") & table.gauge_N.isin(read.gauge_N)
    ]
    assert list(read.force_N) == pytest.approx(list(own.force_N), rel=1e-6)
    labels = [t.get_text() for t in figures.draw("fig4", path).axes[0].get_legend().get_texts()]
    assert "read off the paper's figure" in labels


@pytest.mark.parametrize(("figure", "sensor"), [("fig3", "g9"), ("fig5", "wall"), ("fig6", "wall")])
def test_a_trace_lies_on_its_gauge_s_line(written, simulations, tmp_path, figure, sensor):
    table = pd.read_csv(figures.make(figure, simulations, tmp_path)[0])
    line = table[(table.panel == "a") & (table.sensor == sensor) & (table.model == "matched")]
    line = line[line.series == "simulated"].iloc[::40]
    own = [(float(t), float(f)) for t, f in zip(line.time_us, line.force_N, strict=True)]
    points = digitised.read(written(block(own, figure=figure, sensor=sensor)))
    assert digitised.left(points, table)["matched"] < 1e-6
    path, *_ = figures.make(figure, simulations, tmp_path, [points])
    axes = figures.draw(figure, path).axes[0]
    (crosses,) = (one for one in axes.lines if one.get_gid() == "digitised" and len(one.get_xdata()))
    assert len(crosses.get_xdata()) == len(own)


def test_the_verb_ranks_the_models_and_wants_the_right_figure(written, sweep, made):
    path = written(block(sweep))
    told = CliRunner().invoke(verb, [str(path), "--figure", str(made["fig4"][0])])
    assert told.exit_code == 0 and told.output.splitlines()[1].startswith("  layer-loss: chi2/N")
    wrong = CliRunner().invoke(verb, [str(path), "--figure", str(made["fig3"][0])])
    assert "give --figure fig4.csv" in str(wrong.exception)
