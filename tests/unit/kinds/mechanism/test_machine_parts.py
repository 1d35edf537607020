"""The parts of mechanisms: all are registered, and one more needs nothing but its own class."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import pytest

import gearcam as gc
from gearcam.kinds.mechanism.drawn import bodies
from gearcam.kinds.mechanism.keys import Sort, center_of, named
from gearcam.kinds.mechanism.linkage import make_linkage
from gearcam.kinds.mechanism.names import OutputNames, acted_on, tables_of
from gearcam.kinds.mechanism.parts import ACTIONS, PARTS
from gearcam.kinds.mechanism.parts.action import MachineAction
from gearcam.kinds.mechanism.parts.part import MachinePart, Setting
from gearcam.linkages.elements import Element, MemberPoint, WoundWay
from gearcam.results.kind import KINDS


def test_every_part_is_in_its_register() -> None:
    tables = KINDS["mechanism"].tables
    for register, base in ((PARTS, MachinePart), (ACTIONS, MachineAction)):
        own = {title: one for title, one in tables.items() if issubclass(one, base)}
        assert dict(register) == {title: one.__name__ for title, one in own.items()}
        for one in own.values():
            assert getattr(gc, one.__name__) is one


@dataclass(frozen=True, kw_only=True)
class Pinion(MachinePart):
    """A shaft that a slide turns."""

    name: str = named(gives=Sort.SHAFT, doc="its shaft")
    on: str = named(needs=Sort.WAY, doc="the slide")
    radius: float

    def elements(self, setting: Setting, where: str) -> Iterator[Element]:  # noqa: ARG002
        yield WoundWay(self.name, self.on, 1.0 / self.radius)
        yield MemberPoint(center_of(self.name), 5.0 + 7.0j)


MACHINE = """
kind = "mechanism"
name = "rack"
drive = [{ name = "motor", even = true }, { name = "ram", slide = "20*sin(q)" }]
crank = [{ name = "arm", on = "motor", joint = "B", length_mm = 30, angle_deg = 90 }]
"""


def test_a_crank_turns_on_the_shaft_of_a_part_that_nobody_knows(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    result = gc.build(gc.loads(MACHINE))
    crank = gc.CrankSpec(name="arm", on="pin", joint="B", length=30.0, angle=0.5 * np.pi)
    tables = tables_of(result.design) | {
        "crank": (crank,), "pinion": (Pinion(name="pin", on="ram", radius=16.0),)
    }  # fmt: skip
    linkage = make_linkage(tables, result.drives)
    q = np.linspace(0.0, 6.0, 7)
    place = 5.0 + 7.0j + 30.0j * np.exp(1j * 20.0 * np.sin(q) / 16.0)
    assert np.asarray(linkage.track("B", q, 0).c[0]) == pytest.approx(place, abs=1e-12)
    assert acted_on(tables).sorts["pin"] == "shaft"
    assert OutputNames(tables).usual == ["arm.angle"]
    result.__dict__["linkage"] = linkage
    monkeypatch.setattr("gearcam.kinds.mechanism.drawn.tables_of", lambda _: tables)
    frame, arm = bodies(result, q)[:2]
    assert arm.pose.shift == pytest.approx(np.full(7, 5.0 + 7.0j))
    assert frame.name == "frame"  # with the pivot of the crank
