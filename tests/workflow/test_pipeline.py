"""The workflow makes what is missing or touched, and nothing else; bad input stops it with one sentence.

The pipeline is run once on two small cases and a small record; what a change would bring is then read off the
plan.
"""

import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
import yaml
from ball import RECORD
from click.testing import CliRunner
from small_pipeline import ALL, CONFIG, ODD, TARGET, without_batch

from sonicvacuum.cli import cli

# What follows from the record alone.
FOUND = {"discover": 1, "card": 1, "simulate": 1, "observe": 1, "metrics": 1}

PAGE = "results/discover/ball/index.html"

ODD_PAGE = f"results/discover/{ODD}/index.html"


@pytest.fixture(scope="session")
def finished(tmp_path_factory, pytestconfig, snakemake, planned):
    """A copy of the project in which the small pipeline has run."""
    root, folder = pytestconfig.rootpath, tmp_path_factory.mktemp("project")
    for part in ("workflow", "src"):
        shutil.copytree(root / part, folder / part, ignore=shutil.ignore_patterns("__pycache__"))
    for part in ("Snakefile", "requirements.lock", "requirements-build.lock"):
        shutil.copy2(root / part, folder / part)
    (folder / "config.yaml").write_text(CONFIG)
    for name in ("ball", ODD):
        (folder / "records" / name).mkdir(parents=True)
        (folder / "records" / name / "record.yaml").write_text(RECORD)
    assert planned(folder) == ALL
    done = snakemake(folder, TARGET, PAGE, ODD_PAGE)
    assert done.returncode == 0, done.said
    return folder


@pytest.fixture
def project(finished, tmp_path):
    """A copy of the finished project that a test may change."""
    folder = tmp_path / "project"
    shutil.copytree(finished, folder)
    return folder


def test_a_second_run_plans_nothing(finished, planned):
    assert planned(finished) == {}


def test_a_folder_whose_name_a_shell_would_run_is_only_a_folder(finished):
    assert (finished / ODD_PAGE).is_file()
    assert list(finished.rglob("pwned")) == []


def test_touching_without_changing_plans_nothing(project, planned):
    for path in (project / "src/sonicvacuum/observe").glob("*.py"):
        path.touch()
    assert planned(project) == {}


def test_an_edit_above_the_simulation_leaves_the_simulation_alone(project, planned):
    with open(project / "src/sonicvacuum/observe/pulse.py", "a") as stream:
        stream.write("# edited\n")
    assert planned(project) == FOUND | {"observe": 3}


def test_an_edit_of_the_stepper_replans_all_that_follows(project, planned):
    with open(project / "src/sonicvacuum/physics/kernel.py", "a") as stream:
        stream.write("# edited\n")
    assert planned(project) == FOUND | {"card": 3, "simulate": 3, "observe": 3}


def test_changing_one_variant_reruns_its_case_alone(project, planned):
    (project / "config.yaml").write_text(CONFIG.replace("15.0", "14.0"))
    assert planned(project) == {"card": 1, "simulate": 1, "observe": 1, "metrics": 1}


def test_adding_a_case_runs_that_case_alone(project, planned):
    block = "  third:\n" + CONFIG.split("  sweep:\n")[1].replace("*chain", "*chain\n    materials: {}")
    (project / "config.yaml").write_text(CONFIG + block)
    assert planned(project) == {"card": 1, "simulate": 1, "observe": 1, "metrics": 1}


def test_new_data_are_looked_into_and_change_the_cases_that_take_their_model(project, planned):
    (project / "records/ball/record.yaml").write_text(RECORD.replace("0.99", "0.98"))
    assert planned(project) == FOUND


def test_traces_are_watched_whatever_their_files_are_called_and_nothing_beside_them(project, snakemake):
    folder = project / "records/ball"
    for name in ("shot.txt", "shot.csv", "notes.csv"):
        (folder / name).write_text("time_us,wall\n")
    named = [{"signals": name} for name in ("shot.txt", "shot.csv", "missing.csv", 7, None)]
    for text, watched in (
        (yaml.safe_dump({"runs": [*named, "none"]}), ["record.yaml", "shot.csv", "shot.txt"]),
        (yaml.safe_dump({"runs": 3}), ["record.yaml"]),
        ("runs: [", ["record.yaml"]),  # what is wrong with it is told by the job, and by that alone
    ):
        (folder / "record.yaml").write_text(text)
        done = snakemake(project, "--dry-run", "results/discover/ball/verdict.json")
        assert done.returncode == 0, done.said
        newer = re.search(r"Updated input files: ([^;\n]+)", done.said)[1].split(", ")
        assert sorted(newer) == [f"records/ball/{name}" for name in watched]


def test_an_edit_of_the_wording_discovers_nothing_anew(project, planned):
    with open(project / "src/sonicvacuum/report/words.py", "a") as stream:
        stream.write("# edited\n")
    assert planned(project) == {}
    assert planned(project, PAGE) == {"record_page": 1}


def test_a_folder_without_a_record_stops_with_one_sentence(project, snakemake):
    (project / "config.yaml").write_text(CONFIG.replace("records/ball", "records/bell"))
    done = snakemake(project, "--dry-run", TARGET)
    assert done.returncode != 0
    assert "model.record: is 'ball'; no such record under discover; known: bell" in done.said
    (project / "config.yaml").write_text(CONFIG.replace("records/ball", "elsewhere/ball"))
    done = snakemake(project, "--dry-run", TARGET)
    assert done.returncode != 0
    assert "discover: elsewhere/ball: no record.yaml in this folder" in done.said


