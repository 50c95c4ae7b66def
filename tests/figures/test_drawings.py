"""The pictures: drawn from the CSV, to scale, legible, and the same bytes each time."""

import itertools
import re
import subprocess
import sys

import matplotlib.colors
import numpy as np
import pandas
import pytest
from matplotlib.text import Text
from matplotlib.transforms import Bbox

from sonicvacuum.figures import style
from sonicvacuum.observe.pulse import PROMINENCE
from sonicvacuum_paper import figures
from sonicvacuum_paper.figures import traces
from sonicvacuum_paper.figures.looks import look
from sonicvacuum_paper.printed import PRINTED
from sonicvacuum_paper.report import guide

NAMES = figures.names()


def lines(axes):
    """gid → line of the lines that carry a name."""
    return {line.get_gid(): line for line in axes.lines if line.get_gid()}


def texts(figure):
    """All texts with ink on the page and their boxes in pixels, 1 % shrunk for touching glyph boxes."""
    renderer = figure.canvas.get_renderer()
    found = [t for t in figure.findobj(Text) if t.get_visible() and t.get_text().strip()]
    hidden = {id(t) for axes in figure.axes for t in _ticks_outside(axes)}
    boxes = [(t, t.get_window_extent(renderer)) for t in found if id(t) not in hidden]
    return [(t, Bbox.from_bounds(b.x0, b.y0, b.width, b.height).expanded(0.99, 0.99)) for t, b in boxes]


def _ticks_outside(axes):
    """Tick labels that matplotlib keeps but does not draw: those beyond the limits."""
    for axis in (axes.xaxis, axes.yaxis):
        low, high = sorted(axis.get_view_interval())
        room = 1e-9 * (high - low)
        for tick in (*axis.get_major_ticks(), *axis.get_minor_ticks()):
            inside = low - room <= tick.get_loc() <= high + room
            yield from (t for t, on in ((tick.label1, inside), (tick.label2, False)) if not on)


@pytest.mark.parametrize("name", NAMES)
def test_no_text_overlaps_another_or_leaves_the_page(drawn, name):
    _, figure = drawn[name]
    found = texts(figure)
    page = figure.bbox
    for text, box in found:
        inside = page.x0 <= box.x0 and box.x1 <= page.x1 and page.y0 <= box.y0 and box.y1 <= page.y1
        assert inside, f"{text.get_text()!r} leaves the page"
    for (one, box), (other, other_box) in itertools.combinations(found, 2):
        assert not box.overlaps(other_box), f"{one.get_text()!r} lies on {other.get_text()!r}"


@pytest.mark.parametrize("name", NAMES)
def test_no_data_runs_through_a_text(drawn, name):
    _, figure = drawn[name]
    boxes = texts(figure)
    for axes in figure.axes:
        for gid, line in lines(axes).items():
            path = line.get_transform().transform(line.get_xydata())
            fine = np.concatenate([np.linspace(a, b, 20) for a, b in itertools.pairwise(path)])
            for text, box in boxes:
                struck = ((fine > [box.x0, box.y0]) & (fine < [box.x1, box.y1])).all(axis=1).any()
                assert not struck, f"{gid} runs through {text.get_text()!r}"


@pytest.mark.parametrize("name", NAMES)
def test_text_is_legible_in_print_and_the_width_is_that_of_a_page(drawn, name):
    _, figure = drawn[name]
    assert min(text.get_fontsize() for text, _ in texts(figure)) >= 7.0
    assert figure.get_figwidth() * 25.4 == pytest.approx(style.DOUBLE)
    assert {t.get_fontname() for t, _ in texts(figure)} == {"DejaVu Sans"}


@pytest.mark.parametrize("name", ["fig3", "fig5"])
def test_the_scale_bars_are_as_long_as_their_labels_say(drawn, name):
    _, figure = drawn[name]
    forces = {"a": PRINTED.coated_bar, "b": PRINTED.steel_bar}
    for axes, (panel, force) in zip(figure.axes, forces.items(), strict=True):
        upright, level = (lines(axes)[f"{kind}-bar-{panel}"] for kind in ("force", "time"))
        assert np.ptp(upright.get_ydata()) == pytest.approx(force)
        assert np.ptp(upright.get_xdata()) == np.ptp(level.get_ydata()) == 0.0
        written = [t.get_text() for t in axes.texts]
        assert f"{force:g} N" in written
        assert f"{np.ptp(level.get_xdata()):g} µs" in written
        assert len(axes.get_yticks()) == 0


