"""Files are written whole or not at all; what is wrong with one is said in one line."""

import datetime
import os
from typing import Annotated, Literal

import msgspec
import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from sonicvacuum import files
from sonicvacuum.cli import main
from sonicvacuum.files import InputError, check_values, convert, in_one_line, read_text, read_yaml, replacing


def test_a_failure_leaves_what_stood_there(tmp_path):
    path = tmp_path / "a.txt"
    path.write_text("old")
    with pytest.raises(RuntimeError), replacing(path) as stream:
        stream.write("half")
        raise RuntimeError
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_two_who_write_one_file_at_a_time_do_not_share_a_half_written_one(tmp_path):
    path = tmp_path / "deep" / "table.csv"
    with replacing(path) as first:
        first.write("first")
        with replacing(path) as second:
            second.write("second")
        assert path.read_text() == "second"
    assert path.read_text() == "first"
    assert list(path.parent.iterdir()) == [path]


def test_success_replaces_and_makes_folders(tmp_path):
    path = tmp_path / "new" / "a.bin"
    with replacing(path, "wb") as stream:
        stream.write(b"\x00")
    assert path.read_bytes() == b"\x00"
    assert list(path.parent.iterdir()) == [path]


@pytest.mark.parametrize(
    ("text", "hint"),
    [
        ("a: 1\na: 2\n", "line 2: key 'a' stands here twice"),
        ("a: [1\n", "not valid YAML"),
        ("a: 1\nb: 010\n", "line 2: 010 is 8 in YAML"),
        ("a: 0x1F\n", "0x1F is 31 in YAML"),
        ("a: 1:30\n", "1:30 is 90 in YAML"),
        ("a: 1_000.5\n", "1_000.5 is 1000.5 in YAML"),
        ("- 1\n", "found a list"),
        ("", "found nothing"),
        ("a: !!python/object:os.system {}\n", "not valid YAML"),
        ("a:\n\tb: 1\n", "line 2: not valid YAML: found character '\\t'"),
        ("a:\n\tb: 1\n", "; YAML indents with spaces only: replace the tab by spaces"),
        ("a: [1, 2\nb: 3\n", "close the bracket"),
        ("a:\n  b: 1\n c: 2\n", "in the same column"),
        ("a: b: c\n", "quote texts with special characters"),
    ],
)
def test_bad_yaml_is_one_line(tmp_path, text, hint):
    path = tmp_path / "c.yaml"
    path.write_text(text)
    with pytest.raises(InputError) as error:
        read_yaml(path)
    assert str(path) in str(error.value)
    assert hint in str(error.value)


COMMAS = [
    ("a: {b: 1,6}\n", "line 1: b: is 1,6, which YAML reads as 1 and a key 6; decimals take a point"),
    ("a: {b: x,\n  c: -0,05, d: 1}\n", "line 2: c: is -0,05"),
    ("a: {b: 1,5e-3}\n", "b: is 1,5e-3"),
    ("a: [{b: 10,000, c: 1}]\n", "b: is 10,000, .* thousands no mark"),
]


@pytest.mark.parametrize(("text", "told"), COMMAS)
def test_a_decimal_comma_within_braces_is_named(tmp_path, text, told):
    """YAML ends the number there, and takes the rest for a key with nothing in it."""
    (tmp_path / "c.yaml").write_text(text)
    with pytest.raises(InputError, match=rf"c\.yaml, .*{told}"):
        read_yaml(tmp_path / "c.yaml")


@pytest.mark.parametrize("text", ["a: {b: 1, 6: 2}", "a: {b: 1, 6: null}", "a: {b: x, 6}", "a: {6, 7}"])
def test_keys_that_are_numbers_are_keys(tmp_path, text):
    (tmp_path / "c.yaml").write_text(text)
    assert 6 in read_yaml(tmp_path / "c.yaml")["a"]


def test_half_a_character_is_none():
    """YAML has an escape for it, names of files may hold it, and nothing could write it again."""
    with pytest.raises(InputError, match=r"rec: title: is .* which holds control characters"):
        check_values({"title": "a\ud800"}, "rec")
    assert in_one_line("bad\udcff") == r"bad\udcff"


def test_merge_keys_are_allowed(tmp_path):
    path = tmp_path / "c.yaml"
    path.write_text("a: &a {x: 1, y: 2}\nb: {<<: *a, y: 3}\n")
    assert read_yaml(path)["b"] == {"x": 1, "y": 3}


def bomb(levels, merge=False):
    """Some lines whose aliases stand for 10 to the power of so many levels."""
    lines = ["a0: &a0 {x: 1}"]
    for k in range(1, levels + 1):
        parts = ", ".join([f"*a{k - 1}"] * 10)
        lines.append(f"a{k}: &a{k} {{<<: [{parts}], k{k}: [{parts}]}}" if merge else f"a{k}: &a{k} [{parts}]")
    return "\n".join(lines)


