"""The view of solids that a page holds: which bodies, where, how fine, and why there is none."""

from __future__ import annotations

import json
import re
import tomllib
from itertools import product
from pathlib import Path
from typing import Any

import manifold3d
import numpy as np
import pytest
import shapely

import gearcam
from gearcam.numeric.arrays import as_pairs
from gearcam.numeric.contour import Contour
from gearcam.parts.solids import SolidError
from gearcam.report.file import CHORDS, solids_shown
from gearcam.report.page import document, page
from helpers_pairs import PROFILES
from helpers_sampling import chosen
from helpers_solids import bodies_of


def build(name: str, **changes: Any) -> Any:
    design = gearcam.load(PROFILES / f"{name}.toml")
    keys = {key.replace("__", "."): value for key, value in changes.items()}
    return gearcam.build(design.with_(keys) if keys else design)


def test_wheels_stand_as_assembled() -> None:
    result = build("nail_machine_two_phase", output__phi1_deg=50)
    bodies = bodies_of(solids_shown(result)["view"])
    assert [*bodies] == ["gear1", "gear2"]
    phi2 = result.motion(np.radians([50.0]))["phi2_deg"][0]
    for number, (turn, x) in enumerate(((-50.0, 0.0), (phi2, 180.0))):
        own = result.parts[number].contour.vertices
        angle = np.radians(turn)
        placed = own @ np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
        placed[:, 0] += x
        low, high = bodies[f"gear{number + 1}"].bounds
        np.testing.assert_allclose(low[:2], placed.min(axis=0), atol=2 * CHORDS)
        np.testing.assert_allclose(high[:2], placed.max(axis=0), atol=2 * CHORDS)
        assert (low[2], high[2]) == pytest.approx((0.0, 50.0))


def test_cams_stand_at_their_heights() -> None:
    result = build("conjugate_cams")
    bodies = bodies_of(solids_shown(result)["view"])
    heights = result.form.heights()
    assert len({*heights}) == 2
    assert [body.bounds[0][2] for body in bodies.values()] == pytest.approx(heights)


def test_a_cam_of_one_part_is_shown() -> None:
    assert len(bodies_of(solids_shown(build("plate_cam_offset_roller"))["view"])) == 1


def triangles(result: Any) -> int:
    return sum(len(one.faces) for one in bodies_of(solids_shown(result)["view"]).values())


def test_chords_are_those_of_the_view_or_coarser_ones_of_the_design() -> None:
    usual = triangles(build("nail_machine_two_phase"))
    assert usual == triangles(build("nail_machine_two_phase", output__chord_tolerance_mm=CHORDS))
    assert usual == triangles(build("nail_machine_two_phase", output__chord_tolerance_mm=0.002))
    assert triangles(build("nail_machine_two_phase", output__chord_tolerance_mm=0.08)) < 0.7 * usual


def test_small_teeth_keep_the_chords_of_the_design() -> None:
    result = build("ellipse", pair__module_mm=0.5, pair__face_width_mm=3)  # m/50 = 10 um
    bodies = bodies_of(solids_shown(result)["view"])
    assert sum(len(one.faces) for one in bodies.values()) > 2 * triangles(build("ellipse"))


