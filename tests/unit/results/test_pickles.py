"""Whatever a result hands out can be pickled, and comes back as it was, in another process too."""

from __future__ import annotations

import copy
import pickle
import subprocess
import sys
from collections.abc import Callable, Iterator, Mapping
from functools import cached_property, partial
from pathlib import Path
from types import CodeType, FunctionType
from typing import Any

import numpy as np
import pytest

import gearcam as gc
from gearcam.base import pickling
from gearcam.numeric.jets import Jet
from helpers_built import built

QUICK = ("log_spiral", "eccentric_cam", "four_bar")
"""Profiles of which everything is computed soon."""


def handed_out(result: Any) -> Iterator[tuple[str, Any]]:
    """Public attributes, scene, charts and record of a result, as far as it has them."""
    kinds = (property, cached_property)
    names = {name for cls in type(result).__mro__ for name, one in vars(cls).items()
             if isinstance(one, kinds)}  # fmt: skip
    for name in sorted(names | {*vars(result)}):
        if not name.startswith("_"):
            yield name, getattr(result, name)
    for name in result.charts:
        yield f"chart {name}", result.chart(name)
    yield "scene", result.scene(4)
    yield "record", result.record()
    yield "stages", result.stages


def held(value: Any) -> list[Any]:
    """What an object holds; nothing in a number, text or array."""
    if isinstance(value, FunctionType):
        cells = [cell.cell_contents for cell in value.__closure__ or ()]
        return [value.__code__, value.__defaults__, *cells]
    if isinstance(value, partial):
        return [value.func, value.args, value.keywords]
    if isinstance(value, Mapping):
        return [*value.keys(), *value.values()]
    if isinstance(value, list | tuple):
        return [*value]
    if isinstance(value, gc.StudyResult):
        made = {"charts": value.charts, "drawn": None, "coloured": tuple(value.coloured())}
        return held({**vars(value), **made})
    if isinstance(value, Jet):
        return [*value.c]
    whole = isinstance(value, gc.Result | type | np.ndarray) or not hasattr(value, "__dict__")
    return [] if whole else held(vars(value))


def filled(values: Any) -> Any:
    """An array in which what is masked has a number: nan, or 0 of whole numbers."""
    return np.ma.filled(values, np.nan if values.dtype.kind in "fc" else 0)


def equal(one: Any, other: Any) -> bool:
    """Whether two objects of one type are the same, but for what they hold."""
    if isinstance(one, np.ndarray):
        one, other = (filled(values) for values in (one, other))
        return one.dtype.kind == "O" or np.array_equal(one, other, equal_nan=one.dtype.kind in "fc")
    simple = isinstance(one, int | float | complex | str | bytes | CodeType)
    return not simple or one == other or one != one


def differences(one: Any, other: Any, at: str, seen: set[int]) -> Iterator[str]:
    """Places at which two objects differ, in whatever they hold."""
    if id(one) in seen or one is other:
        return
    seen.add(id(one))
    both = held(one), held(other)
    if type(one) is not type(other) or len(both[0]) != len(both[1]) or not equal(one, other):
        yield f"{at}: {type(one).__name__}"
        return
    for k, pair in enumerate(zip(*both, strict=True)):
        yield from differences(*pair, f"{at}.{k}", seen)


def unlike(result: Any) -> list[str]:
    found = []
    for name, value in handed_out(result):
        again = pickle.loads(pickle.dumps(value))
        found += differences(value, again, name, set())
    return found


@pytest.mark.parametrize("name", QUICK)
def test_whatever_a_result_hands_out(name: str) -> None:
    assert unlike(built(f"profiles/{name}.toml")) == []


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(path.stem for path in Path("profiles").glob("*.toml")))
def test_of_all_profiles(name: str) -> None:
    assert unlike(built(f"profiles/{name}.toml")) == []


NUMBERS: dict[str, tuple[str, Callable[[Any], Any]]] = {
    "ellipse": ("gear1", lambda gear: gear.outline.sum()),
    "log_spiral": ("law", lambda law: law.phi2(1.0)),
    "eccentric_cam": ("cam", lambda cam: cam.motions[0].program.derivatives([1.0], 2)[2]),
    "cylinder_cam": ("cam", lambda cam: cam.program.derivatives(np.array([1.0]), 3)[3]),
    "globoidal_indexer": ("cam", lambda cam: cam.program.derivatives(np.array([1.0]), 3)[3]),
    "four_bar": ("linkage", lambda made: made.track("P.x", np.array([1.0]), 3).c[3]),
}


@pytest.mark.parametrize("name", NUMBERS)
def test_functions_compute_the_same(name: str) -> None:
    attribute, number = NUMBERS[name]
    value = getattr(built(f"profiles/{name}.toml"), attribute)
    for again in (pickle.loads(pickle.dumps(value)), copy.copy(value), copy.deepcopy(value)):
        assert type(again) is type(value)
        assert again is not value
        assert np.all(number(again) == number(value))


def test_another_process_reads_it_without_computing_anew() -> None:
    wheel = built("profiles/ellipse.toml").gear1
    code = (
        "import pickle, sys\n"
        "wheel = pickle.load(sys.stdin.buffer)\n"
        "print(repr(float(wheel.outline.sum())), repr(float(wheel.toothing.track.length)))\n"
        "print('gearcam.kinds.gear_pair.result' in sys.modules)\n"
    )
    run = [sys.executable, "-c", code]
    told = subprocess.run(run, input=pickle.dumps(wheel), capture_output=True, check=True).stdout
    outline, length, computed = told.decode().split()
    assert float(outline) == wheel.outline.sum()
    assert float(length) == wheel.toothing.track.length
    assert computed == "False"


def test_of_another_version_is_refused_with_what_can_be_read(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    data = pickle.dumps(built("profiles/ellipse.toml").law)
    monkeypatch.setattr(pickling, "_VERSION", "gearcam 99.0.0 on Python 3.99")
    with pytest.raises(TypeError, match=r"pickled by gearcam .* pickle the design or the result"):
        pickle.loads(data)


def _counting(step: int) -> Any:
    """A function that calls itself, with a default and a keyword."""

    def count(number: int, down: int = step, *, end: int = 0) -> list[int]:
        return [number] if number <= end else [number, *count(number - down, end=end)]

    return count


def test_a_function_that_calls_itself(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(pickling, "_OURS", __name__.partition(".")[0])
    count = pickle.loads(pickle.dumps(pickling.pickled((_counting(2), _counting(3)))))
    assert [one(7, end=1) for one in count] == [[7, 5, 3, 1], [7, 4, 1]]
