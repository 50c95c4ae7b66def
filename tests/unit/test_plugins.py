"""Effects of the user's own: read from files, checked, tried, kept apart; and nobody else knows an id."""

import hashlib
import importlib
import re
import sys
import zipfile
from dataclasses import replace
from pathlib import Path

import pytest
from click.testing import CliRunner

import sonicvacuum
from sonicvacuum import plugins
from sonicvacuum.cli import main
from sonicvacuum.cli.card import effects
from sonicvacuum.effects import CATALOGUE, IDS, Catalogue, trial
from sonicvacuum.files import InputError
from sonicvacuum.physics.run import simulate

LAW = Path(__file__).parents[1] / "discover" / "deep_damping.py"
TEXT = LAW.read_text(encoding="utf-8")
PACKAGE = Path(sonicvacuum.__file__).parent


def written(folder, old="", new="", name="law.py"):
    """The example's file with a change in it."""
    assert old in TEXT
    (folder / name).write_text(TEXT.replace(old, new, 1), encoding="utf-8")
    return folder / name


def test_no_id_stands_outside_its_own_file():
    """Words of the language aside (gravity), no other module of the library names an effect.

    But those of other simulators: each says which laws of the catalogue that simulator has.
    """
    pattern = re.compile(rf"[\"']({'|'.join(IDS)})[\"']")
    for path in sorted(set(PACKAGE.rglob("*.py")) - set((PACKAGE / "export").glob("*.py"))):
        text = re.sub(r'""".*?"""', "", path.read_text(encoding="utf-8"), flags=re.DOTALL)
        own = path.stem.replace("_", "-") if path.parent.name == "effects" else None
        # "gravity" is also a field of a chain, and an orientation's name on a page.
        found = {m[1] for m in pattern.finditer(text)} - {own, "gravity"}
        assert not found, f"{path}: {found}"


def test_a_file_extends_the_catalogue_and_nothing_else():
    known = plugins.catalogue([LAW])
    assert known.ids == (*IDS, "deep-damping")
    assert known.effects[:-1] == CATALOGUE.effects
    assert known.effect("deep-damping").source.name == "deep_damping.py"
    assert plugins.catalogue().ids == IDS


def test_several_effects_come_from_one_file(tmp_path):
    path = written(tmp_path, "EFFECT = Effect(", "ONE = Effect(")
    more = "\nfrom dataclasses import replace\nEFFECTS = [ONE, replace(ONE, id='deeper')]\n"
    path.write_text(path.read_text() + more)
    assert [e.id for e in plugins.read(path)] == ["deep-damping", "deeper"]


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("def change(setup", "def change(setup,,", r"law.py, line \d+: not Python"),
        ('    energy="takes b delta v^2 per time and contact",\n', "", r"line \d+: .*missing.*'energy'"),
        ("deep_force, 1)", "deep_force, 2)", r"line \d+: .*deep_force must take 5 arguments"),
        ('"force", deep_force', '"push", deep_force', r"line \d+: .*slot is 'push'; use one of"),
        ("import Term", "import Terms", r"line \d+: ImportError"),
        ('id="deep-damping"', 'id="tsuji"', "'tsuji' is taken"),
        ('id="deep-damping"', 'id="unknown"', "'unknown' is taken"),
        ('id="deep-damping"', 'id="Deep Damping"', "id: use small letters"),
        ('title="Deep damping"', 'title=""', "title: is ''"),
        ('"log-uniform"', '"flat"', "prior is 'flat'; use one of"),
        ("0.0, 1e2, 1e7", "0.0, 1e7, 1e2", "low below high"),
        ("0.0, 1e2, 1e7", "None, 1e2, 1e7", "one needs an off value"),
        (
            "def change(setup, damping_kg_s_m)",
            "def change(setup, b)",
            r"change: must take \(setup, damping_kg",
        ),
        ("EFFECT = Effect(", "LAW = Effect(", "needs EFFECT = "),
        ("return [damping]", "return [damping, damping]", "trial with damping_kg_s_m"),
        ("return [damping]", "return [damping + 1e4]", "it must fade there"),
        (
            "return damping * delta * rate",
            "return damping * delta * __import__('numpy').sinh(rate)",
            "cannot be compiled: deep_force: TypeError: .* use plain arithmetic and the functions",
        ),
        ("return add_term(", "return id(", "trial with damping_kg_s_m"),
        (
            "return damping * delta * rate",
            "return -damping * delta * rate",
            r"damping_kg_s_m: is declared dissipative and creates energy, 0\.\d+ of what .*; turn the sign",
        ),
        (
            "return damping * delta * rate",
            "return damping * delta * rate * __import__('random').random()",
            "deep_force gives other numbers when called again",
        ),
        ("return [damping]", "return [damping * __import__('random').random()]", "coefficients gives other"),
    ],
)
def test_a_bad_file_is_refused_in_one_line(tmp_path, old, new, message):
    path = written(tmp_path, old, new)
    with pytest.raises(InputError, match=message) as error:
        plugins.catalogue([path])
    assert str(path) in str(error.value)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            "return damping * delta",
            "return dampin * delta",
            "trial with damping_kg_s_m: NameError: name 'dampin'",
        ),
        ("return [damping]", "raise AssertionError('odd')", "trial with damping_kg_s_m: AssertionError: odd"),
        ("return [damping]", "raise SystemExit(3)", "trial with damping_kg_s_m: SystemExit: 3"),
        (
            "    change=change",
            "    change=change, lacks=lambda setup: setup.nothing",
            "trial: AttributeError",
        ),
    ],
)
def test_errors_of_a_law_s_own_code_name_its_line(tmp_path, old, new, message):
    path = written(tmp_path, old, new)
    line = next(k for k, text in enumerate(path.read_text().splitlines(), 1) if new in text)
    with pytest.raises(InputError) as error:
        plugins.catalogue([path])
    assert str(error.value).startswith(f"{path}: effect 'deep-damping': line {line}: {message}")