def test_why_solids_cannot_be_shown_is_told(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    def refuse(part: Any) -> Any:
        raise SolidError(f"{part.name}: the solid came out <empty>")

    monkeypatch.setattr("gearcam.parts.solids.solid", refuse)
    result = build("ellipse")
    assert solids_shown(result) == {"refusal": "gear1: the solid came out <empty>"}
    written = result.write(tmp_path, files=["report"])
    text = (written.directory / "report.html").read_text("utf-8")
    assert "The solids cannot be shown: gear1: the solid came out &lt;empty&gt;" in text
    assert 'id="solids-view"' not in text


def test_a_page_holds_the_view_and_is_small(tmp_path: Path) -> None:
    written = build("nail_machine_two_phase").write(tmp_path, files=["report"])
    data = (written.directory / "report.html").read_bytes()
    assert len(data) < 2_000_000
    _, _, rest = data.decode().partition('<script type="application/json" id="solids-view">')
    view = json.loads(rest.partition("</script>")[0])
    assert [*bodies_of(view)] == ["gear1", "gear2"]
    assert "http-equiv" not in view
    assert not re.search(r'(src|href)="?https?:', view)


def test_a_view_is_the_same_every_time() -> None:
    views = [solids_shown(build("ellipse"))["view"] for _ in range(2)]
    assert views[0] == views[1]


@pytest.mark.parametrize(
    ("name", "place"),
    [
        ("cylinder_cam", "first"), ("globoidal_indexer", "first"), ("askew_pair", "first"),
        ("ellipse", "after"), ("yoke_cam", "after"), ("four_bar", ""),
    ],
)  # fmt: skip
def test_where_a_page_shows_the_solids(name: str, place: str) -> None:
    coarse = {"output__wall_step_deg": 3} if name in ("cylinder_cam", "globoidal_indexer") else {}
    shown = document(build(name, **coarse), seek=False)
    assert shown["solids"] == place
    live = page(shown, live={"file": "a"}).decode()
    assert ('id="solids"' in live, 'href="#solids"' in live) == (place != "", place == "after")
    assert ('<div id="solids">' in live) is (place == "first")
    still = page(shown).decode()  # which holds no view
    assert 'id="solids"' not in still
    assert "solid-first" not in still.partition("<body")[2].partition(">")[0]


MOVED = (
    "cylinder_cam", "groove_cam", "conjugate_cams", "plate_cam_oscillating", "translating_cam",
    "ellipse", "feeder", "ring_ellipse", "stepped_ellipse",
)  # fmt: skip


@pytest.mark.parametrize("name", chosen(MOVED, *MOVED[:6]))
def test_solids_stand_where_the_scene_has_them_at_the_place_of_the_design(name: str) -> None:
    """The page moves a solid by the poses of its name: they are of the same frame.

    A cam in the plane stands unturned instead, as it is printed.
    """
    result = build(name)
    scene, solids = result.scene(720), result.standing()
    at = int(np.argmin(np.abs(scene.places - scene.start)))
    bodies = {body.name: body for body in scene.bodies}
    for key, (mesh, pose) in solids.items():
        if key in scene.in_space:
            assert pose.matrix == pytest.approx(scene.in_space[key][at].matrix, abs=1e-12)
            continue
        # corners of the solid are points of the outlines that move in the scene
        steps = [one for one in scene.bodies if one.name == key]
        shapes = [one.shape for step in steps for one in step.features]
        shapes = [one for one in shapes if isinstance(one, Contour)]
        outlines = shapely.multipoints(as_pairs(np.concatenate([one.points for one in shapes])))
        corners = shapely.points(mesh.vertices[:, :2])
        assert (shapely.distance(outlines, corners) < 1e-6).mean() > 0.5
        if not name.endswith(("cam", "cams", "oscillating")):
            drawn = bodies[key].pose[at].in_space.matrix
            assert pose.matrix == pytest.approx(drawn, abs=1e-9)


def carried(rotation: str, *, oscillating: bool) -> Any:
    """The cylinder cam with one of both followers."""
    given = tomllib.loads((PROFILES / "cylinder_cam.toml").read_text("utf-8"))
    given |= {"name": "carried"}
    given["cam"] |= {"rotation": rotation}
    given["output"] = {"wall_step_deg": 1, "theta_deg": 30}
    if oscillating:
        given["follower"] |= {"motion": "oscillating", "arm_mm": 120}
        given["motion"][0] |= {"lift_deg": given["motion"][0].pop("lift_mm") / 2.5}
        given["cam"]["lowest_mm"] = 55 - 60 * 0.4
    return gearcam.build(gearcam.design(given))


def body(mesh: Any) -> manifold3d.Manifold:
    found = manifold3d.Mesh64(mesh.vertices, mesh.triangles.astype(np.uint64))
    return manifold3d.Manifold(found)


@pytest.mark.parametrize(
    ("rotation", "oscillating"),
    chosen(product(("ccw", "cw"), (False, True)), ("cw", True)),
)
def test_the_roller_runs_through_the_groove_of_the_cam_that_turns(
    rotation: str, oscillating: bool
) -> None:
    result = carried(rotation, oscillating=oscillating)
    scene, solids = result.scene(24), result.standing(CHORDS)
    assert [*solids] == [*scene.in_space] == ["cam", "roller"]
    assert [*result.meshes] == ["cam"]

    def overlap(place: int, behind: int = 0) -> float:
        poses = scene.in_space
        cam = body(solids["cam"][0].placed(poses["cam"][place]))
        roller = body(solids["roller"][0].placed(poses["roller"][place - behind]))
        return float((cam ^ roller).volume())

    assert (
        max(overlap(k) for k in range(0, 25, 2)) < 0.2
    )  # chords of 1 deg; the roller has 6000 mm3
    assert overlap(5, behind=1) > 100.0


def test_two_rollers_run_along_a_rib() -> None:
    given = tomllib.loads((PROFILES / "cylinder_cam.toml").read_text("utf-8"))
    given |= {"name": "rib", "output": {"wall_step_deg": 1}}
    given["cam"] |= {"walls": "rib", "rib_mm": 8, "lowest_mm": 30, "length_mm": 120}
    result = gearcam.build(gearcam.design(given))
    scene, solids = result.scene(12), result.standing(CHORDS)
    assert [*solids] == [*scene.in_space] == ["cam", "roller_upper", "roller_lower"]
    for place in (0, 3, 10):
        upper, lower = (
            body(solids[name][0].placed(scene.in_space[name][place])) for name in [*solids][1:]
        )
        cam = body(solids["cam"][0].placed(scene.in_space["cam"][place]))
        assert (cam ^ upper).volume() + (cam ^ lower).volume() < 0.2
        for moved, way in ((upper, -0.3), (lower, 0.3)):  # the rib is between them
            assert (cam ^ moved.translate((0.0, 0.0, way))).volume() > 5.0
