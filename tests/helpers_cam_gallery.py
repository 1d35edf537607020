"""Numbers that the cams of the gallery must show: closed forms, and roots by mpmath."""

from __future__ import annotations

import math
from typing import Any, Final

import mpmath

from helpers_gallery import Number

mp: Any = mpmath
DEG = math.degrees(1.0)


def _undercut() -> tuple[float, float, float]:
    """Largest pressure angle, and both ends of the undercut, of 10 mm cycloidal in 40 deg, deg."""
    with mp.workdps(30):
        width = mp.radians(40)

        def lift(t: Any) -> Any:
            return 10 * (t / width - mp.sin(2 * mp.pi * t / width) / (2 * mp.pi))

        def alpha(t: Any) -> Any:
            return mp.atan(mp.diff(lift, t) / (30 + lift(t)))

        def room(t: Any) -> Any:
            """Radius of curvature of the pitch curve, polar form, less the roller's."""
            r, dr, ddr = 30 + lift(t), mp.diff(lift, t), mp.diff(lift, t, 2)
            return (r * r + dr * dr) ** mp.mpf(1.5) / (r * r + 2 * dr * dr - r * ddr) - 14

        peak = mp.findroot(lambda t: mp.diff(alpha, t), mp.radians(19))
        ends = [mp.findroot(room, mp.radians(guess)) for guess in (25.5, 36)]
        return tuple(float(mp.degrees(value)) for value in (alpha(peak), *ends))  # type: ignore[return-value]


def _scca_speed(b: float, c: float, d: float) -> float:
    """Peak velocity of the SCCA family on the unit square."""
    pi = math.pi
    peak = 4 * pi**2 / ((pi**2 - 8) * (b**2 - d**2) - 2 * pi * (pi - 2) * b + pi**2)
    return peak * ((b + d) / pi + c / 2)


READ: Final = math.radians(110)
"""Angle of the rise of 12 mm, 4-5-6-7, that is read with up to 4 um of noise."""

WORST, FIRST, LAST = _undercut()
HIGHEST = math.hypot(10, math.sqrt(60**2 - 10**2) + 27.6) - 8

