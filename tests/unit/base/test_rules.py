"""Rules give a message and a schema that refuse the same tables; schemas are judged by jsonschema.

A table is refused by the reader and by its schema, or by neither, but for comparisons of numbers,
which a schema cannot say.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import jsonschema
import pytest

from gearcam.base.quantities import COUNT, LENGTH, TEXT, param
from gearcam.base.rules import (
    above,
    at_most,
    below,
    distinct,
    exactly_one,
    excluded,
    excludes,
    needed_with,
    needs,
    only_with,
    together,
)
from gearcam.designs.faults import Fault
from gearcam.designs.schema import table_schema
from gearcam.designs.table import table_of
from gearcam.designs.validate import document_faults, faults_of, rule_faults


def _length(**rest: Any) -> Any:
    return param(LENGTH, default=None, ge=0, le=100, **rest)


@dataclass(frozen=True, kw_only=True)
class Sample:
    """Parameters with a rule of every sort."""

    a: float | None = _length()
    b: float | None = _length()
    hole: float | None = _length(zero_is_none=True)
    pin: float | None = _length(zero_is_none=True)
    head: float | None = _length()
    tail: float | None = _length()
    start: float = param(LENGTH, default=0.0, ge=0, le=100)
    end: float | None = _length()
    width: float = param(LENGTH, default=9.0, ge=0, le=100)
    depth: float | None = _length()
    part: float | None = _length()
    type: str = param(TEXT, default="round", choices=("round", "flat"))
    radius: float | None = _length()
    face: float | None = _length()
    words: tuple[str, ...] = param(TEXT, default=(), choices=("x", "y", "z"))

    rules = (
        exactly_one("a", "b", note="the other is computed"),
        needs("pin", "hole"),
        *together("head", "tail"),
        excludes("part", "head", "tail"),
        only_with(["radius"], "type", "round"),
        needed_with(["face"], "type", "flat"),
        excluded("type", "flat", depth=2.0, why="is not made", allowed="round"),
        above("end", "start", why="would end at {}"),
        below("depth", "width"),
        at_most("part", "width", part=1 / 3),
        distinct("words", "word"),
    )


ONE = {"a_mm": 1}


@pytest.mark.parametrize(
    ("raw", "faults"),
    [
        (ONE, []),
        ({}, [("", "neither a_mm nor b_mm is given", "exactly one of a_mm and b_mm; the other")]),
        ({"a_mm": 0}, []),
        ({"b_mm": 2, "a_mm": 1}, [("b_mm", "2: is given beside a_mm = 1", "exactly one")]),
        (ONE | {"pin_mm": 3}, [("hole_mm", "is missing beside pin_mm", "pin_mm with hole_mm")]),
        (ONE | {"pin_mm": 3, "hole_mm": 0}, [("hole_mm", "0: is missing beside pin_mm", "pin_mm")]),
        (ONE | {"pin_mm": 0}, []),
        (ONE | {"pin_mm": 3, "hole_mm": 4}, []),
        (ONE | {"head_mm": 0}, [("tail_mm", "is missing beside head_mm", "head_mm with tail_mm")]),
        (ONE | {"tail_mm": 5}, [("head_mm", "is missing beside tail_mm", "tail_mm with head_mm")]),
        (
            ONE | {"part_mm": 1, "head_mm": 2, "tail_mm": 2},
            [("part_mm", "1: is given beside head_mm = 2", "part_mm, head_mm or tail_mm")],
        ),
        (ONE | {"radius_mm": 1}, []),
        (ONE | {"radius_mm": 1, "type": "round"}, []),
        (
            ONE | {"radius_mm": 1, "face_mm": 1, "type": "flat"},
            [("radius_mm", '1: does not apply with type = "flat"', 'with type = "round"')],
        ),
        (
            ONE | {"type": "flat"},
            [("face_mm", 'is missing with type = "flat"', 'needed with type = "flat"')],
        ),
        (
            ONE | {"type": "flat", "face_mm": 0, "depth_mm": 2},
            [("type", '"flat": is not made', "round")],
        ),
        (ONE | {"type": "flat", "face_mm": 0, "depth_mm": 3}, []),
        (
            ONE | {"words": ["x", "y", "x"]},
            [("words[2]", '"x": is listed twice', "each word once")],
        ),
        (ONE | {"words": ["x", "y", "z"]}, []),
    ],
)
def test_message_and_schema_agree(raw: dict[str, Any], faults: list[tuple[str, str, str]]) -> None:
    known = table_of("sample", Sample)
    found = list(rule_faults(known, raw, [], ("sample",)))
    _compare(found, faults)
    verdict = jsonschema.Draft202012Validator(table_schema(known)).is_valid(raw)
    assert verdict is not bool(faults)


@pytest.mark.parametrize(
    ("raw", "faults"),
    [
        ({"end_mm": 0}, [("end_mm", "0: would end at start_mm = 0", "above start_mm = 0 mm")]),
        ({"end_mm": 1e-9}, []),
        ({"start_mm": 3, "end_mm": 4}, []),
        (
            {"start_mm": 3, "end_mm": 3},
            [("end_mm", "3: would end at start_mm = 3", "above start_mm = 3 mm")],
        ),
        (
            {"depth_mm": 9},
            [("depth_mm", "9: is not below width_mm = 9", "below width_mm = 9 mm")],
        ),
        ({"depth_mm": 9, "width_mm": 9.5}, []),
        ({"part_mm": 3}, []),
        (
            {"part_mm": 3.1},
            [("part_mm", "3.1: is above width_mm = 9", "at most width_mm/3 = 3 mm")],
        ),
    ],
)
def test_numbers_are_compared_as_they_are_written_or_by_default(
    raw: dict[str, Any], faults: list[tuple[str, str, str]]
) -> None:
    _compare(list(rule_faults(table_of("sample", Sample), ONE | raw, [], ("sample",))), faults)


@pytest.mark.parametrize(
    "raw",
    [
        ONE | {"pin_mm": "x"},
        ONE | {"end_mm": "x"},
        ONE | {"type": 3, "radius_mm": 1},
        {"a": 1},
        ONE | {"pin_mm": 3, "hole": 4},
    ],
)
def test_what_is_wrong_or_misspelt_breaks_no_rule(raw: dict[str, Any]) -> None:
    known = table_of("sample", Sample)
    faults = list(faults_of(known, raw, home=lambda *_: ""))
    assert faults
    assert not list(rule_faults(known, raw, faults, ("sample",)))


@dataclass(frozen=True, kw_only=True)
class Both:
    """Parameters with a value for each of two wheels."""

    holes: tuple[int, int] = param(COUNT, default=(0, 0), ge=0, le=9, both=True)
    size: tuple[float, float] = param(
        LENGTH, default=(0, 0), ge=0, le=9, both=True, zero_is_none=True
    )

    rules = (needs("holes", "size"),)


@pytest.mark.parametrize(
    ("raw", "paths", "verdict"),
    [
        ({"holes": 0}, [], True),
        ({"holes": [0, 0]}, [], True),
        ({"holes": 2}, [("size_mm",)], False),
        ({"holes": [2, 0], "size_mm": [0, 3]}, [("size_mm", 0)], True),
        ({"holes": [2, 3], "size_mm": 3}, [], True),
        ({"holes": [0, 3], "size_mm": [0, 3]}, [], True),
    ],
)
def test_each_wheel_is_judged_by_itself(
    raw: dict[str, Any], paths: list[tuple[Any, ...]], verdict: bool
) -> None:
    """A schema refuses only what misses a value for both wheels."""
    known = table_of("sample", Both)
    assert [one.path[1:] for one in rule_faults(known, raw, [], ("sample",))] == paths
    assert jsonschema.Draft202012Validator(table_schema(known)).is_valid(raw) is verdict


@dataclass(frozen=True, kw_only=True)
class Served:
    """Something that two wheels may have, and a size that serves it."""

    holes: tuple[int, int] = param(COUNT, default=(0, 0), ge=0, le=9, both=True, zero_is_none=True)
    size: tuple[float, float] = param(
        LENGTH, default=(0, 0), ge=0, le=9, both=True, zero_is_none=True
    )

    rules = (needs("size", "holes", serves=True),)


@pytest.mark.parametrize(
    ("raw", "paths", "verdict"),
    [
        ({"size_mm": 3}, [("holes",)], False),
        ({"size_mm": 3, "holes": 0}, [("holes",)], False),
        ({"size_mm": 3, "holes": 2}, [], True),
        ({"size_mm": 3, "holes": [2, 0]}, [], True),
        ({"size_mm": [3, 3], "holes": [2, 0]}, [], True),
        ({"size_mm": [3, 4], "holes": [2, 0]}, [("holes", 1)], True),
        ({"size_mm": [3, 0], "holes": [2, 0]}, [], True),
        ({"size_mm": [0, 3], "holes": [2, 0]}, [("holes", 1)], True),
        ({"size_mm": 0}, [], True),
    ],
)
def test_one_value_for_both_wheels_serves_the_one_that_has_something(
    raw: dict[str, Any], paths: list[tuple[Any, ...]], verdict: bool
) -> None:
    known = table_of("sample", Served)
    assert [one.path[1:] for one in rule_faults(known, raw, [], ("sample",))] == paths
    assert jsonschema.Draft202012Validator(table_schema(known)).is_valid(raw) is verdict


@dataclass(frozen=True, kw_only=True)
class Box:
    """A table beside the sample."""

    type: str = param(TEXT, default="open", choices=("open", "closed"))


def test_rules_between_tables_name_both() -> None:
    tables = {"sample": table_of("sample", Sample), "box": table_of("box", Box)}
    rules = [only_with(["sample.radius"], "box.type", "closed")]
    document: dict[str, Any] = {"sample": {"radius_mm": 3}, "box": {"type": "open"}}
    found = list(document_faults(tables, rules, document, []))
    expected = ("radius_mm", '3: does not apply with box.type = "open"', 'with box.type = "closed"')
    _compare(found, [expected])
    assert list(document_faults(tables, rules, {"sample": {"radius_mm": 3}}, []))
    assert not list(document_faults(tables, rules, document | {"box": {"type": "closed"}}, []))
    assert not list(document_faults(tables, rules, {"box": {}}, []))
    wrong = [Fault(("box",), "3 is not a table", 3)]
    assert not list(document_faults(tables, rules, document | {"box": 3}, wrong))


def _compare(found: list[Fault], faults: list[tuple[str, str, str]]) -> None:
    keys = ["".join(f"[{k}]" if isinstance(k, int) else k for k in one.path[1:]) for one in found]
    assert [(key, one.message) for key, one in zip(keys, found, strict=True)] == [
        (key, message) for key, message, _ in faults
    ]
    for one, (_, _, allowed) in zip(found, faults, strict=True):
        assert one.allowed.startswith(allowed)