@pytest.mark.parametrize(
    "text",
    [
        bomb(9),
        bomb(300),
        bomb(9, merge=True),
        "a: &a [*a]",
        "a: &a {b: *a}",
        "a: " + "[" * 60 + "]" * 60,
    ],
)
def test_more_than_a_hand_writes_is_refused_at_once(tmp_path, text):
    path = tmp_path / "c.yaml"
    path.write_text(text)
    with pytest.raises(InputError, match=r"c\.yaml: holds more than 200000 values or 50 levels"):
        read_yaml(path)


def test_values_that_no_alias_repeats_count_too(tmp_path, monkeypatch):
    monkeypatch.setattr(files, "MOST_VALUES", 2000)
    path = tmp_path / "c.yaml"
    for count, held in ((1990, True), (2010, False)):
        path.write_text("a: [" + "1, " * count + "1]")
        if held:
            assert len(read_yaml(path)["a"]) == count + 1
        else:
            with pytest.raises(InputError, match=r"c\.yaml: holds more than 2000 values"):
                read_yaml(path)


def test_nesting_beyond_what_the_parser_takes_is_one_line(tmp_path):
    path = tmp_path / "c.yaml"
    path.write_text("a: " + "[" * 5000)
    with pytest.raises(InputError, match=r"c\.yaml"):
        read_yaml(path)


def test_a_huge_file_is_not_parsed(tmp_path):
    path = tmp_path / "c.yaml"
    path.write_text("#" * (5 << 20))
    with pytest.raises(InputError, match=r"larger than 4 MB"):
        read_yaml(path)


@pytest.mark.parametrize("read", [read_text, read_yaml])
def test_what_is_no_file_is_refused_and_not_waited_for(tmp_path, read):
    os.mkfifo(tmp_path / "pipe")
    for path, kind in ((tmp_path / "pipe", "a pipe"), ("/dev/zero", "a device"), (tmp_path, "a folder")):
        with pytest.raises(InputError, match=f"{kind}.*give the path of a readable file"):
            read(path)


def test_missing_and_binary_files_are_named(tmp_path):
    with pytest.raises(InputError, match=r"nothing\.yaml: No such file"):
        read_text(tmp_path / "nothing.yaml")
    (tmp_path / "b").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(InputError, match=r"not a text file.*save it as UTF-8"):
        read_text(tmp_path / "b")


@given(st.binary(max_size=200))
def test_no_content_escapes_as_another_error(tmp_path_factory, content):
    path = tmp_path_factory.mktemp("y") / "c.yaml"
    path.write_bytes(content)
    try:
        assert isinstance(read_yaml(path), dict)
    except InputError as error:
        assert str(path) in str(error)


class Inner(msgspec.Struct, forbid_unknown_fields=True):
    size: Annotated[float, msgspec.Meta(gt=0.0)] | None = None


class Outer(msgspec.Struct):
    parts: dict[str, dict[str, Inner]]


@pytest.mark.parametrize(
    ("parts", "told"),
    [
        ({"a": {}, "b": {"c": {}, "d": {"size": "2e0"}}}, "parts.b.d.size: is '2e0'.*write 2.0e[+]0"),
        ({"a": {}, "b": {"c": {"size": 1.0}, "d": {"size": -1.0}}}, "parts.b.d.size: is -1.0"),
        ({"a": {"x": {"sise": 1.0}}, "b": {}}, "parts.a.x.sise: unknown key"),
        ({"a": {3: {}}}, "parts.a: a key here is not allowed, 3: expected `str`, got `int`; quote it"),
        ({"a": {"x": {3: 1}}}, "parts.a.x: a key here is not allowed, 3: .* write decimals with a point"),
    ],
)
def test_keys_that_users_choose_are_named(parts, told):
    with pytest.raises(InputError, match=told):
        convert({"parts": parts}, Outer, "c.yaml")


class Wide(msgspec.Struct):
    positive: Annotated[float, msgspec.Meta(gt=0.0)] = 1.0
    most: Annotated[float, msgspec.Meta(le=0.5)] = 0.0
    count: Annotated[int, msgspec.Meta(ge=1)] = 1
    word: Literal["flat", "sphere"] = "flat"
    either: float | Literal["unknown"] = 0.0
    text: str = ""
    day: datetime.date | None = None
    pair: tuple[float, float] = (0.0, 1.0)
    several: Annotated[list[float], msgspec.Meta(min_length=1)] | None = None
    block: Inner | None = None
    beads: dict[Annotated[int, msgspec.Meta(ge=1)], Inner] = {}
    names: dict[Annotated[str, msgspec.Meta(pattern="^[a-z]*$")], float] = {}


