"""Every key of a blank is made in every kind of body, or refused for it with the reason.

What is made is looked at: by how much the area of the part, its hub, its marks or its mass change
with the value, in closed form where there is one.
"""

from __future__ import annotations

import json
import math
from functools import lru_cache
from typing import Any

import pytest

import gearcam as gc
from gearcam.base.errors import DesignError, InfeasibleError
from gearcam.kinds.gear_pair.parts import make_parts
from gearcam.kinds.gridded_shown import solid_facts
from helpers_pairs import PROFILES
from helpers_sampling import chosen

BORE = {"bore_diameter_mm": 8}
KEYWAY = BORE | {"keyway_width_mm": 2, "keyway_depth_mm": 1}
HUB = {"hub_diameter_mm": 13, "hub_front_mm": 3}
SCREW = BORE | HUB | {"set_screw": "M2"}
BOLTS = {"bolts": 2, "bolt_circle_mm": 20, "bolt_diameter_mm": 2}
ROW = {"bolts": 2, "bolt_diameter_mm": 2, "bolt_height_mm": 5, "bolt_spacing_mm": 60}
HOLES = BORE | {"lightening_holes": 4, "rim_mm": 4}
MARK = {"timing_marks": True}

KEYS: dict[str, tuple[dict[str, Any], Any, Any]] = {
    # what it belongs to, one value, and another one
    "bore_diameter_mm": ({}, 8, 9),
    "keyway_width_mm": (KEYWAY, 2, 2.5),
    "keyway_depth_mm": (KEYWAY, 1, 1.5),
    "keyway_angle_deg": (KEYWAY, 30, 60),
    "bore_flat_mm": (BORE, 7, 7.5),
    "bore_across_flats_mm": (BORE, 6, 7),
    "shaft": ({}, "NEMA 17", "28BYJ-48"),
    "keyway": (BORE, "DIN 6885", "none"),
    "bolts": (BOLTS, 2, 3),
    "bolt_circle_mm": (BOLTS, 20, 22),
    "bolt_diameter_mm": (BOLTS, 2, 3),
    "bolt_angle_deg": (BOLTS, 20, 30),
    "hub_diameter_mm": (HUB, 13, 15),
    "hub_front_mm": (HUB, 3, 4),
    "hub_back_mm": (HUB, 3, 4),
    "lightening_holes": (HOLES, 4, 3),
    "rim_mm": (HOLES, 4, 5),
    "web_mm": (HOLES, 2, 3),
    "stop_pin_mm": ({}, 1, 1.5),
    "timing_marks": ({}, True, False),
    "mark_diameter_mm": (MARK, 0.8, 0.6),
    "density_kg_m3": ({}, 7850, 1000),
    "clearance_mm": ({}, 0.05, 0.1),
    "clearance_bores": (BOLTS | {"clearance_mm": 0.1}, True, False),
    "tip_rounding_mm": ({}, 0.1, 0.2),
    "set_screw": (SCREW, "M2", "M2.5"),
    "set_screw_angle_deg": (SCREW, 30, 60),
    "chamfer_mm": ({}, 0.2, 0.3),
    "rotation_arrow": ({}, True, False),
    "zero_mark": ({}, True, False),
    "height_mm": ({}, 60, 65),
    "length_mm": ({}, 250, 260),
    "bolt_spacing_mm": (ROW, 60, 80),
    "bolt_height_mm": (ROW, 5, 6),
}


def _segment(radius: float, away: float) -> float:
    """Return the area of a circle beyond a line at a distance from its centre."""
    half = math.acos(away / radius)
    return radius**2 * (half - math.sin(half) * math.cos(half))


AREAS = {
    "bore_across_flats_mm": 2 * (_segment(4, 3) - _segment(4, 3.5)),
    "shaft": 2 * _segment(2.5, 1.5) - _segment(2.5, 2),
    "keyway": 2 * 5 - (math.sqrt(15) + 16 * math.asin(0.25)),
    "bore_diameter_mm": math.pi / 4 * (9**2 - 8**2),
    "bolts": math.pi / 4 * 2**2,
    "bolt_diameter_mm": 2 * math.pi / 4 * (3**2 - 2**2),
    "clearance_bores": 2 * math.pi / 4 * (2.2**2 - 2**2),
}
"""Area by which parts differ with the two values of a key, mm^2."""

