"""Files that others' machines read: CODECHECK, the Snakemake catalogue, the checks on a forge."""

import os

import pytest
import yaml

# Keys of https://codecheck.org.uk/spec/config/1.0/; those after `manifest` are the codechecker's to fill in.
CODECHECK = {"version", "paper", "manifest", "source", "codechecker", "report", "summary", "repository"}
CODECHECK |= {"check_time", "certificate"}


@pytest.fixture
def read(pytestconfig):
    """Call: the content of a YAML file of the project."""
    return lambda name: yaml.safe_load((pytestconfig.rootpath / name).read_text(encoding="utf-8"))


def test_codecheck_names_what_is_in_git(read, pytestconfig):
    content = read("codecheck.yml")
    assert set(content) <= CODECHECK
    assert content["version"] == "https://codecheck.org.uk/spec/config/1.0/"
    paper = content["paper"]
    assert paper["title"] and paper["reference"].startswith("https://doi.org/")
    assert all(author["name"] for author in paper["authors"])
    for entry in content["manifest"]:
        assert set(entry) == {"file", "comment"}
        assert (pytestconfig.rootpath / entry["file"]).is_file(), entry["file"]


def test_the_catalogue_finds_what_standardised_usage_asks_for(read, pytestconfig):
    usage = read(".snakemake-workflow-catalog.yml")["usage"]
    assert set(usage) == {"mandatory-flags", "software-stack-deployment", "report"}
    assert set(usage["mandatory-flags"]) == {"desc", "flags"}
    deployment = usage["software-stack-deployment"]
    assert deployment["conda"] is True
    rules = (pytestconfig.rootpath / "workflow/rules").glob("*.smk")
    assert all(
        "conda:" in text for path in rules if "\nrule " in (text := path.read_text()) and "shell:" in text
    )
    assert usage["report"] == ('\nreport: "' in (pytestconfig.rootpath / "workflow/Snakefile").read_text())
    for path in ("workflow/Snakefile", "config/README.md", "workflow/envs/locked.yaml"):
        assert (pytestconfig.rootpath / path).is_file()


def test_the_forge_runs_the_checks_that_stand_in_the_project(read, pytestconfig):
    # YAML reads the key `on` as true.
    content = read(".github/workflows/checks.yml")
    assert content[True] == ["push", "pull_request"]
    steps = content["jobs"]["checks"]["steps"]
    assert [step["run"] for step in steps if "run" in step] == [".ci/run"]
    assert os.access(pytestconfig.rootpath / ".ci/run", os.X_OK)


def test_the_profile_for_slurm_names_rules_that_exist(read, pytestconfig):
    profile = read("workflow/profiles/slurm/config.yaml")
    text = "".join(path.read_text() for path in (pytestconfig.rootpath / "workflow/rules").glob("*.smk"))
    groups = dict(entry.split("=") for entry in profile["groups"])
    chosen = {*groups, *(entry.split(":")[0] for entry in profile["set-resources"])}
    assert all(f"\nrule {rule}:\n" in text for rule in chosen)
    assert {entry.split("=")[0] for entry in profile["group-components"]} == set(groups.values())
