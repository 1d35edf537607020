"""What is wrong in a design file is told with its line, from slips of syntax to items of lists."""

from __future__ import annotations

import tomllib
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gearcam.base.errors import DesignError
from gearcam.designs import load
from gearcam.designs.lines import line_at, lines_of
from gearcam.designs.slips import nearest
from helpers_files import PAIR, only


@pytest.mark.parametrize(
    ("text", "line", "words"),
    [
        ("kind = \n", 1, "column 8"),
        ("a = 1\nb 2\n", 2, "="),
        ("a = 1\na = 2\n", 2, "twice"),
        ("a = [1, 2\nb = 3\n", 2, "the closing ]"),
        ('a = "x\nb = 1\n', 1, "quote"),
        ("a = 1 2\n", 1, "more after the value"),
        ("[a\nb = 1\n", 1, "]"),
        ("a = [1,\n", 1, "end of the file"),
    ],
)
def test_a_slip_of_syntax_is_told_by_line_in_plain_words(text: str, line: int, words: str) -> None:
    problem = only(text)
    assert problem.line == line
    assert words in problem.message


@pytest.mark.parametrize(
    ("text", "line", "hint"),
    [
        ("a = 2,5\n", 1, "write 2.5, with a decimal point"),
        ("a = 1\r\nb.c = -0,25  # as at home\r\n", 2, "write -0.25, with a decimal point"),
        ("a = 2,5,\n", 1, ""),
        ("a = 1 2\n", 1, ""),
        ("a = 2.5,5\n", 1, ""),
    ],
)
def test_a_decimal_comma_is_noticed(text: str, line: int, hint: str) -> None:
    problem = only(text)
    assert (problem.line, problem.hint) == (line, hint)


def test_what_is_not_near_is_not_meant() -> None:
    known = ["arm", "arm_mm", "pivot_distance_mm", "radius_mm"]
    words = ("rpm", "tip", "raduis_mm", "Arm_mm", "tadius_mm")
    assert [nearest(word, known) for word in words] == ["", "", "radius_mm", "arm_mm", "radius_mm"]


@pytest.mark.parametrize("text", ["a = " + "[" * 5000, "a = " + "9" * 5000, "a = 2020-13-45\n"])
def test_hostile_toml_is_refused_without_a_crash(text: str) -> None:
    only(text)


def test_files_that_cannot_be_read_are_told_plainly(tmp_path: Path) -> None:
    def message(path: Path) -> str:
        with pytest.raises(DesignError) as caught:
            load(path)
        return str(caught.value)

    assert "no such file" in message(tmp_path / "none.toml")
    assert "folder" in message(tmp_path)
    (tmp_path / "latin.toml").write_bytes(b'kind = "gear-pair"\nname = "r\xe4der"\n')
    assert ":2: the byte 0xe4 is not UTF-8" in message(tmp_path / "latin.toml")
    assert "not a possible file name" in message(tmp_path / "nul\0.toml")


def test_byte_order_mark_and_windows_line_ends_do_not_matter(tmp_path: Path) -> None:
    path = tmp_path / "windows.toml"
    path.write_bytes(b"\xef\xbb\xbf" + PAIR.replace("\n", "\r\n").encode())
    assert load(path).name == "good"
    path.write_bytes(PAIR.replace("\n", "\r\n").replace("180", "-180").encode())
    with pytest.raises(DesignError) as caught:
        load(path)
    assert caught.value.problems[0].line == 10


TOML_VALUES = st.recursive(
    st.integers(-9, 9) | st.booleans() | st.sampled_from(["x", "a # b", "]", "}", "=", "\n"]),
    lambda inner: (
        st.lists(inner, max_size=3) | st.dictionaries(st.sampled_from("abc"), inner, max_size=2)
    ),
    max_leaves=6,
)


def _toml(value: object, breaks: bool) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return (
            f'"""{value}"""'
            if breaks and "\\" not in value
            else '"' + value.replace("\n", "\\n") + '"'
        )
    if isinstance(value, list):
        gap = "\n  # note ]\n" if breaks else " "
        return "[" + "".join(f"{gap}{_toml(item, breaks)}," for item in value) + gap + "]"
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key} = {_toml(item, False)}" for key, item in value.items()) + "}"
    return str(value)


def _paths(value: object, path: tuple[str | int, ...] = ()) -> list[tuple[str | int, ...]]:
    found = [path]
    if isinstance(value, dict):
        found += [place for key, item in value.items() for place in _paths(item, (*path, key))]
    elif isinstance(value, list):
        found += [place for k, item in enumerate(value) for place in _paths(item, (*path, k))]
    return found


@settings(deadline=None)
@given(st.lists(st.tuples(TOML_VALUES, st.booleans()), min_size=1, max_size=4))
def test_every_place_of_a_document_has_its_line(values: list[tuple[object, bool]]) -> None:
    text = "".join(
        f"[t{k}]\n'k k'.\"q\\u0041\" = {_toml(value, breaks)} # end\n[[many]]\nx = {k}\n"
        for k, (value, breaks) in enumerate(values)
    )
    document, lines = tomllib.loads(text), lines_of(text)
    rows = text.split("\n")
    for path in _paths(document):
        assert path in lines
    for k in range(len(values)):
        assert rows[lines[f"t{k}",] - 1] == f"[t{k}]"
        assert rows[lines["many", k, "x"] - 1] == f"x = {k}"
        assert lines["many", k] == lines["many", k, "x"] - 1
        assert lines[f"t{k}", "k k", "qA"] == lines[f"t{k}",] + 1


def test_quotes_at_the_end_of_a_long_text_do_not_mislead() -> None:
    text = 'a = """x\n"""""\nb = [\'\'\'\ny\'\'\'\',\n1]\nc = 1\n'
    assert tomllib.loads(text) == {"a": 'x\n""', "b": ["y'", 1], "c": 1}
    assert lines_of(text) == {(): 1, ("a",): 1, ("b",): 3, ("b", 0): 3, ("b", 1): 5, ("c",): 6}


def test_a_table_that_its_own_part_came_before_has_the_line_of_its_header() -> None:
    assert lines_of("[a.b]\nx = 1\n[a]\ny = 2\n")["a",] == 3
    assert lines_of("a.b = 1\na.c = 2\n")["a",] == 1


def test_a_place_that_is_not_there_falls_back_to_its_parent() -> None:
    lines = lines_of(PAIR)
    assert line_at(lines, ("pair", "module_mm")) == 9
    assert line_at(lines, ("nowhere", "x")) == 1
