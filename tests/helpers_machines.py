"""Machines of all sorts of members, each small, for what is drawn of them."""

from __future__ import annotations

from functools import cache
from typing import Any

import gearcam as gc
from helpers_pairs import PROFILES

MOTOR = {"name": "motor", "even": True}
PAIR = {
    "law": {"type": "ellipse", "eccentricity": 0.3},
    "pair": {"teeth": [24, 24], "module_mm": 3},
}
LEVER = str(PROFILES / "plate_cam_oscillating.toml")
TAPPET = str(PROFILES / "plate_cam_offset_roller.toml")

DRUM: dict[str, Any] = {
    "kind": "cam", "name": "drum",
    "motion": [
        {"type": "rise", "law": "modified-sine", "angle_deg": 150, "lift_mm": 60},
        {"type": "dwell", "angle_deg": 40},
        {"type": "return", "law": "cycloidal", "angle_deg": 140},
        {"type": "dwell", "angle_deg": "rest"},
    ],
    "follower": {"roller_radius_mm": 11},
    "cam": {"form": "cylinder", "outer_diameter_mm": 200, "length_mm": 110, "lowest_mm": 25,
            "groove_depth_mm": 18},
}  # fmt: skip
"""A cylinder cam; `SWING` has an arm."""

SWING: dict[str, Any] = {
    **DRUM,
    "motion": [{"type": "rise", "law": "modified-sine", "angle_deg": 150, "lift_deg": 20},
               *DRUM["motion"][1:]],
    "follower": {"roller_radius_mm": 11, "motion": "oscillating", "arm_mm": 160, "start_deg": -7,
                 "pivot_distance_mm": 158.5},
    "cam": {**DRUM["cam"], "length_mm": 130, "lowest_mm": 35},
}  # fmt: skip

FRAMES: dict[str, dict[str, Any]] = {
    "as it is": {},
    "turned": {"at_mm": [30, -40], "turn_deg": 35},
    "mirrored": {"at_mm": [5, 10], "turn_deg": -120, "mirror": True},
}
"""Where drives stand."""

