"""Flanks by closed form and boolean sweep, and outlines as lines, arcs and splines."""

from __future__ import annotations

from typing import Any

import mpmath
import numpy as np

import gearcam
from gearcam.numeric.contour import polygon_area
from methods import Case, Method
from witness import laws, sweep
from witness.kinematics import Basic, Rolling

mp: Any = mpmath.mp
TEETH, MODULE, ALPHA = 40, 2.0, "20"
CIRCULAR = f"""
kind = "gear-pair"
name = "circular"
law = {{ type = "constant" }}
pair = {{ module_mm = {MODULE}, teeth = [{TEETH}, {TEETH}] }}
output = {{ files = ["csv"] }}
"""
ELLIPSE = """
kind = "gear-pair"
name = "ellipse"
law = {{ type = "ellipse", eccentricity = 0.3 }}
pair = {{ module_mm = 2, teeth = [41, 41] }}
output = {{ files = ["dxf"], chord_tolerance_mm = {tolerance}, dxf_curves = "{curves}" }}
"""
TOLERANCES = (1e-2, 3e-3, 1e-3, 3e-4, 1e-4)


def involute_miss(points: Any) -> Any:
    """Return the distances of points from the involute of tooth 1, mm: base radius times angle.

    Involutes of one base circle are parallel curves, so that this is the distance.
    """
    with mp.workdps(50):
        alpha = mp.radians(mp.mpf(ALPHA))
        base = mp.mpf(MODULE) * TEETH / 2 * mp.cos(alpha)
        half = mp.pi / (2 * TEETH) + mp.tan(alpha) - alpha
        missed = []
        for z in np.asarray(points).ravel().tolist():
            x, y = mp.mpf(z.real), mp.mpf(z.imag)
            roll = mp.sqrt((x * x + y * y) / base**2 - 1)
            missed.append(float(base * (abs(mp.atan2(y, x)) - half + roll - mp.atan(roll))))
    return np.abs(missed)


def flanks() -> Case:
    """Return the case of the flanks of a circular wheel, which are involutes."""
    result = gearcam.build(gearcam.loads(CIRCULAR))
    gear = result.gear1
    rolling = Rolling(laws.constant(1.0), float(result.pair.center_distance))
    basic = Basic(MODULE)

    def closed(count: float) -> Any:
        return gear.flank_points(int(count))

    def of_first(made: Any, count: int) -> Any:
        return (made["x_mm"] + 1j * made["y_mm"])[: 2 * count].reshape(2, count)

    def points_off(made: Any) -> float:
        return float(involute_miss(of_first(made, int(made["point"].max()))).max())

    def chords_off(made: Any) -> float:
        seen = of_first(made, int(made["point"].max()))
        return float(involute_miss(0.5 * (seen[:, 1:] + seen[:, :-1])).max())

    true = of_first(closed(129), 129)[0]  # of tooth 1, on the side of its space
    pairs = np.column_stack([true.real, true.imag])
    assert involute_miss(true).max() < 1e-12

    def swept(steps: float) -> Any:
        return sweep.cut_space(rolling, 1, 1, basic, int(steps))

    name = "closed form"
    return Case(
        name="flanks",
        title="Flanks of a circular wheel",
        what="flanks",
        unit="mm",
        methods=[
            Method(f"{name}, the points", "points", (3, 9, 17, 65), closed, error=points_off),
            Method(
                f"{name}, chords between", "points", (3, 5, 9, 17, 33, 65, 129), closed, 2.0,
                error=chords_off,
            ),
            Method("boolean sweep", "positions per turn", (250, 500, 1000, 2000, 4000), swept, 2.0),
        ],
        own=name,
        error=lambda cut: sweep.farthest(pairs, cut),
        rounding=1e-13,
        note=f"{TEETH} teeth, module {MODULE:g} mm, against the involute in 50 digits. The closed "
        f"form computes all {2 * TEETH} flanks of the wheel, the sweep one tooth space.",
    )  # fmt: skip


def built(tolerance: float, curves: str = "lines") -> Any:
    """Return the result of the ellipses for a chord tolerance, mm."""
    text = ELLIPSE.format(tolerance=f"{tolerance:.9f}", curves=curves)
    return gearcam.build(gearcam.loads(text))


def outlines() -> Case:
    """Return the case of outlines as files."""

    def dxf(curves: str) -> Any:
        def make(tolerance: float) -> tuple[int, float]:
            measured: dict[str, Any] = {}
            files = built(tolerance, curves).files("dxf", measured)
            return sum(map(len, files.values())), max(measured["dxf"]["error_mm"].values())

        return make

    files = [
        Method(
            f"DXF of {curves}", "chord tolerance, mm", TOLERANCES, dxf(curves), -1.0,
            size=lambda made: float(made[0]),
        )
        for curves in ("lines", "arcs", "splines")
    ]  # fmt: skip
    return Case(
        name="outline_size",
        title="Outlines as files",
        what="the curve, in both directions",
        unit="mm",
        methods=files,
        own="DXF of arcs",
        error=lambda made: made[1],
        rounding=1e-9,
        note="Both wheels of an ellipse of eccentricity 0.3, module 2 mm, 41 teeth: the files "
        "are read back and compared with the curve. Orders are in the tolerance.",
        cost="bytes",
    )


def areas() -> Case:
    """Return the case of the area inside the outline of the driver."""

    def area(tolerance: float) -> float:
        return float(polygon_area(built(tolerance).gear1.profile.points))

    def cubics(tolerance: float) -> float:
        return float(built(tolerance).gear1.profile.contour.moments.area)

    # Richardson extrapolation with order 1 in the tolerance
    coarse, fine = area(4e-6), area(1e-6)
    limit = fine + (fine - coarse) / 3.0
    return Case(
        name="outline_area",
        title="Area inside an outline",
        what="the area",
        unit="mm2",
        methods=[
            Method("polygon", "chord tolerance, mm", TOLERANCES, area, -1.0),
            Method("cubics", "chord tolerance, mm", TOLERANCES, cubics),
        ],
        own="cubics",
        error=lambda made: abs(made - limit),
        rounding=3e-6,
        note="The driver of the same pair, built from the design, against the limit of polygons by "
        "Richardson extrapolation from tolerances of 4 and 1 nm, which is accurate to 3e-6 mm2. "
        "The cubics interpolate dense points and tangents of the curve.",
    )


def cases() -> list[Case]:
    """Return all cases."""
    return [flanks(), outlines(), areas()]
