"""The pictures of the blind study: drawn from the CSV, legible, the same bytes each time."""

import itertools

import numpy as np
import pandas
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from test_drawings import texts

from sonicvacuum.files import InputError
from sonicvacuum_blind import breakdown, catalogue, kept
from sonicvacuum_blind import figures as study
from sonicvacuum_blind.baselines import names
from sonicvacuum_blind.baselines.table import RuleLine
from sonicvacuum_blind.score import write_table

IDS = [e.id for e in catalogue.ENTRIES]
PICTURES = ["accuracy", "confusion", "reliability", "baselines"]


def confusion():
    named = [*IDS, "none", "unknown", "several"]
    return [
        breakdown.Confusion(h, n, 40 * (h == n) + (k + j) % 3, 0.9 if h == n else 0.002)
        for k, h in enumerate(named[:-1])
        for j, n in enumerate(named)
    ]


def accuracy():
    kinds = [("traces", s) for s in (5.0, 7.5, 10.0, 20.0)] + [
        (d, 10.0) for d in names.DESIGNS if d != "traces"
    ]
    return [breakdown.Accuracy(d, s, s, 220, 0.9, 0.86, 0.94, 0.95, 0.92, 0.97, 0.97) for d, s in kinds]


def reliability():
    counts = (0, 0, 3, 8, 15, 20, 60, 150, 300, 1200)
    nothing = (np.nan,) * 3
    return [
        breakdown.Bin(k / 10, (k + 1) / 10, (k + 0.5) / 10, n, *((0.5, 0.3, 0.7) if n else nothing))
        for k, n in enumerate(counts)
    ]