def test_the_command_ends_with_two(tmp_path, monkeypatch, capsys):
    path = written(tmp_path, "EFFECT = Effect(", "EFFECT = Effekt(")
    monkeypatch.setattr("sys.argv", ["sonicvacuum", "effects", "--effects", str(path)])
    with pytest.raises(SystemExit) as end:
        main()
    assert end.value.code == 2
    assert "NameError" in capsys.readouterr().err


def test_errors_of_a_law_that_its_trial_does_not_meet_are_its_own_too(tmp_path, monkeypatch, capsys):
    """As in a search, of which the trial knows one chain only."""
    path = written(tmp_path, "def change(setup", "def fails():\n    return nothing\n\n\ndef change(setup")
    plugins.catalogue([path])
    module = next(m for m in sys.modules.values() if getattr(m, "__file__", None) == str(path))
    monkeypatch.setattr("sys.argv", ["sonicvacuum", "effects"])
    monkeypatch.setattr("sonicvacuum.plugins.catalogue", lambda files: module.fails())
    with pytest.raises(SystemExit) as end:
        main()
    assert end.value.code == 2
    told = f"Error: {path}, line 21: NameError: name 'nothing' is not defined; correct the effect's code\n"
    assert capsys.readouterr().err == told
    assert plugins.blamed(ValueError("of the program")) is None


def test_an_own_effect_is_listed_behind_the_others():
    shown = CliRunner().invoke(effects, ["--effects", str(LAW)]).output.splitlines()
    assert [line.split()[0] for line in shown] == [*IDS, "deep-damping"]


def force(path):
    """Largest force of the trial's chain with the law of a file, and the key of its compiled code."""
    (one,) = plugins.read(path)
    chain = one.apply(trial.sample(), damping_kg_s_m=1e5).chain
    return simulate(chain, [4], 2e-4, 1e-6).force.max(), chain.actions[0].term.key


def test_an_edited_file_never_runs_stale_code(tmp_path):
    """Saved twice within one second, under one name and of one length."""
    path = written(tmp_path, "damping * delta * rate", "1.0 * damping * delta * rate")
    before, key = force(path)
    path.write_text(path.read_text().replace("1.0 * damping", "0.5 * damping"))
    after, other = force(path)
    assert key != other
    assert after > before  # half the damping leaves a larger force


def installed(folder, monkeypatch, text):
    """A package `laws` 1.2 whose module of a name of its own offers an effect, as pip would leave it."""
    name = f"laws_of_{folder.name}"
    (folder / f"{name}.py").write_text(text)
    about = folder / "laws-1.2.dist-info"
    about.mkdir()
    (about / "METADATA").write_text("Metadata-Version: 2.1\nName: laws\nVersion: 1.2\n")
    (about / "entry_points.txt").write_text(f"[{plugins.GROUP}]\ndeep = {name}:EFFECT\n")
    monkeypatch.syspath_prepend(str(folder))


def test_an_installed_package_may_offer_effects(tmp_path, monkeypatch):
    installed(tmp_path, monkeypatch, TEXT)
    known = plugins.catalogue()
    assert known.ids == (*IDS, "deep-damping")
    assert known.effect("deep-damping").source.name == "laws 1.2"


@pytest.mark.parametrize(("fault", "told"), [("1 / 0", "ZeroDivisionError"), ("exit(3)", "SystemExit")])
def test_a_broken_package_is_named(tmp_path, monkeypatch, fault, told):
    installed(tmp_path, monkeypatch, f"EFFECT = {fault}\n")
    with pytest.raises(InputError, match=rf"entry point deep = .*:EFFECT of laws 1.2: {told}"):
        plugins.catalogue()


NAMED = "laws_of_several_modules"
# A package: its law, what that computes with, imported in all the ways there are, and what it has no part in.
PARTS = {
    "__init__.py": "from .laws.deep import EFFECT\n",
    "laws/__init__.py": "",
    "laws/deep.py": f"from .. import scale\nfrom ..tables.numbers import *\n{TEXT}",
    "scale.py": "def later():\n    from {package}.tables import units\n",
    "tables/__init__.py": "",
    "tables/numbers.py": "import {package}.constants as constants\n",
    "tables/units.py": "",
    "constants.py": "import json\n",
    "plots.py": "",
    "tests/test_deep.py": "from .. import EFFECT\n",
}


