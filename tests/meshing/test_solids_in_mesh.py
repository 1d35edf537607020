"""Overlap of solids, step by step: against areas of outlines, sections, and a closed form."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import gearcam as gc
from gearcam.base.errors import InfeasibleError
from gearcam.gears.contact import DRIVE
from gearcam.kinds.gear_pair.design import GearPairDesign
from gearcam.meshing.assembly import Assembly
from gearcam.meshing.contact import contacts
from gearcam.meshing.solids import bodies, tilted
from gearcam.meshing.study import Setup, mount, phases
from gearcam.parts.solids import Prisms
from helpers_built import built
from helpers_pairs import run
from helpers_sampling import few

WIDTH = 10.0
ROUND: dict[str, Any] = {
    "kind": "gear-pair",
    "name": "round",
    "law": {"type": "constant"},
    "pair": {"teeth": [20, 30], "module_mm": 2, "face_width_mm": WIDTH},
}
SOLID = {"meshing.solids": True, "meshing.steps": 12}


@pytest.mark.parametrize(
    "name", few(["feeder", "ellipse", "stepped_ellipse", "ring_ellipse", "press"], 4)
)
def test_on_parallel_axes_a_volume_is_the_area_times_the_width(name: str) -> None:
    design = gc.load(f"profiles/{name}.toml").with_(SOLID)
    assert isinstance(design, GearPairDesign)
    width = design.pair.face_width / design.steps.count
    rows = gc.build(design).mesh().columns
    overlaps = rows["area_mm2"] > 0.0
    assert overlaps.any()
    volumes = rows["overlap_mm3"][overlaps] / (width * rows["area_mm2"][overlaps])
    assert volumes == pytest.approx(1.0, abs=1e-9)
    assert not rows["overlap_mm3"][~overlaps].any()
    low, high = rows["overlap_from_z_mm"][overlaps], rows["overlap_to_z_mm"][overlaps]
    assert high - low == pytest.approx(width, rel=1e-12)


def round_setup(overclosure: float = 0.02) -> tuple[Setup, np.ndarray]:
    design = gc.design(ROUND).with_({"meshing.overclosure_deg": overclosure, "meshing.steps": 24})
    assert isinstance(design, GearPairDesign)
    setup = mount(built(gc.design(ROUND)).gears, design.meshing)
    return setup, phases(design.meshing, setup.pairs[DRIVE])


def of_pairs(setup: Setup, tilt: complex, phi1: np.ndarray) -> dict[tuple[int, ...], float]:
    solid = bodies(setup.turning, Prisms, tilt, -0.5 * WIDTH, 0.5 * WIDTH)
    found = solid.overlaps(phi1, setup.spec.overclosure, 0.0)
    keys = zip(found.step.tolist(), *found.half.tolist(), strict=True)
    return dict(zip(keys, found.volume.tolist(), strict=True))


def contact_points(setup: Setup, phi1: np.ndarray) -> dict[tuple[int, ...], tuple[complex, float]]:
    """Point, and slope of the depth per tilt along x and y, by phase and half-teeth."""
    found, turning = contacts(setup.pairs[DRIVE], phi1), setup.turning
    halves = [wheel.of_pair(found.pair, DRIVE) for wheel in (turning.driver, turning.driven)]
    keys = zip(found.step.tolist(), halves[0].tolist(), halves[1].tolist(), strict=True)
    # what the driven shaft moves along the driver's force opens the contact
    values = zip(found.point.tolist(), (-found.force).tolist(), strict=True)
    return dict(zip(keys, values, strict=True))


def bearing_share(tilt: complex, point: complex) -> float:
    """The driver's faces tilt with it: at a contact they are the tilt times its place higher."""
    return 1.0 - abs((np.conj(tilt) * point).real) / WIDTH


def test_tilted_solids_overlap_as_their_sections_do() -> None:
    """A second method: areas of the plane pair at nine heights, its shafts moved by the tilt.

    What is left, mostly the place of the patch beside that of the contact, falls with the tilt.
    """
    setup, phi1 = round_setup()
    places = contact_points(setup, phi1)
    nodes, weights = np.polynomial.legendre.leggauss(9)
    missed = []
    for tilt in (4e-4 + 2e-4j, 2e-4 + 1e-4j):
        volumes = of_pairs(setup, tilt, phi1)
        expected = dict.fromkeys(volumes, 0.0)
        for node, weight in zip(nodes, weights, strict=True):
            section = replace(
                setup.turning, distance=setup.turning.distance + 0.5 * WIDTH * node * tilt
            )
            found = section.overlaps(phi1, setup.spec.overclosure)
            keys = zip(found.step.tolist(), *found.half.tolist(), strict=True)
            for key, area in zip(keys, found.area.tolist(), strict=True):
                part = bearing_share(tilt, places[key][0]) * area
                expected[key] += 0.5 * WIDTH * weight * part
        missed.append(max(abs(volumes[key] / value - 1.0) for key, value in expected.items()))
    assert missed[0] < 3e-6
    assert missed[1] < 0.6 * missed[0]


