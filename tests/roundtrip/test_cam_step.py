"""STEP files of cams in space: closed, valid, of the right volume, and walls where a search says.

They are read by the kernel's own reader, and as text by a few lines that know nothing of the
kernel: the B-splines in the text are evaluated by scipy and held against a search for the roller's
positions that knows no envelope.
"""

from __future__ import annotations

import io
import math
import re
from collections import Counter
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest
from scipy.interpolate import BSpline

import gearcam as gc
from gearcam.base.tolerances import DEFAULT
from gearcam.export.step import step_bytes
from gearcam.export.step_bands import banded_solid
from gearcam.export.step_shapes import occt
from gearcam.laws.motion import MOTION_LAWS
from gearcam.laws.phases_of_lift import DwellPhase, ReturnPhase, RisePhase
from gearcam.laws.program import make_program
from gearcam.numeric.pose import UNMOVED
from gearcam.parts.bands import BandedBody, SplineBand
from gearcam.parts.cam_bands import TOLERANCE, cam_bands
from gearcam.parts.solids import SolidError
from gearcam.spatial.cam import SpatialCam
from gearcam.spatial.guides import SwingArm
from gearcam.spatial.surface import Cylinder, chord_error, ramp, surface
from helpers_sampling import chosen, few
from helpers_spatial import RISE, SPANS, reference, swinging
from helpers_step import entities, read_step, silent
from witness.roller_in_space import Mechanism, cycloidal

GROOVE = 44298.298
"""Volume of the groove of the reference cam, mm^3: two quadratures agree to 1e-4."""

PLAIN = Cylinder(length=60.0)
BORED = Cylinder(length=60.0, bore=10.0)


def arm() -> SpatialCam:
    """The follower that swings, in the middle of the cam."""
    cam = swinging()
    guide: Any = cam.guide
    placed = SwingArm(
        length=guide.length,
        distance=guide.distance,
        start=guide.start,
        height=30.0 + guide.height,
    )
    return reference(program=cam.program, guide=placed)


@cache
def named(name: str) -> BandedBody:
    """The bands of one of the cases."""
    return body(*CASES[name][:2])


@cache
def file_of(name: str) -> bytes:
    """Its file, as it is written once."""
    return written(named(name))


def body(cam: SpatialCam, blank: Cylinder) -> BandedBody:
    """Return the bands with the volume of meshes, extrapolated, and its error."""
    coarse, fine = (surface(cam, blank, *size).volume for size in ((360, 13), (720, 25)))
    error = (fine - coarse) / 3.0
    return cam_bands(cam, blank, "cam", (fine + error, abs(error)))


def written(made: BandedBody) -> bytes:
    return step_bytes([(made, UNMOVED)], made.name, made.error)


def short() -> SpatialCam:
    """A rise shorter than a quarter turn, whose ramp is a point at both ends."""
    law = MOTION_LAWS["cycloidal"].parameters()
    phases = (
        RisePhase(angle=math.radians(85.0), law=law, lift=20.0),
        DwellPhase(angle=math.radians(95.0)),
        ReturnPhase(angle=math.radians(180.0), law=law),
    )
    return reference(height=15.0, program=make_program(phases, DEFAULT))


CASES = {
    "groove": (reference(height=15.0, clockwise=True), PLAIN, 18),
    "ccw": (reference(height=15.0), PLAIN, 18),
    "bore": (reference(height=15.0), BORED, 20),
    "upper": (reference(height=15.0, sides=(1,)), BORED, 14),
    "lower": (reference(height=15.0, sides=(-1,)), PLAIN, 12),
    "cone": (reference(height=15.0, half_angle=0.1, clearance=0.1), BORED, 20),
    "clockwise": (reference(height=15.0, half_angle=0.1, clockwise=True), BORED, 20),
    "arm": (arm(), PLAIN, 30),
    "short": (short(), PLAIN, 18),
    "rib": (reference(height=30.0, apart=24.0), Cylinder(length=100.0, bore=10.0), 20),
}
"""Cam, blank and number of cylinders: three bands of the six or ten sectors, the bore's two."""


def valid(data: bytes) -> bool:
    """Whether the kernel finds valid what its reader makes of a file."""
    with silent():
        reader = occt.STEPControl_Reader()
        reader.ReadStream("step", io.BytesIO(data))
        reader.TransferRoots()
    return bool(occt.BRepCheck_Analyzer(reader.OneShape()).IsValid())