@pytest.mark.parametrize("name", ["fig3", "fig5"])
def test_drawn_traces_are_the_csv_shifted_and_do_not_touch_the_next(drawn, name):
    table, figure = drawn[name]
    for panel, axes in zip("ab", figure.axes, strict=True):
        part, tops = table[table.panel == panel], {}
        for (series, sensor, modulus), rows in part[part.series.isin(["simulated", "reflected"])].groupby(
            ["series", "sensor", "model"]
        ):
            line = lines(axes)[f"{series}-{sensor}-{modulus}"]
            assert np.array_equal(line.get_xdata(), rows.time_us)
            shift = line.get_ydata() - rows.force_N
            assert np.ptp(shift) < 1e-9  # rounding of a sum of some ten newtons
            tops.setdefault(sensor, []).append((shift.iloc[0], max(line.get_ydata())))
        spans = [(min(b for b, _ in tops[s]), max(t for _, t in tops[s])) for s in ("wall", "g5", "g9")]
        assert all(len({round(b, 9) for b, _ in shifts}) == 1 for shifts in tops.values())
        assert all(top < base for (_, top), (base, _) in itertools.pairwise(spans))


def test_fig4_and_fig6_draw_the_numbers_of_the_csv(drawn):
    table, figure = drawn["fig4"]
    for panel, axes in zip("ab", figure.axes, strict=True):
        part = table[table.panel == panel]
        for (modulus, way), sweep in part[part.series == "simulated"].groupby(["model", "orientation"]):
            line = lines(axes)[f"simulated-{modulus}-{way}"]
            assert np.array_equal(line.get_xydata(), sweep[["force_N", "speed_m_s"]])
    table, figure = drawn["fig6"]
    for panel, axes in zip("ab", figure.axes, strict=True):
        part = table[(table.panel == panel) & (table.series == "simulated")]
        for modulus, trace in part.groupby("model"):
            assert np.array_equal(
                lines(axes)[f"simulated-wall-{modulus}-{panel}"].get_xydata(), trace[["time_us", "force_N"]]
            )


def test_what_is_weak_in_fig6_stands_whole_in_an_inset(drawn):
    table, figure = drawn["fig6"]
    light, heavy = figure.axes
    assert not heavy.child_axes
    (inset,) = light.child_axes
    highest = table[table.panel == "a"].groupby("model").force_N.max()
    weak = {"layer-loss", "layer-loss-geometry"}
    assert set(highest.index[highest < 0.2 * highest.max()]) == weak
    assert set(lines(inset)) == {f"simulated-wall-{model}-a-inset" for model in weak}
    last, top = inset.get_xlim()[1], inset.get_ylim()[1]
    for line in lines(inset).values():
        time, force = line.get_xydata().T
        assert force.max() < top and time.max() <= last
        assert abs(force[time < inset.get_xlim()[0]]).max() < 0.01 * force.max()
    for axes in figure.axes:  # nor does a panel cut anything
        for line in lines(axes).values():
            assert line.get_ydata().max() < axes.get_ylim()[1]


@pytest.mark.parametrize("name", NAMES)
def test_drawing_follows_the_csv_and_nothing_else(made, name, tmp_path):
    """Doubled forces in the file are doubled in the picture."""
    text = made[name][0].read_text().splitlines()
    column = text[0].split(",").index("force_N")
    cells = [line.split(",") for line in text]
    for row in cells[1:]:
        row[column] = str(2.0 * float(row[column])) if row[column] else ""
    changed = tmp_path / f"{name}.csv"
    changed.write_text("\n".join(",".join(row) for row in cells) + "\n")
    before, after = (figures.draw(name, path).axes[0] for path in (made[name][0], changed))
    gid = next(g for g in lines(before) if g.startswith("simulated"))
    axis = 0 if name == "fig4" else 1
    shapes = [np.asarray(lines(axes)[gid].get_xydata())[:, axis] for axes in (before, after)]
    if name in ("fig3", "fig5"):  # less the shift: a trace starts at rest
        shapes = [shape - shape[0] for shape in shapes]
    assert np.allclose(shapes[1], 2.0 * shapes[0], rtol=1e-9, atol=1e-9)  # rounding of the shift


@pytest.mark.parametrize("name", NAMES)
def test_equal_simulations_give_equal_bytes(made, simulations, name, tmp_path):
    again = figures.make(name, simulations, tmp_path)
    for old, new in zip(made[name], again, strict=True):
        assert old.read_bytes() == new.read_bytes(), new.suffix
    svg = again[1].read_text()
    assert not re.search(r"<dc:date>|<dc:creator>|20\d\d-\d\d-\d\d", svg)


