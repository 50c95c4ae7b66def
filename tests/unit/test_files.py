"""Files are written whole or not at all; what is wrong with one is said in one line."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sonicvacuum.files import InputError, read_text, read_yaml, replacing


def test_a_failure_leaves_what_stood_there(tmp_path):
    path = tmp_path / "a.txt"
    path.write_text("old")
    with pytest.raises(RuntimeError), replacing(path) as stream:
        stream.write("half")
        raise RuntimeError
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


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
        ("- 1\n", "found list"),
        ("", "found NoneType"),
        ("a: !!python/object:os.system {}\n", "not valid YAML"),
    ],
)
def test_bad_yaml_is_one_line(tmp_path, text, hint):
    path = tmp_path / "c.yaml"
    path.write_text(text)
    with pytest.raises(InputError) as error:
        read_yaml(path)
    assert str(path) in str(error.value)
    assert hint in str(error.value)


def test_merge_keys_are_allowed(tmp_path):
    path = tmp_path / "c.yaml"
    path.write_text("a: &a {x: 1, y: 2}\nb: {<<: *a, y: 3}\n")
    assert read_yaml(path)["b"] == {"x": 1, "y": 3}


def test_missing_and_binary_files_are_named(tmp_path):
    with pytest.raises(InputError, match=r"nothing\.yaml: No such file"):
        read_text(tmp_path / "nothing.yaml")
    (tmp_path / "b").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(InputError, match="not a text file"):
        read_text(tmp_path / "b")


@given(st.binary(max_size=200))
def test_no_content_escapes_as_another_error(tmp_path_factory, content):
    path = tmp_path_factory.mktemp("y") / "c.yaml"
    path.write_bytes(content)
    try:
        assert isinstance(read_yaml(path), dict)
    except InputError as error:
        assert str(path) in str(error)
