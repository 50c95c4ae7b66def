"""The public face: what is imported and when, what its examples say, and how many threads its sums take."""

import doctest
import inspect
import json
import os
import re
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest
from ball import RECORD

import sonicvacuum as sv
from sonicvacuum import api, blas, builders, plugins
from sonicvacuum.discover import session
from sonicvacuum.effects import CATALOGUE
from sonicvacuum.physics import solitary, theory
from sonicvacuum.prediction import design, measure

EXAMPLES = (sv, api, builders, measure, design)


def python(code, **environment):
    """Standard output of a fresh interpreter."""
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, env=os.environ | environment
    )
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


@pytest.fixture
def ball(tmp_path):
    (tmp_path / "record.yaml").write_text(RECORD)
    return tmp_path


def test_importing_loads_nothing_and_every_public_name_is_there():
    code = "import sys, sonicvacuum as sv; print({'numpy', 'numba', 'msgspec', 'click'} & set(sys.modules)); "
    assert python(code + "print([n for n in sv.__all__ if not hasattr(sv, n)])") == "set()\n[]"
    assert set(sv.__all__) <= set(dir(sv))
    with pytest.raises(AttributeError, match="no attribute 'nothing'"):
        _ = sv.nothing


def test_what_only_reads_waits_neither_for_the_compiler_nor_for_statistics():
    # Half a second and a second of each start: cards, histories, records and verdicts are read without them.
    code = (
        "import sys, sonicvacuum.simulation, sonicvacuum_paper.metrics, sonicvacuum.report.record, "
        "sonicvacuum.records.review, sonicvacuum.discover.compare, sonicvacuum_blind.score, "
        "sonicvacuum_blind.calibration; "
        "print({'numba', 'scipy.stats', 'matplotlib', 'pandas'} & set(sys.modules))"
    )
    assert python(code) == "set()"


def test_the_examples_of_every_module_are_tried(pytestconfig):
    source = pytestconfig.rootpath / "src"
    having = {p for p in source.rglob("*.py") if ">>> " in p.read_text(encoding="utf-8")}
    assert having == {Path(inspect.getfile(module)) for module in EXAMPLES}


@pytest.mark.parametrize("module", EXAMPLES, ids=lambda module: module.__name__)
def test_the_examples_hold(module):
    failed, tried = doctest.testmod(module)
    assert tried > 0
    assert failed == 0


def test_three_lines_give_a_verdict(ball):
    found = sv.discover(sv.read(ball), threads=1)
    assert found.verdict.named == []
    assert sv.discover.__name__ == "sonicvacuum.discover"  # a package and a function at once


def test_the_package_says_what_the_function_takes():
    assert inspect.signature(sv.discover) == inspect.signature(session.discover)
    assert inspect.getdoc(sv.discover) == inspect.getdoc(session.discover)


def test_it_takes_what_the_function_takes(ball):
    """Limits and catalogue too; the package handed on nothing but `threads`."""
    found = sv.discover(sv.read(ball), threads=1, limits=False, catalogue=CATALOGUE)
    assert found.verdict.named == []
    with pytest.raises(sv.InputError, match="give at least one"):
        sv.discover()


def test_effects_of_installed_packages_are_searched_for_as_by_the_command(ball, monkeypatch):
    class Reached(Exception):
        pass

    def search(records, catalogue, threads):
        raise Reached(catalogue.ids)

    longer = CATALOGUE.extended([replace(CATALOGUE.effect("tsuji"), id="packed")])
    monkeypatch.setattr(plugins, "catalogue", lambda files=(): longer)
    monkeypatch.setattr(session.competition, "discover", search)
    with pytest.raises(Reached, match="packed"):
        sv.discover(sv.read(ball), threads=1)


def test_the_lines_of_the_readme_run_as_they_stand(pytestconfig, tmp_path, monkeypatch, capsys):
    root = pytestconfig.rootpath
    (tmp_path / "my-record").mkdir()
    (tmp_path / "my-record/record.yaml").write_text(RECORD)
    shutil.copy(root / "config.yaml", tmp_path)
    monkeypatch.chdir(tmp_path)
    (code,) = re.findall(r"^```python\n(.*?)^```$", (root / "README.md").read_text("utf-8"), re.M | re.S)
    seen = {}
    exec(code, seen)
    assert capsys.readouterr().out.startswith("[] {")  # nothing named in the record
    assert seen["velocity"].shape == (1601, 1)  # 800 us, a sample each 0.5 us
    assert 0.01 < seen["velocity"].max() < 1.0  # m/s, the striker has 0.5


def test_a_case_of_ones_own_is_refused_with_key_value_and_cure():
    steel = {"diameter_mm": 5.0, "mass_g": 0.5, "material": "bearing-steel"}
    with pytest.raises(sv.InputError, match=r"case: chain\.bead\.mass_g: is -0\.5"):
        sv.case(
            chain={"beads": 3, "orientation": "vertical", "bead": steel | {"mass_g": -0.5}, "wall": steel},
            striker={"shape": "flat", "material": "alumina", "mass_g": 1.0, "speed_m_s": 1.0},
            sensors=[],
            duration_us=1.0,
        )


