"""The view of solids that a page holds: which bodies, where, how fine, and why there is none."""

from __future__ import annotations

import base64
import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh

import gearcam
from gearcam.parts.solids import SolidError
from gearcam.report.file import CHORDS, solids_shown
from helpers_pairs import PROFILES


def build(name: str, **changes: Any) -> Any:
    design = gearcam.load(PROFILES / f"{name}.toml")
    keys = {key.replace("__", "."): value for key, value in changes.items()}
    return gearcam.build(design.with_(keys) if keys else design)


def bodies_of(view: str) -> dict[str, Any]:
    """The meshes in a view, by name, where they stand."""
    (data,) = re.findall(r'base64_data="([^"]+)"', view)
    scene: Any = trimesh.load(
        file_obj=trimesh.util.wrap_as_stream(base64.b64decode(data)), file_type="glb"
    )
    found = {}
    for node in sorted(scene.graph.nodes_geometry):
        place, name = scene.graph[node]
        found[name] = scene.geometry[name].copy().apply_transform(place)
    return found


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