def digest(folder, monkeypatch, parts, loaded=""):
    """Of the law of a package with such modules, one of which is loaded already."""
    folder.mkdir()
    with monkeypatch.context() as patch:
        installed(folder, patch, "")
        (folder / f"laws_of_{folder.name}.py").unlink()
        for name, text in parts.items():
            (folder / NAMED / name).parent.mkdir(parents=True, exist_ok=True)
            (folder / NAMED / name).write_text(text.replace("{package}", NAMED))
        about = folder / "laws-1.2.dist-info" / "entry_points.txt"
        about.write_text(f"[{plugins.GROUP}]\ndeep = {NAMED}:EFFECT\n")
        try:
            if loaded:
                importlib.import_module(f"{NAMED}.{loaded}")
            return plugins.catalogue().effect("deep-damping").source.sha256
        finally:
            for name in [n for n in sys.modules if n.split(".")[0] == NAMED]:
                del sys.modules[name]


@pytest.mark.parametrize("changed", PARTS)
def test_a_law_is_what_it_imports_from_its_package(tmp_path, monkeypatch, changed):
    """Another digest with any such module, the same whatever else the package holds."""
    before = digest(tmp_path / "a", monkeypatch, PARTS)
    after = digest(tmp_path / "b", monkeypatch, PARTS | {changed: PARTS[changed] + "# changed\n"})
    assert (before == after) == (changed in ("plots.py", "tests/test_deep.py"))


@pytest.mark.parametrize(
    "line",
    [
        "import importlib\nlater = lambda name: importlib.import_module(name)",
        "from importlib import import_module as brought",
        "later = lambda name: __import__(name)",
        "from {package}.tables import *",
    ],
)
def test_all_of_a_package_counts_where_no_statement_names_what_is_imported(tmp_path, monkeypatch, line):
    parts = PARTS | {"constants.py": f"{line}\n"}
    before = digest(tmp_path / "a", monkeypatch, parts)
    assert before != digest(tmp_path / "b", monkeypatch, parts | {"plots.py": "# changed\n"})


@pytest.mark.parametrize("loaded", ["plots", "tables.units"])
def test_what_else_is_loaded_makes_no_other_law(tmp_path, monkeypatch, loaded):
    """One that the law has no part in; one that it imports later."""
    before = digest(tmp_path / "a", monkeypatch, PARTS)
    assert before == digest(tmp_path / "b", monkeypatch, PARTS, loaded)


@pytest.mark.parametrize(
    "changes",
    [
        {"constants.py": "a = 1\n", "laws/__init__.py": "b = 2\n"},
        {"constants/__init__.py": "a = 1\nb = 2\n"},
    ],
)
def test_bounds_and_names_of_modules_count(tmp_path, monkeypatch, changes):
    """Though their texts, one after the other, are the same."""
    rest = {name: text for name, text in PARTS.items() if name != "constants.py"}
    before = digest(tmp_path / "a", monkeypatch, rest | {"constants.py": "a = 1\nb = 2\n"})
    assert before != digest(tmp_path / "b", monkeypatch, rest | changes)


def test_a_package_in_an_archive_may_offer_effects(tmp_path, monkeypatch):
    installed(tmp_path, monkeypatch, "")
    name = f"laws_of_{tmp_path.name}.py"
    (tmp_path / name).unlink()
    with zipfile.ZipFile(tmp_path / "laws.zip", "w") as archive:
        archive.writestr(name, TEXT)
    monkeypatch.syspath_prepend(str(tmp_path / "laws.zip"))
    digest = hashlib.sha256(TEXT.encode()).hexdigest()
    assert plugins.catalogue().effect("deep-damping").source.sha256 == digest


def test_a_catalogue_is_never_changed():
    one = CATALOGUE.effect("tsuji")
    longer = CATALOGUE.extended([replace(one, id="other")])
    assert "other" in longer
    assert "other" not in CATALOGUE
    with pytest.raises(ValueError, match="'tsuji' is taken"):
        longer.extended([one])


@pytest.mark.parametrize("one", CATALOGUE, ids=IDS)
def test_the_catalogue_passes_the_trial_of_own_effects(one):
    trial.check(one)


def test_effects_are_no_candidates_where_they_cannot_act():
    chain, ball = trial.sample(), trial.sample()
    ball = replace(ball, sensors=(), chain=replace(ball.chain, beads=0))
    assert CATALOGUE.left_out(chain) == {"coating-thickness": "no coating is stated"}
    assert CATALOGUE.left_out(trial.sample(coated=True)) == {}
    without = CATALOGUE.left_out(ball)
    assert without["contact-gap"] == "there is no contact where it could sit"
    assert without["viscous-drag"] == "there are no beads"
    assert without["sensor-droop"] == "there are no gauges"
    left = [e.id for e in CATALOGUE.candidates(ball, without=("tsuji",))]
    assert left == [i for i in IDS if i not in {*without, "tsuji"}]
    assert Catalogue().candidates(chain) == ()
