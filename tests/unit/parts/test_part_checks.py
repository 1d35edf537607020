"""The checks of parts speak beyond their limit only, and say what a person can measure."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from gearcam.base.findings import Finding
from gearcam.kinds.gear_pair.result import GearPairResult
from gearcam.parts.blank import Blank
from helpers_pairs import profile


def found(code: str, name: str = "ellipse", limits: Any = None, **blank: Any) -> list[Finding]:
    design = replace(profile(name).design, blank=Blank(**blank), limits=limits or {})
    return [finding for finding in GearPairResult(design).findings if finding.code == code]


BOLTS = {"bolts": (3, 0), "bolt_diameter": (4.0, 0.0), "bolt_circle": (16.0, 0.0)}


@pytest.mark.parametrize(("bore", "spoken"), [(9.99, False), (10.01, True)])
def test_a_wall_is_thin_below_the_limit(bore: float, spoken: bool) -> None:
    """Holes of 4 mm on a circle of 16 mm leave 6 mm about the axis: 1 mm of wall at 10 mm."""
    heard = found("thin-wall", bore_diameter=(bore, 0.0), **BOLTS)
    assert bool(heard) == spoken
    if spoken:
        assert heard[0].value == pytest.approx(6.0 - bore / 2, abs=1e-4)
        assert "bolt hole" in heard[0].message
        assert "bore" in heard[0].message
        assert heard[0].where == "wheel 1"


def test_a_wall_as_thick_as_the_limit_is_not_thin() -> None:
    circle, bolt, bore = 15.7, 2.8, 10.9  # the wall is 1 mm, in doubles a little less
    bolts = {"bolts": (3, 0), "bolt_diameter": (bolt, 0.0), "bolt_circle": (circle, 0.0)}
    assert not found("thin-wall", bore_diameter=(bore, 0.0), **bolts)
    assert found("thin-wall", bore_diameter=(bore + 0.001, 0.0), **bolts)


def test_the_limit_of_walls_can_be_set() -> None:
    wide = {"wall": 1.2}
    assert found("thin-wall", limits=wide, bore_diameter=(9.8, 0.0), **BOLTS)
    assert not found("thin-wall", bore_diameter=(9.8, 0.0), **BOLTS)


def test_the_tool_at_hand_is_compared_with_the_sharpest_fillet() -> None:
    """The smallest fillet of a rack-cut wheel lies between the tip radius and the root's."""
    small = GearPairResult(replace(profile("ellipse").design, blank=Blank(density=(1.0, 1.0))))
    limits = small.parts_subject.tools[0]
    assert 2 * 0.38 < limits.diameter < 2.0
    for part, speaks in ((0.999, False), (1.001, True)):
        limit = {"tool_diameter": part * limits.diameter}
        heard = found("tool-too-large", limits=limit, density=(1.0, 1.0))
        assert any(finding.where == "wheel 1" for finding in heard) == speaks


@pytest.mark.parametrize(("part", "speaks"), [(0.999, False), (1.001, True)])
def test_a_kerf_wider_than_the_sharpest_fillet_is_reported(part: float, speaks: bool) -> None:
    """The largest tool that reaches every place is the widest kerf that does."""
    plain = replace(profile("ellipse").design, blank=Blank(density=(1.0, 1.0)))
    widest = GearPairResult(plain).parts_subject.tools[0].diameter
    output = replace(plain.output, kerf=part * widest)
    heard = [one for one in GearPairResult(replace(plain, output=output)).findings
             if one.code == "wide-kerf" and one.where == "wheel 1"]  # fmt: skip
    assert bool(heard) == speaks
    if speaks:
        assert heard[0].limit == pytest.approx(widest)
        assert "leaves metal there" in heard[0].message


def test_the_rim_is_what_clearance_leaves() -> None:
    """Clearance takes the root down, and the bore's wall up where bores follow it."""
    plain = found("thin-rim", limits={"rim_thickness": 50.0}, bore_diameter=(10.0, 10.0))
    module = profile("ellipse").pair.module
    for bores, off in ((False, 0.1), (True, 0.2)):
        made = found(
            "thin-rim", limits={"rim_thickness": 50.0}, bore_diameter=(10.0, 10.0),
            clearance=(0.1, 0.0), clearance_bores=bores,
        )  # fmt: skip
        assert plain[0].value is not None
        assert made[0].value is not None
        assert (plain[0].value - made[0].value) * module == pytest.approx(off, abs=1e-3)
        assert made[1].value == plain[1].value