@pytest.mark.slow
@pytest.mark.parametrize("name", chosen(list(CASES), "rib"))
def test_solids_are_valid_and_have_their_volume(name: str) -> None:
    made, cylinders = named(name), CASES[name][2]
    data = file_of(name)  # refuses a solid that is invalid or has another volume
    (solid,) = read_step(data)
    assert solid.name == "cam"
    assert solid.faces["plane"] == 2
    assert solid.faces["cylinder"] == cylinders
    nets = [net for band in made.bands if isinstance(band, SplineBand) for net in band.sectors]
    assert solid.faces["bspline"] == sum(net is not None for net in nets)
    # the bound of the mesh is 2 mm^3; on an arm ramps have corners, which slow the mesh down
    assert solid.volume == pytest.approx(made.volume, abs=0.3 if name == "arm" else 0.05)
    assert valid(data)


@pytest.mark.slow
def test_the_same_cam_gives_the_same_bytes() -> None:
    assert written(named("rib")) == file_of("rib")


@pytest.mark.slow
@pytest.mark.parametrize("name", list(CASES))
def test_the_same_cam_made_anew_gives_the_same_bytes(name: str) -> None:
    assert written(body(*CASES[name][:2])) == file_of(name)


@pytest.mark.slow
def test_the_groove_has_its_volume() -> None:
    """The mesh of 720 cam angles is 2.5 mm^3 off."""
    (solid,) = read_step(file_of("groove"))
    whole = math.pi * 40.0**2 * 60.0
    assert whole - solid.volume == pytest.approx(GROOVE, abs=1e-3)
    assert solid.bounds == pytest.approx(
        np.array([[-40.0, -40.0, 0.0], [40.0, 40.0, 60.0]]), abs=1e-4
    )


@pytest.mark.parametrize("name", few(["rib", "arm", "cone"], 3))
def test_the_stated_error_is_kept(name: str) -> None:
    """At places of a grid that has none of its own with the B-splines."""
    cam, made = CASES[name][0], named(name)
    assert made.error < TOLERANCE < 0.01 * chord_error(cam, 720, 13)
    splines = [band for band in made.bands if isinstance(band, SplineBand)]
    upper, below = splines[:2] if not cam.apart else splines[2:]
    for band, points in (
        (upper, lambda theta: cam.walls[0].grid(theta, 12).points[:, ::-1]),
        (below, lambda theta: ramp(cam.walls[0], theta, 12)[:, ::-1]),
    ):
        for net in band.sectors:
            if net is None:
                continue
            low, high = net.along[0], net.along[-1]
            theta = low + (high - low) * np.linspace(0.0, 1.0, 211)
            true = points(theta)  # type: ignore[no-untyped-call]
            found = net.at(theta, np.linspace(0.0, 1.0, 12))
            assert np.linalg.norm(found - true, axis=2).max() < 1.2 * made.error


def numbers(text: str) -> list[float]:
    return [float(one) for one in text.split(",")]


def nets_in(data: bytes) -> list[tuple[np.ndarray, np.ndarray, np.ndarray]]:
    """Control points and both rows of knots of each B-spline surface in a file."""
    text = re.sub(r"\n *", "", data.decode("ascii"))
    points = dict(re.findall(r"#(\d+) = CARTESIAN_POINT\('',\((.*?)\)\);", text))
    found = []
    for inside in re.findall(r"= B_SPLINE_SURFACE_WITH_KNOTS\((.*?)\);", text):
        rows = re.match(r"'',3,3,\((\(.*?\))\),", inside)
        assert rows
        poles = [
            [numbers(points[key]) for key in re.findall(r"#(\d+)", row)]
            for row in re.findall(r"\((.*?)\)", rows[1])
        ]
        often, times, first, second = re.findall(r"\(([^()]*)\)", inside[rows.end() :])
        knots = [
            np.repeat(numbers(at), [int(one) for one in counts.split(",")])
            for counts, at in ((often, first), (times, second))
        ]
        found.append((np.array(poles), *knots))
    return found


def places_on(net: tuple[np.ndarray, np.ndarray, np.ndarray], count: int) -> np.ndarray:
    """Points of a B-spline surface, (count^2, 3), away from its edges."""
    poles, first, second = net
    share = (np.arange(count) + 0.37) / count
    u = first[0] + (first[-1] - first[0]) * share
    v = second[0] + (second[-1] - second[0]) * share
    rows = BSpline(first, poles, 3)(u)
    return BSpline(second, rows.swapaxes(0, 1), 3)(v).reshape(-1, 3)