def test_a_new_lock_replans_everything(project, planned):
    with open(project / "requirements.lock", "a") as stream:
        stream.write("# edited\n")
    assert planned(project) == ALL


@pytest.mark.parametrize(
    ("outputs", "between"),
    [
        ({"results/histories/coated.soft.npz": "simulate", "results/metrics.csv": "metrics"}, {"observe"}),
        (
            {"results/cards/coated.soft.json": "card", "results/metrics/coated.soft.csv": "observe"},
            {"simulate", "metrics"},
        ),
    ],
    ids=["simulation and table", "card and readings"],
)
def test_deleting_an_output_rebuilds_it_and_its_descendants(project, snakemake, planned, outputs, between):
    whole = {output: (project / output).read_bytes() for output in outputs}
    for output in outputs:
        (project / output).unlink()
    # Of what follows Snakemake may learn only later that nothing is to be done.
    made = set(outputs.values())
    assert made <= planned(project, *outputs).keys() <= made | between
    done = snakemake(project, *outputs)
    assert done.returncode == 0, done.said
    # The rebuilt files are the same to the byte, so nothing that follows from them is made again.
    assert {output: (project / output).read_bytes() for output in outputs} == whole
    assert planned(project) == {}


def test_each_folder_of_products_says_where_they_come_from(project, pytestconfig):
    """Each file's digest, rule, command, sources and inputs, back to what a user wrote; no times."""
    script = pytestconfig.rootpath / "workflow/scripts/provenance.py"
    folders = [project / "results", (project / PAGE).parent, (project / ODD_PAGE).parent]
    out = [str(folder.relative_to(project) / "provenance.json") for folder in folders]
    command = [sys.executable, script, TARGET, PAGE, ODD_PAGE, "--out", *out, "--given", "config.yaml"]
    texts = []
    for _ in range(2):
        subprocess.run(command, cwd=project, check=True)
        texts.append([(project / path).read_bytes() for path in out])
    assert texts[0] == texts[1]
    found = [json.loads(text) for text in texts[0]]
    files = {path: made for one in found for path, made in one["files"].items()}
    for path, digest in [
        *((path, made["sha256"]) for path, made in files.items()),
        *(pair for made in files.values() for pair in made["inputs"].items()),
        *found[0]["given"].items(),
    ]:
        assert hashlib.sha256((project / path).read_bytes()).hexdigest() == digest, path
    assert {without_batch(made["rule"]) for made in files.values()} == {*ALL, "record_page"}
    assert all(re.fullmatch("[0-9a-f]{64}", made["sources"]) for made in files.values())
    assert files[TARGET]["command"].startswith("sonicvacuum paper metrics results/metrics/coated.soft.csv")
    assert found[1]["files"][PAGE.replace("index.html", "verdict.json")]["inputs"].keys() == {
        "records/ball/record.yaml"
    }
    assert all(path.startswith(os.path.dirname(PAGE)) for path in found[1]["files"])


def test_a_bad_configuration_stops_with_one_sentence(project, snakemake):
    (project / "config.yaml").write_text(CONFIG.replace("beads: 5", "beads: five"))
    done = snakemake(project, "--dry-run", TARGET)
    assert done.returncode != 0
    assert "config.yaml: cases.coated.chain.beads: is 'five'" in done.said
    assert "Traceback" not in done.said


def test_another_configuration_may_be_named_and_needs_no_ledger(
    project, snakemake, monkeypatch, pytestconfig
):
    """Its cases are simulated and shown; no statement of the paper has a number, and none is told."""
    head, cases = CONFIG.split("ledger:\n")
    (project / "config.yaml").unlink()
    (project / "own.yaml").write_text(head + cases[cases.index("cases:") :])
    tables = ("results/ledger.csv", "results/assumptions.csv", "results/runs.html")
    done = snakemake(project, *tables, PAGE, "--configfile", "own.yaml")
    assert done.returncode == 0, done.said
    assert "coated.soft" in (project / "results/runs.html").read_text()
    verdicts = {line.split(",")[-2] for line in (project / "results/ledger.csv").read_text().splitlines()[1:]}
    assert "disagrees" not in verdicts
    # What else the whole page needs takes long, and says nothing of these cases.
    monkeypatch.chdir(project)
    cards = [f"--card={path}" for path in sorted(Path("results/cards").glob("*.json"))]
    given = [f"--{name}=results/{name}.csv" for name in ("ledger", "assumptions", "metrics")]
    claims = f"--claims={pytestconfig.rootpath / 'workflow/resources/claims.csv'}"
    more = ["--histories=results/histories", f"--discovery={Path(PAGE).parent}", "--out=report.html"]
    done = CliRunner().invoke(cli, ["paper", "report", *given, claims, *cards, *more], catch_exceptions=False)
    assert done.exit_code == 0, done.output
    page = Path("report.html").read_text(encoding="utf-8")
    assert "<h1>Simulated chains</h1>" in page
    assert page.count('class="run" data-scales') == len(cards) + 1  # one card has two speeds
    assert "4 cases of your own configuration, simulated, and 1 record" in page
    assert "Nothing is named" in page
    assert not [
        part for part in ("first", "asked", "disagreements", "ledger", "audit") if f'id="{part}"' in page
    ]