def simulated_vision(color, kind):
    """A colour as seen in grey print, or with no green (or red) cones; linear RGB, Machado et al. 2009."""
    rgb = np.asarray(matplotlib.colors.to_rgb(color))
    linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    matrix = {
        "grey": [[0.2126, 0.7152, 0.0722]] * 3,
        "deuteranopia": [[0.367, 0.861, -0.228], [0.280, 0.673, 0.047], [-0.012, 0.043, 0.969]],
        "protanopia": [[0.152, 1.053, -0.205], [0.115, 0.786, 0.099], [-0.004, -0.048, 1.052]],
    }[kind]
    seen = np.clip(np.array(matrix) @ linear, 0.0, 1.0)
    return np.where(seen <= 0.0031308, 12.92 * seen, 1.055 * seen ** (1 / 2.4) - 0.055)


def test_moduli_are_told_apart_by_dashes_and_marks_and_by_colour_in_colour_blindness():
    looks = [look(modulus) for modulus in ("matched", "membrane", "handbook", "layer")]
    for one, other in itertools.combinations(looks, 2):
        assert one.dashes != other.dashes
        assert one.marker != other.marker
        for kind in ("deuteranopia", "protanopia"):
            apart = np.linalg.norm(simulated_vision(one.color, kind) - simulated_vision(other.color, kind))
            assert apart > 0.2, (one.name, other.name, kind)  # of sqrt(3); 0.1 is seen side by side
    for each in (*looks, look("nominal")):
        # Grey of at most 0.6 stands out from white paper by a contrast of about 3, the usual least for lines.
        assert simulated_vision(each.color, "grey")[0] <= 0.6, each.name


def test_a_modulus_that_the_paper_does_not_mention_has_a_look_of_its_own():
    known = {look(modulus).color for modulus in ("matched", "membrane", "handbook", "nominal")}
    assert look("soft").color not in known


def test_labels_count_beads_as_the_paper_does():
    assert traces.label_of("g9") == "9th bead"
    assert traces.label_of("wall") == "wall"


def test_importing_the_package_loads_neither_matplotlib_nor_pandas():
    code = (
        "import sys, sonicvacuum_paper.figures as f; f.names(); "
        "print({'matplotlib', 'pandas'} & set(sys.modules))"
    )
    seen = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert seen.stdout.strip() == "set()"


def test_the_readme_is_the_one_that_registry_and_claims_make(pytestconfig):
    root = pytestconfig.rootpath
    made = guide.text(root / "workflow/resources/claims.csv")
    assert (root / "figures/README.md").read_text(encoding="utf-8") == made, (
        "write figures/README.md again with sonicvacuum_paper.report.guide"
    )


def test_every_claim_about_a_figure_is_listed_with_it(pytestconfig):
    text = guide.text(pytestconfig.rootpath / "workflow/resources/claims.csv")
    part = {name: text.split(f"## Fig. {name[3:]}\n")[1].split("\n## ")[0] for name in NAMES}
    for name, claim in (("fig3", "fig3a-speed"), ("fig4", "fig4a-slope"), ("fig5", "fig5a-less-split")):
        assert f"`{claim}`" in part[name]
    assert "`fig3a-speed`" not in part["fig4"]


def test_the_hump_that_fig_6_does_not_count_dips_by_less_than_it_asks_for(pytestconfig):
    table = pandas.read_csv(pytestconfig.rootpath / "figures/fig6.csv")
    line = table[
        (table.panel == "b") & (table.model == "layer-loss-geometry") & (table.series == "simulated")
    ]
    force = line.force_N.to_numpy()
    falls, rises = force[1:-1] - force[:-2] < 0.0, force[2:] - force[1:-1] > 0.0
    (valley,) = 1 + np.flatnonzero(falls & rises & (force[1:-1] > 0.15 * force.max()))
    dip = (force[valley:].max() - force[valley]) / force.max()
    assert 0.01 < dip < PROMINENCE


@pytest.mark.parametrize("name", NAMES)
def test_captions_say_what_is_simulated_printed_and_not_available(name):
    caption = figures.caption(name)
    assert "imulated" in caption.replace("\n", " ")
    assert "not available" in caption
    assert "paper" in caption
    assert "  " not in caption
    assert len(caption.split()) <= 60
    assert caption.endswith(".")