@pytest.mark.parametrize("clockwise", chosen([False, True], True))
def test_walls_in_the_text_are_where_the_roller_passes(clockwise: bool) -> None:
    """The end of the roller makes the ramps, the side the walls: one search finds both."""

    def center(theta: Any) -> tuple[Any, Any]:
        return np.zeros_like(theta), 15.0 + cycloidal(theta, 30.0, SPANS)

    roller = Mechanism(center=center, radius=8.0, at=40.0, inner=28.0)
    nets = nets_in(file_of("groove" if clockwise else "ccw"))
    assert len(nets) == 20

    def miss(places: np.ndarray) -> float:
        """Largest distance along the axis from the nearer wall that the search finds."""
        radii = np.hypot(places[:, 0], places[:, 1]).tolist()
        azimuths = np.arctan2(-places[:, 1] if clockwise else places[:, 1], places[:, 0]).tolist()
        return max(
            min(abs(z - roller.wall(radius, azimuth, side)) for side in (1, -1))
            for radius, azimuth, z in zip(radii, azimuths, places[:, 2].tolist(), strict=True)
        )

    places = [places_on(net, 2) for net in nets]
    assert max(miss(one) for one in places) < 2.0 * TOLERANCE
    # the control: a wall that is off is seen
    assert miss(places[0] + np.array([0.0, 0.0, 1e-4])) > 9e-5


def test_each_edge_in_the_text_is_passed_once_each_way() -> None:
    data = file_of("rib")
    text, found = re.sub(r"\n *", "", data.decode("ascii")), entities(data)
    loops = dict(re.findall(r"(#\d+) = EDGE_LOOP\('',\((.*?)\)\);", text))
    edges = dict(re.findall(r"(#\d+) = ORIENTED_EDGE\('',\*,\*,(#\d+,\.[TF]\.)\);", text))
    bounds = re.findall(r"= FACE_(?:OUTER_)?BOUND\('',(#\d+),\.([TF])\.\);", text)
    uses = Counter()
    for loop, flag in bounds:
        for each in loops[loop].split(","):
            edge, sense = edges[each].split(",")
            uses[edge, sense[1] == flag] += 1
    assert len(uses) == 2 * len(found["EDGE_CURVE"])
    assert set(uses.values()) == {1}
    radii = {float(each.rpartition(",")[2]) for each in found["CYLINDRICAL_SURFACE"]}
    assert radii == {40.0, 28.0, 10.0}
    assert len(found["CLOSED_SHELL"]) == len(found["MANIFOLD_SOLID_BREP"]) == 1


def test_ramps_begin_and_end_with_rises() -> None:
    """In dwells there are none; on an arm they also change their side in between."""
    bands = named("groove").bands
    ramps = [band for band in bands if isinstance(band, SplineBand)][1]
    assert [net is None for net in ramps.sectors] == 2 * [False, False, True]
    first = ramps.sectors[0]
    assert first is not None
    assert first.along[-1] == pytest.approx(0.5 * RISE)
    assert np.ptp(first.points[0], axis=0).max() < 1e-12
    bands = named("arm").bands
    for ramps, sectors in zip(
        [band for band in bands if isinstance(band, SplineBand)][1:3],
        ([1, 3], [6, 8]),
        strict=True,
    ):
        ends = [net.points[0] for net in ramps.sectors if net is not None]
        assert [k for k, row in enumerate(ends) if np.ptp(row, axis=0).max() < 1e-9] == sectors


@pytest.mark.slow
def test_another_volume_is_refused() -> None:
    made = named("rib")
    with pytest.raises(SolidError, match=r"the solid's volume is .* mm3 off"):
        banded_solid(replace(made, volume=made.volume + 3.0))


def test_a_wall_that_does_not_join_is_refused() -> None:
    """Its other faces end where the wall was."""
    made = named("groove")
    wall = made.bands[2]
    assert isinstance(wall, SplineBand)
    net = wall.sectors[0]
    assert net is not None
    off = replace(net, points=net.points + np.array([0.0, 0.0, 0.01]))
    bands = list(made.bands)
    bands[2] = SplineBand(sectors=(off, *wall.sectors[1:]))
    with pytest.raises(SolidError, match="invalid"):
        banded_solid(replace(made, bands=tuple(bands)))


@pytest.mark.slow
def test_a_design_states_the_error() -> None:
    design = gc.load("profiles/cylinder_cam.toml").with_({"output.files": ["step"]})
    result = gc.build(design)
    (solid,) = read_step(result.files("step")["cam.step"])
    stated = result.to_dict()["accuracy"]
    assert stated["step_mm"] == result.bands.error < 1e-2 * stated["chord_mm"]  # type: ignore[attr-defined]
    assert solid.volume == pytest.approx(result.bands.volume, abs=0.5)  # type: ignore[attr-defined]


def test_undercut_walls_are_refused() -> None:
    design = gc.load("profiles/cylinder_cam.toml").with_(
        {
            "motion[0].lift_mm": 40,
            "follower.roller_radius_mm": 27,
            "follower.cone_deg": 0,
            "cam.outer_diameter_mm": 80,
            "cam.length_mm": 180,
            "cam.lowest_mm": 60,
            "blank.bore_diameter_mm": 10,
        }
    )
    with pytest.raises(gc.InfeasibleError, match="undercut"):
        gc.build(design).files("step")