MACHINES: dict[str, dict[str, Any]] = {
    "four-bar": {
        "drive": [MOTOR],
        "joint": [{"name": "D", "at_mm": [110, 0]}],
        "crank": [{"name": "crank", "on": "motor", "joint": "B", "length_mm": 40}],
        "dyad": [
            {"type": "RRR", "from": "B", "to": "D", "joint": "C", "members": ["coupler", "rocker"],
             "lengths_mm": [120, 90]}
        ],
        "point": [{"name": "P", "on": "coupler", "at_mm": [50, 35]}],
        "output": {"files": ["svg", "dxf"], "outputs": ["P", "C", "rocker.angle"], "q_deg": 40},
    },
    "slide behind a pair": {
        "drive": [{"name": "pair", "pair": PAIR}],
        "crank": [{"name": "crank", "on": "pair.wheel2", "joint": "B", "length_mm": 40}],
        "guide": [{"name": "bed", "at_mm": [72, 10]}],
        "dyad": [
            {"type": "RRT", "from": "B", "to": "bed", "joint": "C", "members": ["rod", "ram"],
             "lengths_mm": [120, 0]}
        ],
        "output": {"files": ["svg", "dxf"]},
    },
    "pair, mirrored, turned, twice as fast": {
        "drive": [
            MOTOR,
            {"name": "pair", "pair": PAIR, "ratio": 2, "phase_deg": 50, "mirror": True,
             "turn_deg": 30, "at_mm": [200, 20]},
        ],
        "crank": [
            {"name": "one", "on": "motor", "joint": "B", "length_mm": 40},
            {"name": "two", "on": "pair.wheel2", "joint": "C", "length_mm": 30, "angle_deg": 20},
        ],
        "dyad": [
            {"type": "RRR", "from": "B", "to": "C", "joint": "P", "members": ["left", "right"],
             "lengths_mm": [200, 210]}
        ],
        "output": {"files": ["svg", "dxf"], "outputs": ["P"]},
    },
    "lever on a cam, mirrored": {
        "drive": [
            {"name": "cam", "cam": LEVER, "mirror": True, "turn_deg": 30, "at_mm": [10, 20]}
        ],
        "crank": [
            {"name": "lever", "on": "cam.follower", "joint": "B", "length_mm": 60,
             "arm_angle_deg": 150}
        ],
        "guide": [{"name": "way", "at_mm": [0, -60]}],
        "dyad": [
            {"type": "RRT", "from": "B", "to": "way", "joint": "C", "members": ["rod", "tool"],
             "lengths_mm": [250, 0]}
        ],
        "output": {"files": ["svg", "dxf"]},
    },
    "table on two cams": {
        "drive": [
            {"name": "camx", "cam": TAPPET, "turn_deg": -90},
            {"name": "camy", "cam": TAPPET, "at_mm": [150, -150], "phase_deg": 90},
        ],
        "slide": [
            {"name": "x", "on": "camx.follower", "joint": "X"},
            {"name": "y", "on": "camy.follower", "joint": "Y", "at_mm": [10, 5]},
        ],
        "guide": [
            {"name": "gx", "on": "x", "direction_deg": 90, "at_mm": [40, 0]},
            {"name": "gy", "on": "y", "direction_deg": -90, "at_mm": [30, 0]},
        ],
        "dyad": [
            {"type": "TRT", "from": "gx", "to": "gy", "joint": "T", "members": ["mx", "my"]}
        ],
        "output": {"files": ["svg", "dxf"], "outputs": ["T"]},
    },
    "shaper": {
        "drive": [MOTOR],
        "joint": [{"name": "O", "at_mm": [0, -130]}],
        "crank": [{"name": "crank", "on": "motor", "joint": "pin", "length_mm": 50}],
        "guide": [{"name": "bed", "at_mm": [0, 150]}],
        "dyad": [
            {"type": "RTR", "from": "O", "to": "pin", "joint": "B",
             "members": ["rocker", "block"]},
            {"type": "RRT", "from": "E", "to": "bed", "joint": "ram", "members": ["rod", "head"],
             "lengths_mm": [80, 0]},
        ],
        "point": [{"name": "E", "on": "rocker", "at_mm": [260, 0]}],
        "output": {"files": ["svg", "dxf"]},
    },
    "cylinder": {
        "drive": [MOTOR, {"name": "oil", "slide": "30*sin(q)"}],
        "joint": [{"name": "A", "at_mm": [0, 0]}, {"name": "D", "at_mm": [200, 0]}],
        "dyad": [
            {"type": "RTRR", "from": "A", "to": "D", "joint": "C", "driven": "oil",
             "members": ["ram", "arm"], "lengths_mm": [150, 110]}
        ],
        "output": {"files": ["svg", "dxf"]},
    },
    "door": {
        "drive": [{**MOTOR, "range_deg": [0, 400]}],
        "chain": [
            {"on": "motor", "at_mm": [600, 300], "radius_mm": 100, "joint": "B", "lever": "leaf",
             "length_mm": 700, "start_deg": -90, "range_deg": [-90, 5]}
        ],
        "output": {"files": ["svg", "dxf"], "outputs": ["B"], "q_deg": 100},
    },
    "lift": {
        "drive": [{**MOTOR, "range_deg": [0, 300]}],
        "hoist": [
            {"name": "gate", "on": "motor", "joint": "hook", "radius_mm": 50, "at_mm": [50, -500]}
        ],
        "output": {"files": ["svg", "dxf"]},
    },
    "Geneva wheel": {
        "drive": [MOTOR],
        "geneva": [
            {"name": "wheel", "on": "motor", "slots": 5, "length_mm": 50, "angle_deg": 180,
             "direction_deg": 20}
        ],
        "output": {"files": ["svg", "dxf"]},
    },
    "cross": {
        "drive": [MOTOR],
        "crank": [{"name": "crank", "on": "motor", "joint": "B", "length_mm": 40}],
        "guide": [{"name": "way", "at_mm": [120, 10]}],
        "dyad": [
            {"type": "RTT", "from": "B", "to": "way", "joint": "S", "members": ["block", "yoke"],
             "gammas_deg": [0, 90]}
        ],
        "output": {"files": ["svg", "dxf"]},
    },
}  # fmt: skip


@cache
def machine(name: str) -> Any:
    """Return the result of a machine, built once."""
    return gc.build(gc.design({"kind": "mechanism", "name": "drawn", **MACHINES[name]}))