COMMON = ("timing_marks", "mark_diameter_mm", "clearance_bores", "rotation_arrow")
"""Given once for both wheels."""

OF_TEETH = {"stop_pin_mm", "timing_marks", "mark_diameter_mm", "tip_rounding_mm"}
OF_PLATES = {"height_mm", "length_mm", "bolt_spacing_mm", "bolt_height_mm"}
OF_SHAFT = {key for key in KEYS if key.startswith(("bore", "keyway", "hub", "set_screw", "shaft"))}
OF_HOLES = {"lightening_holes", "rim_mm", "web_mm"}
OF_BOLTS = {"bolts", "bolt_circle_mm", "bolt_diameter_mm", "bolt_angle_deg"}
CLEAR = {"clearance_mm", "clearance_bores"}

PAIR = {"kind": "gear-pair", "name": "p", "output": {"chord_tolerance_mm": 0.02}}
OPEN = {"knots_deg": [0, 100, 200, "solve"], "ratios": [1, 1, 1, 1], "driven_travel_deg": 250}


def _pair(teeth: list[int], law: dict[str, Any], **tables: Any) -> dict[str, Any]:
    size = {"module_mm": 2, "teeth": teeth, "face_width_mm": 5} | tables.pop("pair", {})
    return PAIR | {"law": law, "pair": size, **tables}


def _cam(name: str, **output: Any) -> dict[str, Any]:
    document = gc.load(PROFILES / f"{name}.toml").to_dict()
    document["blank"] = {"height_mm": 60} if name == "translating_cam" else {}
    return document | {"output": {"files": ["csv"], **output}}


ROUND = {"type": "constant"}
BODIES: dict[str, tuple[dict[str, Any], int, set[str]]] = {
    # the design without a blank, the wheel (0: a single body), and what it is not made with
    "wheel 1": (_pair([24, 24], ROUND), 1, OF_PLATES | {"stop_pin_mm", "zero_mark"}),
    "wheel 2": (_pair([24, 24], ROUND), 2, OF_PLATES | {"stop_pin_mm", "zero_mark"}),
    "stepped wheel": (
        _pair([24, 24], ROUND, steps={"count": 2}), 1, OF_PLATES | {"stop_pin_mm", "zero_mark"}
    ),
    "open wheel": (_pair([24, 24], {"type": "phases", **OPEN}), 2, OF_PLATES | {"zero_mark"}),
    "ring": (
        _pair([16, 40], ROUND, pair={"type": "internal"}, ring={"rim_mm": 16}),
        2,
        OF_PLATES | OF_SHAFT | OF_HOLES | {"stop_pin_mm", "zero_mark"},
    ),
    "rack": (
        _pair([24, 24], {"type": "rack", "r1": "1"}),
        2,
        OF_PLATES | OF_SHAFT | OF_HOLES | OF_BOLTS | {"stop_pin_mm", "zero_mark"},
    ),
    "disc": (_cam("plate_cam_offset_roller", chord_tolerance_mm=0.01), 0, OF_TEETH | OF_PLATES),
    "groove": (_cam("groove_cam", chord_tolerance_mm=0.01), 0, OF_TEETH | OF_PLATES | CLEAR),
    "conjugate": (_cam("conjugate_cams", chord_tolerance_mm=0.01), 0, OF_TEETH | OF_PLATES),
    "yoke": (_cam("yoke_cam", chord_tolerance_mm=0.01), 0, OF_TEETH | OF_PLATES),
    "translating": (
        _cam("translating_cam", chord_tolerance_mm=0.01),
        0,
        (OF_TEETH | OF_SHAFT | OF_HOLES | {"bolt_circle_mm", "bolt_angle_deg"} | CLEAR),
    ),
    "cylinder": (
        _cam("cylinder_cam", wall_step_deg=5, wall_points=3),
        0,
        OF_TEETH | OF_PLATES | CLEAR,
    ),
    "globoidal": (
        _cam("globoidal_indexer", wall_step_deg=5, wall_points=3),
        0,
        OF_TEETH | OF_PLATES | CLEAR,
    ),
}  # fmt: skip


