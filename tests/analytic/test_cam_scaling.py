"""A cam of another size is the same cam: lengths scale exactly, and tolerances with them.

By 1e-6 and 1e6 for each kind of follower, and by 0.01 and 100 for whole designs of each form: the
ranges of design files end beyond these.
"""

from __future__ import annotations

import math
import re
import tomllib
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
import pytest

import gearcam
from gearcam.cams.disc import DiscCam, make_cam
from gearcam.cams.placing import make_follower
from gearcam.cams.spec import CamSpec, FollowerSpec
from helpers_cams import KINDS, SPECS, there_and_back
from helpers_pairs import PROFILES
from helpers_sampling import few

EXACT = 1e-12
"""Relative difference."""

STEEP = (60.0, 90.0, 60.0, 150.0)
LENGTH = 10.0
"""Of a lift, mm or deg."""


def at_scale(kind: str, law: str, scale: float) -> DiscCam:
    follower: dict[str, Any]
    cam: dict[str, Any]
    follower, cam = (
        {name: value if isinstance(value, str) else scale * value for name, value in given.items()}
        for given in SPECS[kind]
    )
    spec = FollowerSpec(**follower)
    lift = LENGTH * (1.0 if spec.oscillating else scale)
    program = there_and_back(law, lift, STEEP, swings=spec.oscillating)
    return make_cam(program, make_follower(spec, CamSpec(**cam)), tolerance=1e-3 * scale)


def measured(made: DiscCam, scale: float) -> dict[str, float]:
    """Numbers of a cam, in its own size; radii that do not exist are left out."""
    of_lift = made.follower.lever / scale
    pitch = made.pitch_curvature()
    radii = {
        name: value / scale
        for name, value in zip(("convex", "concave"), made.profile_radius, strict=True)
        if math.isfinite(value)
    }
    return {
        **radii,
        "perimeter": made.size.perimeter / scale,
        "area": made.size.area / scale**2,
        "lost": made.shortfall * of_lift,
        "stroke": made.program.range[1] * of_lift,
        "pressure": pressure.largest if (pressure := made.pressure("rise")) else 0.0,
        "pitch": pitch.largest * scale if pitch else 0.0,
        "dense area": made.contour.moments.area / scale**2,
    }


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("scale", few([1e-6, 1e6]))
@pytest.mark.parametrize("law", few(["constant-velocity", "cycloidal"]))
def test_profiles_scale(kind: str, law: str, scale: float) -> None:
    made, other = at_scale(kind, law, 1.0), at_scale(kind, law, scale)
    size = float(np.abs(made.outline).max())
    one, two = made.outline, other.outline / scale
    assert one.shape == two.shape
    assert np.abs(two - one).max() <= EXACT * size
    assert abs(other.contour.chord_error / scale - made.contour.chord_error) <= EXACT * size
    assert len(other.corners) == len(made.corners)
    for corner, same in zip(other.corners, made.corners, strict=True):
        assert abs(corner.point / scale - same.point) <= EXACT * size
        angles = (corner.before - same.before, corner.after - same.after)
        assert np.abs(angles).max() <= EXACT
    found, given = measured(other, scale), measured(made, 1.0)
    assert found.keys() == given.keys()
    for name, value in given.items():
        assert found[name] == pytest.approx(value, rel=EXACT, abs=EXACT), name


def scaled(given: Any, scale: float, key: str = "") -> Any:
    """A document with every length in it scaled."""
    if isinstance(given, Mapping):
        return {name: scaled(value, scale, name) for name, value in given.items()}
    if isinstance(given, list):
        return [scaled(value, scale, key) for value in given]
    return scale * given if re.search(r"_mm(_|$)", key) and not isinstance(given, str) else given


def numbers(given: Any, path: str = "") -> Iterator[tuple[str, float]]:
    if isinstance(given, Mapping):
        for name, value in given.items():
            yield from numbers(value, f"{path}.{name}")
    elif isinstance(given, list):
        for number, value in enumerate(given):
            yield from numbers(value, f"{path}[{number}]")
    elif isinstance(given, int | float) and not isinstance(given, bool):
        yield path, float(given)


def facts_of(name: str, scale: float) -> dict[str, float]:
    with (PROFILES / f"{name}.toml").open("rb") as file:
        document = tomllib.load(file)
    output = {"chord_tolerance_mm": 1e-3} | document["output"] | {"files": ["csv"]}
    lengths = {"lost_lift": 0.01, "profile_radius": 1.0, "wall": 1.0, "tool_diameter": 0.3}
    limits = {f"{key}_mm": value for key, value in lengths.items()} | document.get("limits", {})
    result = gearcam.build(
        gearcam.design(scaled(document | {"output": output, "limits": limits}, scale))
    )
    _ = result.parts
    told = result.facts.document
    return dict(numbers({key: told[key] for key in ("motion", "cam", "part") if key in told}))


WHOLE = ["plate_cam_offset_roller", "plate_cam_oscillating", "groove_cam", "yoke_cam"]
MORE = ["conjugate_cams", "translating_cam", "undercut_cam", "flat_follower", "tappet"]

POWERS = {"_g_mm": 4, "_kg_mm2": 5, "_mm3": 3, "_mm2": 2, "_mm": 1, "_kg": 3, "_deg": 0}
"""Of lengths, in units that names end in."""


FLAT = ("tool.largest_diameter_mm", "tool.inner_radius_mm")


def lost(key: str, given: Mapping[str, float]) -> float:
    """How many times more than its rounding a fact differs."""
    if "chord_error" in key:
        return 1e5  # differences of lengths of a hundred thousand times their size
    if key.endswith(FLAT):
        # the step over which a radius is taken is a share of the size of the part, and the steps'
        # turn, a difference of unit tangents, is smaller as the hollow is flatter
        return max(1.0, given[key] / given[f"{key.partition('.tool')[0]}.size_mm[0]"])
    return 1.0


@pytest.mark.parametrize(
    "name", [*WHOLE, *(pytest.param(name, marks=pytest.mark.slow) for name in MORE)]
)
def test_facts_scale(name: str) -> None:
    """Each by a power of the scale: lengths by the first, areas by the second, and so on."""
    given = facts_of(name, 1.0)
    for scale in (1e-2, 1e2):
        found = facts_of(name, scale)
        assert found.keys() == given.keys()
        for key, value in given.items():
            if abs(value) < EXACT:
                assert abs(found[key]) < EXACT
                continue
            power = round(math.log(abs(found[key] / value)) / math.log(scale))
            room = EXACT * lost(key, given)
            assert found[key] == pytest.approx(value * scale**power, rel=room), (key, scale)
            unit = next((unit for unit in POWERS if key.split("[")[0].endswith(unit)), None)
            assert unit is None or power == POWERS[unit], key