def test_a_guarded_function_sees_one_thread_and_the_others_come_back():
    """Two threads are asked for; more than one would sum in another order."""
    code = """
import numpy, scipy.linalg, threadpoolctl
from sonicvacuum.blas import one_thread
threads = lambda: {p["num_threads"] for p in threadpoolctl.threadpool_info() if p["user_api"] == "blas"}
print(threads(), one_thread(threads)(), threads())
"""
    assert python(code, OPENBLAS_NUM_THREADS="2") == "{2} {1} {2}"


def test_a_verdict_has_the_same_bytes_whatever_the_threads(ball):
    code = f"""
import sonicvacuum as sv, json
from pathlib import Path
from sonicvacuum.discover.written import write
found = sv.discover(sv.read({str(ball)!r}))
write(found, Path({str(ball / "out")!r}))
"""
    seen = []
    for threads in ("1", "2"):
        python(code, OPENBLAS_NUM_THREADS=threads, NUMBA_NUM_THREADS=threads)
        verdict = json.loads((ball / "out/verdict.json").read_text())
        tables = {
            p.name: p.read_bytes() for p in sorted((ball / "out").iterdir()) if p.name != "verdict.json"
        }
        seen.append(({k: v for k, v in verdict.items() if k != "timing_s"}, tables))
    assert seen[0] == seen[1]


def test_the_guard_keeps_name_and_docstring():
    assert blas.one_thread(api.read).__doc__ == api.read.__doc__


def functions(module):
    """Public functions that a module defines."""
    found = vars(module).items()
    return [f for n, f in found if inspect.isfunction(f) and f.__module__ == module.__name__ and n[0] != "_"]


PUBLIC = {n: getattr(sv, n) for n in sv.__all__ if inspect.isfunction(getattr(sv, n))}


@pytest.mark.parametrize("name", [*PUBLIC, "discover"])
def test_every_public_function_says_what_it_takes_returns_and_refuses(name):
    function = session.discover if name == "discover" else inspect.unwrap(PUBLIC[name])
    told = inspect.getdoc(function)
    args = told.partition("Args:\n")[2].partition("\n\n")[0]
    for parameter in inspect.signature(function).parameters:
        assert re.search(rf"\b{parameter}\b", args), parameter
    assert "Returns:" in told
    assert "Raises:\n    InputError:" in told


def test_public_classes_name_their_attributes_and_formulas_their_source():
    for one in (sv.Chain, sv.Record, sv.Simulation):
        assert "Attributes:" in inspect.getdoc(one)
    formulas = [f for f in functions(theory) if not f.__name__.startswith("require")]
    assert len(formulas) > 10
    assert [f.__name__ for f in formulas if not re.search(r"Eqs?\.|equation", f.__doc__)] == []
    assert all(inspect.getdoc(f) for f in functions(solitary))
    assert "Eq. (3)" in solitary.__doc__


@pytest.mark.parametrize("given", [None, 5, ["law.py"]])
@pytest.mark.parametrize("verb", [sv.catalogue, sv.read, lambda given: sv.read_case(given, "chain")])
def test_what_is_no_path_is_refused_with_the_cure(verb, given):
    with pytest.raises(sv.InputError, match=r"^(catalogue|read|read_case): is given .*; give the path of"):
        verb(given)


@pytest.mark.parametrize("given", ["my_law.py", ["tsuji"], 5])
def test_what_is_no_catalogue_is_refused_with_the_cure(ball, tmp_path, given):
    """It ended in an AttributeError, or was taken without a word where the card has no effects."""
    record, steel = sv.read(ball), sv.bead(diameter_mm=5.0, material="bearing-steel")
    parts = sv.chain(bead=steel, beads=3), sv.striker(steel, speed_m_s=0.5), [sv.gauge("wall")]
    card = sv.case(*parts, duration_us=100)
    model = tmp_path / "model.json"
    for verb in (
        lambda: sv.discover(record, threads=1, catalogue=given),
        lambda: sv.simulate(card, given),
        lambda: sv.compare(model, record, catalogue=given),
    ):
        with pytest.raises(sv.InputError, match=r"^(discover|simulate|compare): catalogue: is .*; give one"):
            verb()


def test_a_striker_of_something_else_than_a_bead_is_refused():
    with pytest.raises(sv.InputError, match=r"^striker: ball: is 'steel'; give what sv\.bead returns"):
        sv.striker("steel", speed_m_s=0.5)


def test_what_is_made_shows_itself_in_a_line(ball):
    """A notebook shows what stands last in a cell: a record of four runs was 128 kB of numbers."""
    steel = sv.bead(diameter_mm=5.0, material="bearing-steel")
    parts = sv.chain(bead=steel, beads=3), sv.striker(steel, speed_m_s=0.5), [sv.gauge("wall")]
    record = sv.read(ball)
    assert repr(record) == f"<Record {ball.name}: 0 beads, 1 run, no gauges>"
    assert repr(sv.discover(record, threads=1)).startswith(f"<Result {ball.name}: none, probability 0.")
    seen = sv.simulate(sv.case(*parts, duration_us=100))
    assert repr(seen) == "<Simulation case.own: 201 samples at 0.5 m/s, wall>"
    assert len(repr(sv.solitary.SolitaryWave.compute())) < 80
