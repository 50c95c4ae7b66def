"""Shell commands of the rules, as they stand in the files: quoted, logged and threaded."""

import re

import pytest


@pytest.fixture(scope="module")
def commands(pytestconfig):
    """[(file of rules, shell command of a rule as it stands there)]."""
    files = [pytestconfig.rootpath / "Snakefile", *(pytestconfig.rootpath / "workflow/rules").glob("*.smk")]
    found = [
        (path.name, command)
        for path in files
        for command in re.findall(r"^ +shell:\n((?: +[\"'].*\n)+)", path.read_text() + "\n", re.MULTILINE)
    ]
    rules_with_commands = sum(path.read_text().count("    shell:\n") for path in files)
    assert len(found) == rules_with_commands > 20
    return found


def test_every_interpolation_of_a_shell_command_is_quoted(commands):
    """In all rules, {x:q} and never {x}: a name may hold what a shell would run."""
    fields = [(name, field) for name, text in commands for field in re.findall(r"\{([^{}]*)\}", text)]
    assert len(fields) > 100
    assert [(name, field) for name, field in fields if not field.endswith(":q")] == []
    loose = [(n, v) for n, text in commands for v in re.findall(r'(?<!")\$\w+', text)]
    assert loose == []


def test_the_log_is_of_all_parts_of_a_command(commands):
    """Without parentheses `a && b > log` keeps what b says, and a's complaint is lost."""
    several = [
        (name, text) for name, text in commands if re.search("&&|;", text) and "> {log:q} 2>&1" in text
    ]
    assert len(several) > 5
    assert [(name, text) for name, text in several if not re.match(r" +[\"']\(", text)] == []


def test_what_searches_and_compares_takes_the_threads_of_its_job(commands):
    searching = [(n, text) for n, text in commands if re.search("sonicvacuum (discover|compare) ", text)]
    assert len(searching) > 4
    assert [(name, text) for name, text in searching if "--threads {threads:q}" not in text] == []
