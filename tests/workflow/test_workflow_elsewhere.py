"""The workflow used from another folder, as a module of another workflow, and read without a run."""

import re

import pytest
from ball import RECORD
from small_pipeline import ALL, CONFIG, ODD


def write_config(folder):
    """A configuration in a folder of its own, with the records that it names."""
    (folder / "own.yaml").write_text(CONFIG)
    for name in ("ball", ODD):
        (folder / "records" / name).mkdir(parents=True)
        (folder / "records" / name / "record.yaml").write_text(RECORD)


@pytest.mark.parametrize("rule", ["publish_study", "publish_again"])
def test_what_is_kept_in_git_is_that_of_the_project_wherever_the_workflow_is_used(
    rule, tmp_path, pytestconfig, snakemake
):
    root = pytestconfig.rootpath
    write_config(tmp_path)
    done = snakemake(
        tmp_path,
        *("--snakefile", str(root / "workflow/Snakefile"), "--config", "configuration=own.yaml"),
        *("--dry-run", "--printshellcmds", rule),
    )
    assert done.returncode == 0, done.said
    (command,) = re.findall(r"sonicvacuum blind (?:publish|tables) .*--page .*", done.said)
    written = re.findall(r"--(?:page|readme|keep) (\S+)", command)
    assert written and all(path.startswith(f"{root}/") for path in written), command


def test_the_root_makes_by_default_all_that_the_workflow_makes(pytestconfig, snakemake):
    done = snakemake(pytestconfig.rootpath, "--dry-run", "--forceall", "--quiet", "host")
    jobs = set(re.findall(r"^(\w+)\s+\d+$", done.said, flags=re.MULTILINE))
    assert {
        "pipeline",
        "provenance",
        "page",
        "ledger",
        "draw",
        "record_page",
        "timings",
        "draw_kept",
        "score",
    } <= jobs


def test_another_workflow_can_use_this_one_as_a_module(tmp_path, pytestconfig, planned):
    """Config and records are the other's, code and resources stay here."""
    write_config(tmp_path)
    (tmp_path / "Snakefile").write_text(
        f"""
module sonicvacuum:
    snakefile: {str(pytestconfig.rootpath / "workflow/Snakefile")!r}
    config: {{"configuration": "own.yaml"}}

use rule * from sonicvacuum as sv_*
"""
    )
    assert planned(tmp_path) == {f"sv_{rule}": count for rule, count in ALL.items()}


def test_the_workflow_passes_its_lint(pytestconfig, snakemake):
    done = snakemake(pytestconfig.rootpath, "--lint")
    assert done.returncode == 0, done.said