def _blank(body: str, key: str, value: Any) -> dict[str, Any]:
    """Return a blank with a value of a key and what it belongs to, asked of one wheel alone."""
    document, wheel, _ = BODIES[body]
    rest = ROW if body == "translating" and key in ROW else KEYS[key][0]
    given = {**rest, key: value}
    if body == "ring" and "bolt_circle_mm" in given:
        given["bolt_circle_mm"] += 74
    if wheel == 0:
        return {**document["blank"], **given}
    none = {"density_kg_m3": 7850} | dict.fromkeys(("shaft", "keyway", "set_screw"), "none")
    return {
        one: size if one in COMMON else [size if k == wheel else none.get(one, 0) for k in (1, 2)]
        for one, size in given.items()
    }


@lru_cache(maxsize=64)
def _built(document: str) -> Any:
    return gc.build(gc.design(json.loads(document)))


def _made(body: str, key: str, value: Any) -> tuple[Any, list[Any]]:
    """Return what is made: the region of the part, and what else is measured of it."""
    bare, wheel, _ = BODIES[body]
    document = bare | {"blank": _blank(body, key, value)}
    design: Any = gc.design(document)
    text = json.dumps(document)
    if body in ("cylinder", "globoidal"):
        result = _built(text)
        measured = [result.mesh.volume, (solid_facts(result) or {}).get("mass_kg")]
        return result.core and result.core.region, measured
    if key == "density_kg_m3":
        found = _built(text).facts.document["gears" if wheel else "part"]
        own = found[max(wheel - 1, 0)] if isinstance(found, list) else found
        return None, [own["mass"]["mass_kg"]]
    if wheel and key not in ("clearance_mm", "clearance_bores", "tip_rounding_mm"):
        parts = make_parts(_built(json.dumps(bare)).steps, design)
    else:
        parts = _built(text).parts
    hubs = [part.hub and (part.hub.diameter, part.hub.front, part.hub.back) for part in parts]
    cut = [[one.edges[0].moments for one in part.pockets] for part in parts]
    screws = [part.screw and part.screw.moments for part in parts]
    return parts[wheel - 1].region, [hubs, cut, screws]


@pytest.mark.parametrize("body", chosen([*BODIES], "wheel 1", "rack", "disc", "cylinder"))
def test_every_key_is_made_or_refused_with_the_reason(body: str) -> None:
    refused = set[str]()
    for key, (_, one, other) in KEYS.items():
        if (body, key) == ("rack", "clearance_bores"):
            continue  # it is for the openings of wheel 1
        try:
            made = [_made(body, key, value) for value in (one, other)]
        except DesignError as error:
            told = {problem.key.partition("[")[0]: problem for problem in error.problems}
            assert told[f"blank.{key}"].allowed, (body, key)
            refused.add(key)
            continue
        except InfeasibleError:  # a stop pin of a wheel that turns all around
            refused.add(key)
            continue
        (region, rest), (second, others) = made
        pair = None if region is None or second is None else (region, second)
        moved = pair[0].symmetric_difference(pair[1]).area if pair else 0.0
        assert moved > 1e-3 or rest != others, f"{key} makes no difference to {body}"
        if key in AREAS and pair:
            cut = abs(pair[0].area - pair[1].area)
            assert cut == pytest.approx(AREAS[key], rel=0.03), f"{key} of {body}"
    assert refused == BODIES[body][2]


@pytest.mark.parametrize(
    ("body", "words"),
    [
        ("ring", "wheel 2 is a ring and has no shaft"),
        ("rack", "wheel 2 is a rack and has no openings and no hub"),
        ("translating", "does not apply to a translating cam: it slides"),
    ],
)
def test_a_refusal_names_the_body_and_the_reason(body: str, words: str) -> None:
    with pytest.raises(DesignError) as caught:
        gc.design(BODIES[body][0] | {"blank": _blank(body, "hub_diameter_mm", 13)})
    assert any(words in one.message for one in caught.value.problems), str(caught.value)


def test_a_value_for_both_wheels_asks_it_of_the_rack_too() -> None:
    rack = BODIES["rack"][0]
    with pytest.raises(DesignError) as caught:
        gc.design(rack | {"blank": BOLTS})
    (problem,) = caught.value.problems
    assert (problem.key, problem.value, problem.allowed) == ("blank.bolts", 2, "[2, 0]")
    design = gc.design(rack | {"blank": BOLTS | {"bolts": [2, 0], "bore_diameter_mm": [8, 0]}})
    assert [len(part.openings) for part in gc.build(design).parts] == [3, 0]
    assert gc.design(design.to_dict()) == design
