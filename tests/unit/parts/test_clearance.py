"""Clearance comes off the outline, then edges are rounded; openings follow it only if asked."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import pytest
import shapely

import gearcam as gc
from gearcam.base.errors import InfeasibleError
from gearcam.kinds.gear_pair.result import GearPairResult
from gearcam.numeric.arrays import as_pairs
from gearcam.numeric.contour import Contour
from gearcam.parts.blank import WheelBlank
from gearcam.parts.body import Opening, Part
from gearcam.parts.make import finished, make_part
from gearcam.parts.openings import Workpiece
from gearcam.parts.shapes import Circle
from helpers_contour import disc_contour, gear_contour, square_contour
from helpers_pairs import profile
from helpers_sampling import chosen, few

SLOTTED = Workpiece(name="wheel 1", wheel=1, rim=5.4, travel=1.5)


def blank(**sizes: Any) -> WheelBlank:
    return WheelBlank(**{"timing_marks": False, **sizes})


def made(contour: Contour, sizes: WheelBlank, place: Workpiece = SLOTTED) -> Part:
    return make_part("g", [finished(contour, sizes, place)], 10.0, sizes, place)


def region(opening: Opening, sagitta: float) -> shapely.Polygon:
    assert not isinstance(opening.shape, Contour)
    return shapely.Polygon(as_pairs(opening.shape.polyline(sagitta)))


KEYED = blank(bore_diameter=20.0, keyway_width=6.0, keyway_depth=2.8)
FLAT = blank(bore_diameter=20.0, bore_flat=17.5)

SHIFTED = {
    "bore": blank(bore_diameter=20.0),
    "keyway": replace(KEYED, keyway_angle=0.7),
    "flat": replace(FLAT, keyway_angle=-1.0),
    "bolts": blank(bolts=2, bolt_circle=50.0, bolt_diameter=8.0),
    "slot": blank(stop_pin=5.0),
}


@pytest.mark.parametrize("by", few([0.2, 1.0]))
@pytest.mark.parametrize("name", chosen(list(SHIFTED), *(one for one in SHIFTED if one != "slot")))
def test_clearance_widens_what_something_goes_through(name: str, by: float) -> None:
    """Against shapely's buffer with sharp corners, as they stay in keyways and at flats."""
    contour = disc_contour(50.0)
    plain = made(contour, SHIFTED[name])
    follows = replace(SHIFTED[name], clearance=by, clearance_bores=True)
    part, rigid = (
        made(contour, blank) for blank in (follows, replace(follows, clearance_bores=False))
    )
    assert part.contour.moments.area == pytest.approx(math.pi * (50 - by) ** 2, rel=1e-9)
    assert rigid.contour.moments.area == pytest.approx(math.pi * (50 - by) ** 2, rel=1e-9)
    for before, same, after in zip(plain.openings, rigid.openings, part.openings, strict=True):
        # the slot's place is the roomiest of what is left
        shift = 0.0 if name != "slot" else 2 * by
        assert region(same, 1e-5).symmetric_difference(region(before, 1e-5)).area <= shift * 200
        wanted = region(same, 1e-5).buffer(by, join_style="mitre", mitre_limit=10.0)
        got = region(after, 1e-5)
        assert after.name == before.name
        if name != "slot":
            # inner corners of the opening are outer ones of the metal: sharp too, by definition
            corner = 0.25 * by**2 if name in ("keyway", "flat") else 0.0
            assert got.symmetric_difference(wanted).area < corner + 1e-4 * got.length
        else:
            assert got.area == pytest.approx(wanted.area, rel=0.01)


def test_lightening_holes_keep_their_rim_and_web_from_the_part_as_made() -> None:
    """A ring of 10 to 50 mm: the largest circle between its edges, rim and web kept."""
    sizes = blank(bore_diameter=20.0, lightening_holes=1, rim=3.0, web=2.0)
    for bores, inner in ((False, 10.0), (True, 10.5)):
        part = made(disc_contour(50.0), replace(sizes, clearance=0.5, clearance_bores=bores))
        (hole,) = [one for one in part.openings if one.kind == "HOLE"]
        assert isinstance(hole.shape, Circle)
        assert hole.shape.diameter == pytest.approx(49.5 - 3.0 - inner - 2.0, abs=0.02)


def test_rounded_edges_have_the_radius_asked_for_on_the_part_as_made() -> None:
    """A square of 20 mm with 1 mm off: corners of radius 2, not of 2 less the clearance."""
    part = made(square_contour(20.0), blank(clearance=1.0, tip_rounding=2.0))
    assert part.contour.moments.area == pytest.approx(18.0**2 - (4 - math.pi) * 2.0**2, rel=1e-9)


@pytest.mark.slow
def test_too_much_clearance_is_refused_with_what_leaves_an_outline() -> None:
    contour = gear_contour(12, 5.0)
    with pytest.raises(InfeasibleError, match="this clearance leaves no simple outline") as one:
        made(contour, blank(clearance=4.0))
    assert one.value.where == "wheel 1, blank.clearance_mm"
    named = float(one.value.nearest.split()[3])
    assert 0.5 < named < 4.0
    assert made(contour, blank(clearance=named)).contour.area > 0.0
    with pytest.raises(InfeasibleError, match="this radius leaves no simple outline") as two:
        made(contour, blank(tip_rounding=20.0))
    named = float(two.value.nearest.split()[3])
    assert made(contour, blank(tip_rounding=named)).contour.area > 0.0


def test_timing_marks_keep_their_gap_from_the_root_as_made() -> None:
    """Root and mark go inwards together; a bore that follows pushes nothing while there is room."""
    plain = profile("ellipse").design
    clear = replace(plain, blank=replace(plain.blank, clearance=(0.1, 0.1)))
    marks = [GearPairResult(design).parts[0].marks[0] for design in (plain, clear)]
    before, after = (mark.center.real for mark in marks)
    assert before - after == pytest.approx(0.1, abs=1e-9)


def test_backlash_says_how_much_of_it_clearance_makes() -> None:
    """A wheel's clearance moves both flanks, by clearance/cos(alpha) along the pitch line."""
    changes = {"pair.backlash_mm": 0.1, "blank.clearance_mm": [0.07, 0.03]}
    plain = gc.build(profile("ellipse").design.with_({"pair.backlash_mm": 0.1}))
    made = gc.build(profile("ellipse").design.with_(changes))
    more = 2 * (0.07 + 0.03) / math.cos(math.radians(20))
    assert made.facts["mesh.backlash_mm"] == pytest.approx(0.1 + more, abs=1e-12)
    told = made.facts.quantity("mesh.backlash_mm")
    assert told.text == f"{0.1 + more:.4f} mm"
    assert told.place == f"backlash_mm 0.1 + {more:.5g} from clearance_mm"
    assert plain.facts.quantity("mesh.backlash_mm").place == ""