@pytest.mark.parametrize(
    ("key", "value", "told"),
    [
        ("positive", -0.4, "is -0.4: expected `float` > 0.0; write a number above 0"),
        ("positive", "heavy", "is 'heavy': expected `float`, got `str`; write a number"),
        ("positive", "0,44", "decimals take a point, and thousands no mark: write 0.44"),
        ("positive", "1,000", "decimals take a point, and thousands no mark"),
        ("positive", None, "is empty: expected `float`, got `null`; write a number"),
        ("most", 0.7, "write a number of 0.5 or less"),
        ("count", 16.5, "is 16.5: expected `int`, got `float`; write a whole number"),
        ("count", 0, "write a whole number of 1 or more"),
        ("word", "round", "invalid enum value 'round'; write flat or sphere"),
        ("either", "unkown", "write a number, or unknown"),
        ("either", -1j, "write a number, or unknown"),
        ("text", 2006, "is 2006: expected `str`, got `int`; quote it: '2006'"),
        ("text", True, "YAML reads bare yes, no, on, off as true and false: quote the word"),
        ("text", datetime.date(2026, 5, 1), "is 2026-05-01: .* quote it: '2026-05-01'"),
        ("text", [], "write one text, in quotes"),
        ("text", None, "write a text, or leave the key out"),
        ("day", "May", "write the day as in 2026-05-01"),
        ("pair", [0, 1, 1, 2], "of length 2, got 4; give 2, with decimal points"),
        ("several", 3.0, "got `float`; write a list, as in"),
        ("several", [], "give at least 1"),
        ("block", 3.0, "write keys with their values, as in {key: value}"),
        ("beads", {"x": {}}, "a key here is not allowed, 'x': .*; write a whole number of 1 or more"),
        ("beads", {3: {"size": -1}}, ".3.size: is -1: expected `float` > 0.0; write"),
        ("names", {"a b": 1.0}, "a key here is not allowed, 'a b'; use other characters"),
    ],
)
def test_each_kind_of_schema_error_has_its_cure(key, value, told):
    with pytest.raises(InputError, match=rf"^c\.yaml: {key}.*{told}"):
        convert({key: value}, Wide, "c.yaml")


@pytest.mark.parametrize("number", [".nan", ".inf", "-.inf"])
def test_numbers_that_are_none_are_named(number):
    content = yaml.safe_load(f"a: [{{b: 1.0}}, {{b: {number}}}]")
    with pytest.raises(InputError, match=r"c.yaml: a\[1\].b: is .*finite"):
        check_values(content, "c.yaml")


@pytest.mark.parametrize(
    ("content", "told"),
    [
        ({"title": "a\x1b[2J"}, r"c\.yaml: title: is 'a\\x1b\[2J'"),
        ({"runs": [{"id": "\u202ea"}]}, r"c\.yaml: runs\[0\]\.id: .*u202e"),
        ({"materials": {"brass\n": {}}}, r"c\.yaml: materials: key 'brass\\n'"),
    ],
)
def test_what_moves_a_terminals_cursor_is_refused(content, told):
    with pytest.raises(InputError, match=told):
        check_values(content, "c.yaml")


def test_a_text_of_several_lines_is_a_text():
    check_values({"note": "two\n\tlines of µ"}, "c.yaml")


def test_whatever_stands_in_a_path_is_told_in_one_line(monkeypatch, capsys):
    monkeypatch.setattr("sys.argv", ["sonicvacuum", "discover", "no\nsuch\x1b[31m folder", "--out", "x"])
    with pytest.raises(SystemExit) as done:
        main()
    told = capsys.readouterr().err
    assert done.value.code == 2
    assert "\x1b" not in told and "Error" in told.splitlines()[-1]


def test_a_pipe_or_a_device_is_never_replaced_by_a_file(tmp_path, monkeypatch, capsys):
    """Renaming a file to /dev/null would leave no /dev/null."""
    pipe, link = tmp_path / "pipe", tmp_path / "link"
    os.mkfifo(pipe)
    link.symlink_to(pipe)
    for place in (pipe, link):
        with pytest.raises(InputError, match="is a pipe or a device"), replacing(place):
            pass
        monkeypatch.setattr("sys.argv", ["sonicvacuum", "schema", "--out", str(place)])
        with pytest.raises(SystemExit) as done:
            main()
        assert done.value.code == 2
        assert "is a pipe or a device; give the path of a file to write" in capsys.readouterr().err
    assert pipe.is_fifo() and link.is_symlink()


def test_a_link_stays_and_its_file_is_replaced(tmp_path):
    file, link = tmp_path / "far" / "file", tmp_path / "link"
    file.parent.mkdir()
    file.write_text("old")
    link.symlink_to(file)
    with replacing(link) as stream:
        stream.write("new")
    assert link.is_symlink() and file.read_text() == "new"
    assert list(file.parent.iterdir()) == [file]


def test_a_place_that_cannot_be_written_is_named_as_it_was_given(tmp_path):
    path = tmp_path / ("x" * 300)
    with pytest.raises(OSError) as error, replacing(path):
        pass
    assert error.value.filename == str(path)
