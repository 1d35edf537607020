"""What `help` tells of a class that designs are made of: every parameter, in inner units."""

from __future__ import annotations

import dataclasses
import inspect
import re
from dataclasses import dataclass

import pytest

import gearcam as gc
from gearcam.base.quantities import ANGLE, COUNT, LENGTH, Param, described, param

MADE = {
    f"{home.__name__}.{name}": getattr(home, name)
    for home in (gc, gc.laws, gc.motion_laws)
    for name in dir(home)
    if inspect.isclass(getattr(home, name)) and dataclasses.is_dataclass(getattr(home, name))
}


@pytest.mark.parametrize("name", MADE)
def test_every_parameter_is_told_of_once(name: str) -> None:
    doc = inspect.getdoc(MADE[name]) or ""
    for field in dataclasses.fields(MADE[name]):
        if "param" not in field.metadata:
            continue
        (told,) = re.findall(
            rf"^(?:\w+, )*{field.name}(?:, \w+)* : (.*)\n    \S", doc, re.MULTILINE
        )
        assert "deg" not in told
        if field.metadata["param"].quantity is LENGTH and field.name != "lift":
            assert "mm" in told
    assert doc.count("Parameters\n----------") <= 1
    assert doc.count("Attributes\n----------") <= 1
    assert len(MADE) > 50


@pytest.mark.parametrize("name", MADE)
def test_what_a_class_does_not_take_is_no_parameter(name: str) -> None:
    doc = inspect.getdoc(MADE[name]) or ""
    told = re.findall(
        r"^(\w+(?:, \w+)*)(?: : .*)?\n    \S", doc.partition("Attributes\n")[0], re.MULTILINE
    )
    fixed = {one.name for one in dataclasses.fields(MADE[name]) if not one.init}
    assert fixed.isdisjoint(", ".join(told).split(", "))


@dataclass(frozen=True, kw_only=True)
class Sample:
    """A sample.

    Parameters
    ----------
    size : float, mm
        Told by hand.

    Examples
    --------
    >>> 1
    """

    size: float = param(LENGTH, doc="is not said")
    turn: float | None = param(ANGLE, default=None, doc="CNC code; from it")
    count: int = param(COUNT, default=3, doc="phi1, a symbol")
    lift: float = param(
        LENGTH,
        doc="how far (translating follower)",
        when=("translating",),
        other=Param(ANGLE, doc="how far"),
    )


TOLD = """A sample.

Parameters
----------
size : float, mm
    Told by hand.
turn : float, rad, optional
    CNC code; from it.
count : int, default 3
    phi1, a symbol.
lift : float, mm or rad
    How far.

Examples
--------
>>> 1"""


def test_what_is_missing_is_added_once_before_the_examples() -> None:
    assert described(Sample).__doc__ == TOLD
    assert described(Sample).__doc__ == TOLD
    assert described(int) is int
