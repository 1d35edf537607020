"""Designs of any size: the number of teeth, points, knots, rows, harmonics or steps grows."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from typing import Any, Final

PAIR: Final = """
kind = "gear-pair"
name = "growth"
law = {{ {law} }}
pair = {{ module_mm = {module!r}, teeth = [{z1}, {z2}], face_width_mm = 10{more} }}
output = {{ files = ["csv"], chord_tolerance_mm = {tolerance!r} }}
"""
CAM: Final = """
kind = "cam"
name = "growth"
follower = {{ {follower} }}
cam = {{ {cam} }}
blank = {{ {blank} }}
output = {{ chord_tolerance_mm = {tolerance!r}{output} }}
{motion}
"""
LAWS: Final = {
    "constant": "",
    "ellipse": "eccentricity = 0.3",
    "eccentric-circle": "eccentricity = 0.3",
    "limacon": "eccentricity = 0.25",
    "lobed": "eccentricity = 0.1, lobes = [2, 2]",
    "phases": "knots_deg = [0, 160, 360], ratios = [1.6, 0.4, 1.6]",
    "three-phase-polynomial": "knots_deg = [0, 160, 270, 360], lowest = 0.6",
    "multispeed": 'ratios = [0.8, "solve"], angles_deg = [120, 120], transition_deg = 60',
    "fourier": 'of = "ratio", cosines = [0.2, 0.1], sines = [0.05]',
    "bspline": "radii = [1.0, 1.2, 1.0, 0.8]",
    "rounded-polygon": "corners = 4, corner_radius = 0.16666666666666666",
    "formula": 'phi2 = "phi1 - 0.08*sin(2*phi1)"',
    "motion": 'slide = "1 - cos(phi1 + 0.3*sin(phi1))'
    ' + 3*(1 - sqrt(1 - (sin(phi1 + 0.3*sin(phi1))/3)**2))", rod = 3',
    "log-spiral": "ratios = [0.5, 2], driven_travel_deg = 200",
    "rack": 'r1 = "1 + 0.2*cos(2*phi1)"',
}
"""All laws except the table."""

HARD: Final = {
    "ellipse of 0.99": 'type = "ellipse", eccentricity = 0.99',
    "swing of 0.9": 'type = "formula", phi2 = "phi1 - 0.9*sin(phi1)"',
}
"""Laws with the most uneven ratios."""

DISC: Final = "prime_radius_mm = 60"
FLAT: Final = "base_radius_mm = 60"
GROOVE: Final = DISC + (
    ', form = "groove", outer_diameter_mm = 200, thickness_mm = 20, groove_depth_mm = 12'
)
CONJUGATE: Final = DISC + ', form = "conjugate", prime_radius2_mm = 60'
ROLLER: Final = 'type = "roller", roller_radius_mm = 6'
SWING: Final = ', motion = "oscillating", pivot_distance_mm = 100'
FOLLOWERS: Final = {
    "roller": (ROLLER, DISC),
    "offset roller": (ROLLER + ", offset_mm = 8", DISC),
    "oscillating roller": (ROLLER + SWING + ", arm_mm = 90", DISC),
    "point": ('type = "point"', DISC),
    "domed": ('type = "domed", dome_radius_mm = 25', DISC),
    "flat": ('type = "flat"', FLAT),
    "oscillating flat": ('type = "flat"' + SWING + ", face_offset_mm = 6", FLAT),
    "groove": (ROLLER, GROOVE),
    "conjugate": (ROLLER, CONJUGATE),
    "yoke": ('type = "flat"', FLAT + ', form = "yoke"'),
    "yoke of rollers": (ROLLER, DISC + ', form = "yoke"'),
    "translating": (ROLLER, 'form = "translating", thickness_mm = 12'),
}
"""All forms of cams and all followers."""


def pair(
    teeth: int, law: str, *, tolerance: float = 1e-3, module: float = 2.0, more: str = ""
) -> str:
    """Return a pair; its size is proportional to the number of teeth."""
    z2 = 2 * teeth if "internal" in more else teeth
    return PAIR.format(law=law, module=module, z1=teeth, z2=z2, more=more, tolerance=tolerance)


def of_type(name: str) -> str:
    """Return the keys of a law of `LAWS`."""
    return f'type = "{name}", {LAWS[name]}'.rstrip(", ")


def even(count: int, end: float = 360.0) -> list[float]:
    """Return angles from 0 to the end, deg."""
    return [end * k / (count - 1) for k in range(count)]


def waves(angles: list[float]) -> list[float]:
    """Return their cosines; the last equals the first."""
    return [round(math.cos(math.radians(angle)), 12) for angle in angles]


def ratio_rows(count: int) -> str:
    """Return rows of the ratio of a smooth law."""
    angles = even(count)
    return f'type = "table", phi1_deg = {angles}, ratio = {[1 + 0.3 * w for w in waves(angles)]}'


def angle_rows(count: int) -> str:
    """Return rows of the driven angle."""
    angles = even(count)
    driven = [angle - 10.0 * math.sin(math.radians(angle)) for angle in angles]
    driven[-1] = 360.0
    return f'type = "table", phi1_deg = {angles}, phi2_deg = {driven}'


def knots(count: int) -> str:
    """Return knots of phases, so shallow that no arc between them is too sharp for teeth."""
    angles = even(count)
    ratios = [1.0 + 1e-4 * wave for wave in waves(angles)]
    values = ", ".join('"solve"' if k == 1 else f"{r}" for k, r in enumerate(ratios))
    return f'type = "phases", knots_deg = {angles}, ratios = [{values}]'


def speeds(count: int) -> str:
    """Return constant ratios with transitions between them."""
    ratios = ", ".join('"solve"' if k == 1 else f"{1.0 + 1e-4 * (k % 2)}" for k in range(count))
    span = 180.0 / count
    return (
        f'type = "multispeed", ratios = [{ratios}], angles_deg = {[span] * count}, '
        f"transition_deg = {span}"
    )


def splines(count: int) -> str:
    """Return control radii."""
    radii = [1.0 + 0.1 * math.cos(2.0 * math.pi * k / count) for k in range(count)]
    return f'type = "bspline", radii = {radii}'


def fourier(count: int, of: str = "ratio") -> str:
    """Return harmonics so small that all centrodes are convex."""
    scale = 1.0 if of == "ratio" else 10.0
    cosines = [0.1 * scale * math.sin(k) / k**3 for k in range(1, count + 1)]
    if of == "phi2":
        return f'type = "fourier", of = "phi2", sines = {cosines}'
    return f'type = "fourier", cosines = {cosines}'


def terms(count: int, of: str) -> str:
    """Return a formula with `count` harmonics."""
    told = " + ".join(f"{0.1 * math.sin(k) / k**3:.12f}*cos({k}*phi1)" for k in range(1, count + 1))
    return f'type = "formula", {of} = "1 + {told}"'


def phases(count: int, lift: str, span: str) -> str:
    """Return alternating rises and returns."""
    count += count % 2
    rows = [
        f'{{ type = "{word}", law = "cycloidal", {span} = {360.0 / count!r}, {rest} }}'
        for word, rest in (("rise", lift), ("return", ""))
    ]
    return "motion = [" + ", ".join(row.replace(",  }", " }") for row in rows * (count // 2)) + "]"


def program(follower: str, cam: str) -> str:
    """Return the motion of the reference cam with the keys for a follower and a form."""
    lift = "lift_deg = 5" if "oscillating" in follower else "lift_mm = 10"
    if "yoke" in cam:
        return (
            'motion = [{ type = "dwell", angle_deg = 30 }, '
            f'{{ type = "rise", law = "cycloidal", angle_deg = 120, {lift} }}, '
            '{ type = "dwell", angle_deg = 30 }]'
        )
    span = "travel_mm" if "translating" in cam else "angle_deg"
    return (
        f'motion = [{{ type = "rise", law = "cycloidal", {span} = 90, {lift} }}, '
        f'{{ type = "dwell", {span} = 90 }}, '
        f'{{ type = "return", law = "cycloidal", {span} = 90 }}, '
        f'{{ type = "dwell", {span} = 90 }}]'
    )


def cam(name: str, tolerance: float = 1e-3, motion: str = "", output: str = "") -> str:
    """Return a cam for a follower of `FOLLOWERS`."""
    follower, form = FOLLOWERS[name]
    return CAM.format(
        follower=follower,
        cam=form,
        blank="height_mm = 60" if "translating" in form else "",
        tolerance=tolerance,
        motion=motion or program(follower, form),
        output=output,
    )


def lift_rows(count: int, smoothing: str = "") -> str:
    """Return rows of a lift without the last one, with noise if they are smoothed."""
    angles = [360.0 * k / count for k in range(count)]
    noise = 1e-3 if smoothing else 0.0
    lifts = [5.0 - 5.0 * math.cos(math.radians(a)) + noise * math.sin(1e4 * a * a) for a in angles]
    return f"[motion]\ntheta_deg = {angles}\nlift_mm = {lifts}\n{smoothing}"


def lift_terms(count: int) -> str:
    """Return a lift as a sum of harmonics."""
    told = " + ".join(f"{2.0 / k**4:.12f}*(1 - cos({k}*theta))" for k in range(1, count + 1))
    return f'[motion]\nlift = "{told}"'


def build(job: Any) -> None:
    """Compute everything of a build except its files."""
    points(job)
    _ = job.findings, job.facts


def points(job: Any) -> int:
    """Return the number of vertices of all outlines."""
    if hasattr(job, "gears"):
        return sum(len(gear.outline) for gear in job.gears)
    return sum(len(contour.vertices) for contour in job.contours)


def files(*kinds: str) -> dict[str, Callable[[Any], object]]:
    """Return stages that make kinds of files."""
    return {kind: partial(_files, kind) for kind in kinds}


def _files(kind: str, job: Any) -> object:
    return job.files(kind, {})


def _mesh(job: Any) -> object:
    return job.mesh(steps=120)


@dataclass(frozen=True)
class Series:
    """Designs of increasing sizes, and the stages measured in addition to the build."""

    name: str
    sizes: tuple[float, ...]
    text: Callable[[Any], str]
    stages: dict[str, Callable[[Any], object]] = field(default_factory=dict)
    by_points: bool = False


FLAT_FILES: Final = ("csv", "dxf", "svg", "cut-svg", "drawing-svg", "drawing-dxf", "inspection")
FILES: Final = (*FLAT_FILES, "stl", "3mf", "glb", "report")
CAM_FILES: Final = (*FILES, "tool-path", "curvature")
TEETH: Final = (30, 300, 3000)
FEWER: Final = (20, 200, 2000)
IN_RINGS: Final = (15, 150, 1500)
TOLERANCES: Final = (1e-2, 1e-4, 1e-6)
KNOTS: Final = (4, 40, 400)
ROWS: Final = (200, 2000, 20000)
LIFTS: Final = (36, 360, 3600)
HARMONICS: Final = (1, 10, 100)
TERMS: Final = (1, 5, 25)
MESH: Final = {"mesh": _mesh}
RING: Final = ', type = "internal"'
TOOL: Final = ", tool_radius_mm = 5"
MANY: Final = (
    "every term is evaluated at every place, and the number of places grows with the number of "
    "extremes, which grows with the number of terms; formulas have at most 2000 characters."
)
GIVEN_UP: Final = {
    ("step of", "step"): "the checks and the translation of the solid modeller grow in this way.",
    ("harmonics of a formula", "build"): MANY,
    ("files of conjugate", "cut-svg"): "parts are placed side by side by the distance of their "
    "hulls, which is computed between all sides of both.",
}
"""Reasons for faster growth, by a word in the name of the series and the stage."""


def all_series() -> list[Series]:
    """Return all series."""
    return [*_of_pairs(), *_of_cams(), *_of_files()]


def _of_pairs() -> list[Series]:
    made = [
        Series(f"teeth, {name}, mesh", FEWER, partial(pair, law=of_type(name)), MESH)
        for name in ("ellipse", "log-spiral", "rack")
    ]
    made += [Series(f"teeth, {name}", TEETH, partial(pair, law=of_type(name))) for name in LAWS]
    made.append(Series("teeth, ring", IN_RINGS, partial(pair, law=of_type("ellipse"), more=RING)))
    made += [
        Series(f"teeth, {name}", (300, 1000, 3000), partial(pair, law=law))
        for name, law in HARD.items()
    ]
    sizes: dict[str, tuple[tuple[int, ...], Callable[[int], str]]] = {
        "rows of ratios": (ROWS, ratio_rows),
        "rows of angles": (ROWS, angle_rows),
        "knots of phases": (KNOTS, knots),
        "control radii": (KNOTS, splines),
        "harmonics of the ratio": (HARMONICS, fourier),
        "harmonics of the angle": (HARMONICS, partial(fourier, of="phi2")),
        "harmonics of a formula of the ratio": (TERMS, partial(terms, of="ratio")),
        "harmonics of a formula of the radius": (TERMS, partial(terms, of="r1")),
    }
    made += [
        Series(name, counts, lambda n, law=law: pair(40, law(n)), MESH)
        for name, (counts, law) in sizes.items()
    ]
    return made


def _of_cams() -> list[Series]:
    made = [
        Series(f"points, {name}", TOLERANCES, partial(cam, name), by_points=True)
        for name in FOLLOWERS
    ]
    for name, (follower, form) in FOLLOWERS.items():
        if "yoke" in form:
            continue
        lift = "lift_deg = 0.001" if "oscillating" in follower else "lift_mm = 0.001"
        span = "travel_mm" if "translating" in form else "angle_deg"
        told = partial(phases, lift=lift, span=span)
        made.append(Series(f"phases, {name}", KNOTS, partial(_moved, name, told)))
        if "oscillating" not in follower and "translating" not in form:
            made.append(Series(f"rows, {name}", LIFTS, partial(_moved, name, lift_rows)))
    smoothed = partial(lift_rows, smoothing="smoothing_tolerance_mm = 0.006")
    made.append(Series("smoothed rows", LIFTS, partial(_moved, "roller", smoothed)))
    made.append(
        Series("harmonics of a formula of the lift", TERMS, partial(_moved, "roller", lift_terms))
    )
    return made


def _moved(name: str, motion: Callable[[int], str], count: int) -> str:
    return cam(name, motion=motion(count))


def _of_files() -> list[Series]:
    coarse = partial(pair, law=of_type("ellipse"), tolerance=1e-2)
    finer = partial(pair, 12, of_type("constant"))
    made = [
        Series("teeth, files", FEWER, coarse, files(*FILES)),
        Series(
            "points of wheels, files", TOLERANCES, lambda t: finer(tolerance=t), files(*FILES), True
        ),
        Series("step of wheels, teeth", (12, 60, 240), coarse, files("step")),
    ]
    for name in ("roller", "groove", "yoke", "conjugate", "translating"):
        text = partial(cam, name, output="" if name == "groove" else TOOL)
        made.append(Series(f"points, files of {name}", TOLERANCES, text, files(*CAM_FILES), True))
    made.append(
        Series("step of cams, points", TOLERANCES, partial(cam, "roller"), files("step"), True)
    )
    return made