@pytest.mark.slow
def test_a_tilted_patch_has_the_volume_of_its_closed_form() -> None:
    """Depths delta + z*t along the normal: areas go with their power 3/2 over the width."""
    setup, phi1 = round_setup(0.005)
    tilt = 3e-5 - 1e-5j
    straight, volumes = of_pairs(setup, 0j, phi1), of_pairs(setup, tilt, phi1)
    levers = contacts(setup.pairs[DRIVE], phi1).lever[0]
    nodes, weights = np.polynomial.legendre.leggauss(12)
    ratios = []
    for (key, (point, force)), lever in zip(
        contact_points(setup, phi1).items(), levers, strict=True
    ):
        slope = (np.conj(force) * tilt).real
        depth = 1.0 + 0.5 * WIDTH * nodes * slope / (setup.spec.overclosure * lever)
        closed = 0.5 * float(weights @ depth**1.5) * bearing_share(tilt, point)
        assert abs(closed - 1.0) > 2e-4  # the tilt does change it
        ratios.append(volumes[key] / straight[key] / closed)
    # patches that the end of a flank clips go with another power
    assert np.median(ratios) == pytest.approx(1.0, abs=2e-5)
    assert np.mean(np.abs(np.array(ratios) - 1.0) < 1e-4) > 0.7


@pytest.mark.parametrize(
    ("tilt", "front"), few([([0.1, 0.0], False), ([-0.1, 0.0], True), ([0.0, 0.1], True)])
)
def test_on_tilted_axes_the_teeth_bear_at_one_end(tilt: list[float], front: bool) -> None:
    """Where the shafts are closer; across, where the driven flank comes to meet the driver's."""
    document = {**ROUND, "errors": {"tilt_deg": tilt}}
    study = gc.build(gc.design(document).with_(SOLID | {"pair.backlash_mm": 0.1})).mesh()
    rows = study.columns
    bears = rows["overlap_mm3"] > 0.0
    low, high = rows["overlap_from_z_mm"][bears], rows["overlap_to_z_mm"][bears]
    assert (high - low).max() < 0.7 * WIDTH
    end, other = (high, low) if front else (-low, -high)
    assert end == pytest.approx(0.5 * WIDTH, abs=0.05)
    assert other.min() > -0.2 * WIDTH
    # every phase has a pair that touches
    assert {*rows["step"][bears].astype(int)} == set(range(12))
    assert study.findings == ()
    assert study.facts["meshing.pairs_in_contact"]["min"] >= 1
    assert study.facts["meshing.bearing_length_mm"]["max"] < 0.7 * WIDTH


@pytest.mark.parametrize("name", few(["ring_ellipse", "ellipse"]))
def test_solids_bear_at_the_face_where_flanks_touch_first(name: str) -> None:
    """In a ring, axes that part towards the front bring the teeth together there."""
    design = gc.load(f"profiles/{name}.toml").with_(SOLID | {"errors.tilt_deg": [0.2, 0.0]})
    assert isinstance(design, GearPairDesign)
    result = gc.build(design.with_({"meshing.solids": False}))  # a tilt asks for solids by itself
    phi1, tilt = np.linspace(0.0, 1.0, 5), Assembly(tilt=math.radians(0.2) + 0j)
    low, high = (section.lead(DRIVE) for section in run([result.gears], 8.0, tilt, phi1).sections)
    front = bool(np.all(high > low))  # the driver pushes the driven wheel ahead
    assert front == (name == "ring_ellipse")
    rows = result.mesh().columns
    bears = rows["overlap_mm3"] > 0.0
    middle = 0.5 * (rows["overlap_from_z_mm"][bears] + rows["overlap_to_z_mm"][bears])
    assert np.all((middle > 0.0) == front)


@pytest.mark.slow
def test_a_tooth_moved_by_5_um_is_found_in_3d(tmp_path: Path) -> None:
    """Without backlash a tooth that is ahead presses on its coast side."""
    path = tmp_path / "pitch.csv"
    path.write_text("wheel,tooth,pitch_mm\n1,3,0.005\n", "utf-8")
    plain = gc.design(ROUND).with_(SOLID | {"meshing.steps": 24})
    moved = plain.with_({"errors.file": str(path)})
    sides = []
    for design in (plain, moved):
        rows = gc.build(design).mesh().columns
        coast = (rows["side"] > 0.0) & (rows["overlap_mm3"] > 0.0)
        sides.append({*rows["tooth1"][coast].astype(int)})
    assert sides[0] == set()
    assert sides[1] != set()


@pytest.mark.slow
def test_the_report_shows_the_patch_over_the_width() -> None:
    design = gc.load("profiles/ellipse.toml").with_(SOLID | {"output.studies": ["mesh"]})
    assert isinstance(design, GearPairDesign)
    study = gc.build(design).study("mesh")
    chart = study.charts["patch_over_width"]
    (line,) = chart.lines
    assert np.nanmin(line.x) == pytest.approx(-0.5 * design.pair.face_width)
    plain = gc.build(design.with_({"meshing.solids": False})).study("mesh")
    assert "patch_over_width" not in plain.charts
    assert "overlap_mm3" not in plain.columns


def test_wheels_tilted_out_of_mesh_are_refused() -> None:
    wide = {**ROUND["pair"], "face_width_mm": 100, "backlash_mm": 0.1}
    design = gc.design({**ROUND, "pair": wide, "errors": {"tilt_deg": [8, 0]}}).with_(SOLID)
    with pytest.raises(InfeasibleError, match="out of mesh") as caught:
        gc.build(design).mesh()
    assert "errors.tilt_deg" in str(caught.value)


def test_a_tilt_turns_the_axis_by_its_angle() -> None:
    for tilt in (0.3 + 0j, -0.2j, 0.1 + 0.2j):
        turn = tilted(tilt)
        assert turn @ turn.T == pytest.approx(np.eye(3), abs=1e-15)
        x, y, z = turn @ [0.0, 0.0, 1.0]
        assert math.acos(z) == pytest.approx(abs(tilt))
        assert complex(x, y) == pytest.approx(tilt / abs(tilt) * math.sin(abs(tilt)))