def baselines():
    return [
        RuleLine(rule, measure, group, 1118, 0.93, 0.91, 0.95, "made up")
        for rule in names.RULES
        for measure, group, *_ in names.PANELS
    ]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Folder with all tables."""
    made = tmp_path_factory.mktemp("study")
    tables = {
        "confusion": (confusion(), breakdown.Confusion),
        "accuracy": (accuracy(), breakdown.Accuracy),
        "reliability": (reliability(), breakdown.Bin),
        "baselines": (baselines(), RuleLine),
    }
    for name, (rows, kind) in tables.items():
        write_table(rows, kind, made / f"{name}.csv")
    return made


def drawn(folder, name):
    figure = getattr(study, name)(kept.read(folder, [name])[name])
    FigureCanvasAgg(figure).draw()
    return figure


@pytest.mark.parametrize("name", PICTURES)
def test_texts_stay_on_the_page_and_apart(folder, name):
    figure = drawn(folder, name)
    found, page = texts(figure), figure.bbox
    for text, box in found:
        inside = page.x0 <= box.x0 and box.x1 <= page.x1 and page.y0 <= box.y0 and box.y1 <= page.y1
        assert inside, f"{text.get_text()!r} leaves the page"
    for (one, box), (other, other_box) in itertools.combinations(found, 2):
        assert not box.overlaps(other_box), f"{one.get_text()!r} lies on {other.get_text()!r}"


def test_all_tables_give_pictures_and_the_same_bytes_each_time(folder):
    first = [path.read_bytes() for path in study.draw(kept.read(folder), folder)]
    paths = study.draw(kept.read(folder), folder)
    assert [p.name for p in paths] == [f"{name}.svg" for name in PICTURES]
    assert [p.read_bytes() for p in paths] == first
    assert all(p.with_suffix(".png").stat().st_size > 10_000 for p in paths)


def test_confusion_shows_the_table_cell_by_cell(folder):
    figure = drawn(folder, "confusion")
    table = pandas.read_csv(folder / "confusion.csv", keep_default_na=False)
    image = figure.axes[0].images[0].get_array()
    assert image.shape == (24, 25)
    assert np.array_equal(image.ravel(), table["share"].to_numpy(float))
    assert [t.get_text() for t in figure.axes[0].get_xticklabels()] == [*IDS, "none", "unknown", "several"]


def test_empty_rows_of_a_small_study_are_drawn_too(tmp_path):
    few = [c for c in accuracy() if c.design == "traces" and c.strength == 10.0]
    write_table(few, breakdown.Accuracy, tmp_path / "accuracy.csv")
    empty = [breakdown.Confusion(c.hidden, c.named, 0, np.nan) for c in confusion()]
    write_table(empty, breakdown.Confusion, tmp_path / "confusion.csv")
    paths = study.draw(kept.read(tmp_path), tmp_path)
    assert [p.name for p in paths] == ["accuracy.svg", "confusion.svg"]


def test_a_study_of_empty_records_alone_is_drawn(tmp_path):
    """Its accuracy.csv is a header: no record of it hides one effect."""
    write_table([], breakdown.Accuracy, tmp_path / "accuracy.csv")
    paths = study.draw(kept.read(tmp_path), tmp_path)
    assert [p.name for p in paths] == ["accuracy.svg"]


def test_missing_tables_are_named(tmp_path):
    with pytest.raises(InputError, match=r"accuracy\.csv is missing"):
        kept.read(tmp_path)
    with pytest.raises(InputError, match=r"baselines\.csv is missing"):
        kept.read(tmp_path, ["baselines"])


def test_the_curves_that_come_nearest_to_leaving_their_band_are_named_apart_from_each_other():
    """Twenty-two lines of one look name none: each of four effects has a look of its own, the rest one."""
    rows = [{"effect": "all", "count": 900, "distance": 0.02, "band": 0.04, "inside": "yes"}]
    rows += [
        {"effect": one, "count": 90, "distance": 0.001 * (k + 1), "band": 0.1, "inside": "yes"}
        for k, one in enumerate(IDS)
    ]
    # One that leaves it is orange and named where it does, by as much as it goes.
    rows.append({"effect": "own", "count": 90, "distance": 0.2, "band": 0.1, "inside": "no"})
    for row in rows:
        row["ecdf"] = " ".join(f"{k / 100 + row['distance'] * (k == 40):.4f}" for k in range(1, 100))
    figure = study.pit(pandas.DataFrame(rows))
    axes = figure.axes[1]
    told = [text.get_text() for text in axes.get_legend().get_texts()]
    assert told == IDS[:-5:-1]
    lines = axes.get_legend().get_lines()
    assert len({(one.get_color(), str(one._unscaled_dash_pattern)) for one in lines}) == 4
    drawn = [one for one in axes.get_lines() if len(one.get_xdata()) > 2]
    plain = [one for one in drawn if one.get_color() == study.style.GREY]
    assert len(plain) == len(IDS) - 4 and len(drawn) == len(IDS) + 1
    assert axes.get_ylim()[1] > 2.0  # the one that leaves it is seen whole
    assert "own" in [text.get_text() for text in axes.texts]


def test_marks_of_exact_and_class_level_names_do_not_lie_on_each_other(folder):
    figure = drawn(folder, "accuracy")
    for axes in figure.axes:
        points = [
            axes.transData.transform(np.column_stack([one.get_xdata(), one.get_ydata()]))
            for one in axes.get_lines()
            if one.get_marker() in ("o", "s")
        ]
        exact, level = points
        wide = 4.0 * figure.dpi / 72.0  # of a mark, in pixels
        assert (np.abs(exact - level)[:, 0] > wide).all()


def test_a_curve_that_hardly_leaves_its_band_says_so():
    """One that leaves it by 0.2 % is orange, and looks as if it stayed."""
    ecdf = " ".join(f"{k / 100 - 0.02 * (k == 70):.4f}" for k in range(1, 100))
    row = {"effect": "all", "count": 2000, "distance": 0.02004, "band": 0.02, "inside": "no", "ecdf": ecdf}
    shown = texts(study.pit(pandas.DataFrame([row])))
    assert "farthest: 1.002" in [text.get_text() for text, _ in shown]