CAM_NUMBERS: dict[str, dict[str, Number]] = {
    "plate_cam_offset_roller": {
        "cam.pressure_angle_deg.rise_max": (15.466010, 5e-7),
        "cam.pressure_angle_deg.rise.max": (7.969733, 5e-7),
        "cam.pressure_angle_deg.return.min": (-31.810726, 5e-7),
        "cam.pressure_angle_deg.return.max": (-11.617196, 5e-7),
        "cam.curvature.pitch_rise_min_mm": (22.670419, 5e-7),
        "motion.peak_velocity": (2 * 10 / (math.pi / 2), 1e-12),
    },
    "groove_cam": {
        # the walls are parallels of a pitch curve of 221.58887350723 mm, 12.05 mm apart
        "cam.groove.inner.perimeter_mm": (221.58887350723 - math.pi * 12.05, 1e-10),
        "cam.groove.outer.perimeter_mm": (221.58887350723 + math.pi * 12.05, 1e-10),
        "cam.pressure_angle_deg.return_max": (31.810726, 5e-7),
        "cam.groove.inner.radius_mm.min": (30 - 6.025, 1e-12),
    },
    "yoke_cam": {
        # Barbier: pi times the breadth of 2*40 + 20
        "cam.profile.perimeter_mm": (math.pi * 100, 1e-12),
        "cam.breadth_mm": (100.0, 1e-12),
        "cam.face_width_mm": (2 * 2 * 20 / (2 * math.pi / 3), 1e-12),
        "cam.profile.area_mm2": (7795.0873093058, 1e-9),
    },
    "conjugate_cams": {
        # arms 90 and 85 at prime radii 40 and 38, a lift of 20 deg between them; 0.02 mm on an arm
        "cam.arms_angle_deg": (65.386022742032 - DEG * 0.02 / 85, 1e-10),
        "cam.cam2.profile.radius_mm.min": (38 - 8, 1e-12),
        "cam.cam2.pressure_angle_deg.return_max": (31.8045503326, 1e-9),
        "cam.pressure_angle_deg.rise_max": (33.5573097724, 1e-9),
    },
    "translating_cam": {
        # 3-4-5 over 60 mm and cycloidal over 40 mm, both 15 mm: 15/8 and 2 of the mean slope
        "cam.pressure_angle_deg.rise_max": (DEG * math.atan(15 / 8 * 15 / 60), 1e-11),
        "cam.pressure_angle_deg.return_max": (DEG * math.atan(2 * 15 / 40), 1e-11),
        "cam.groove.lower.curvature.profile_convex_min_mm": (19.64980578843 - 6.025, 1e-10),
        "cam.groove.lower.curvature.profile_concave_min_mm": (19.64980578843 + 6.025, 1e-10),
        "cam.way_mm": (170.0, 1e-12),
        "motion.peak_velocity": (0.75, 1e-12),
    },
    "plate_cam_oscillating": {
        "cam.start_angle_deg": (DEG * math.acos((100**2 + 90**2 - 40**2) / 18000), 1e-12),
        # modified sine has the lower peak acceleration, 3-4-5 the higher peak velocity
        "motion.peak_acceleration": (10 / math.sqrt(3) * 20 / (2 * math.pi / 3) ** 2, 1e-11),
        "motion.peak_velocity": (1.875 * 20 / (2 * math.pi / 3), 1e-12),
    },
    "flat_follower": {
        "cam.profile.perimeter_mm": (282.743338823, 5e-10),
        "cam.profile.area_mm2": (6328.539219167, 5e-10),
        "cam.contact_mm.max": (12.732395447, 5e-10),
        "cam.curvature.profile_min_mm": (23.573687214, 5e-10),
    },
    "eccentric_cam": {
        "cam.profile.perimeter_mm": (62 * math.pi, 1e-12),
        "cam.profile.area_mm2": (31**2 * math.pi, 1e-11),
        "cam.curvature.profile_min_mm": (31.0, 1e-12),
        "cam.contact_mm.max": (6.0, 1e-13),
    },
    "undercut_cam": {
        "cam.pressure_angle_deg.rise_max": (WORST, 1e-11),
        "cam.undercut[0][0]": (FIRST, 1e-10),
        "cam.undercut[0][1]": (LAST, 1e-10),
        "cam.undercut[1][0]": (180 - LAST, 1e-10),
        "cam.base_radius_mm": (16.0, 1e-14),
    },
    "lathe_slide": {
        "motion.peak_velocity": (2 * 27.6 / math.radians(105), 1e-12),
        "motion.lift.max": (27.6, 1e-13),
        "cam.profile.radius_mm.max": (HIGHEST, 1e-12),
        "cam.profile.radius_mm.min": (52.0, 1e-12),
    },
    "valve_lever": {
        "cam.start_angle_deg": (DEG * math.asin(51 / 70), 1e-12),
        "motion.peak_acceleration": (6 * 10 / math.radians(70) ** 2, 1e-11),
    },
    "measured_cam": {
        "motion.deviation": (0.0, 0.006),
        "motion.lift.max": (12.0, 0.006 + 0.004),
        "motion.lift.min": (0.0, 0.006 + 0.004),
        "motion.peak_velocity": (35 / 16 * 12 / READ, 0.03),
        "motion.peak_acceleration": (84 * math.sqrt(5) / 25 * 12 / READ**2, 0.3),
        "motion.peak_jerk": (52.5 * 12 / READ**3, 2.0),
    },
    "tappet": {
        "cam.base_radius_mm": (35.0, 1e-13),
        # 15, -24, 10 of the fourth to sixth power: 60*x^3*(1 - x)^2 is largest at 3/5
        "motion.peak_velocity": (
            max(
                2.0736 * 9 / math.radians(110),
                _scca_speed(0.25, 0.25, 0.5) * 9 / math.radians(100),
            ),
            1e-12,
        ),
    },
}
