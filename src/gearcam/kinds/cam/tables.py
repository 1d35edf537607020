"""The tables of a cam beside motion, follower and size: blank, output, settings of studies."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Final, Literal

from gearcam.base.display import ShortRepr
from gearcam.base.quantities import (
    ANGLE,
    COUNT,
    FINEST,
    LEAST_ALLOWANCE,
    LENGTH,
    LONGEST,
    NUMBER,
    STIFFNESS,
    STIFFNESS_PER_RAD,
    TEXT,
    Param,
    Quantity,
    allowance,
    fixed,
    param,
    params_of,
    positive_length,
)
from gearcam.base.rules import Breach, needs
from gearcam.designs.outputs import FORMATS, OutputSpec, files_param, pose_param, studies_param
from gearcam.dynamics.integrate import METHODS
from gearcam.parts.blank import OPENING_RULES, ZERO_MARK, WheelBlank, widening_rules

NAME: Final = "cam"
"""As in a file."""

_HERE: Final = "gearcam.kinds.cam"

CAM_FORMATS: Final = (*FORMATS, "tool-path", "curvature", "caliper", "grinding")
"""What ``output.files`` of a cam may list."""


@dataclass(frozen=True, kw_only=True)
class CamBlank(WheelBlank):
    """Bore, hub, holes, marks and material of a cam.

    Attributes
    ----------
    stop_pin, timing_marks, mark_diameter, tip_rounding
        A cam has none.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.CamBlank(bore_diameter=16.0, density=7850.0)
    CamBlank(bore_diameter=16, density=7850)
    """

    clearance: float = allowance(doc="what is taken off the profile, along its normal")
    clearance_bores: bool = param(
        TEXT, default=False, doc="whether bore and bolt holes are widened by the clearance too"
    )

    zero_mark: bool = param(TEXT, default=False, doc=ZERO_MARK)
    stop_pin: float = fixed(0.0)
    timing_marks: bool = fixed(False)
    mark_diameter: float | None = fixed(None)
    tip_rounding: float = fixed(0.0)

    rules = (*OPENING_RULES, *widening_rules("bore_diameter", "shaft", "bolts"))


@dataclass(frozen=True, kw_only=True)
class FollowSpec(ShortRepr):
    """A given profile, of which the study ``follow`` computes the follower's motion.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.FollowSpec(file="measured.csv", wall="outer")
    FollowSpec(file='measured.csv', wall='outer')
    """

    file: str | None = param(
        TEXT,
        default=None,
        doc="cam profile: DXF with one closed outline, or CSV with columns x_mm and y_mm",
        example="measured.csv",
    )
    wall: str | None = param(
        TEXT,
        default=None,
        choices=("1", "2", "inner", "outer", "lower", "upper"),
        doc="wall to follow: 1 or 2 (conjugate cams); inner, outer, lower or upper (groove); the "
        "first if left out",
        example="outer",
    )
    fit: bool = param(
        default=False,
        doc="whether to find the phases, motion laws and sizes that make this motion; the file may "
        "then be a CSV of the lift, with columns theta_deg and lift_mm or lift_deg",
    )


def _tolerance(quantity: Quantity = LENGTH, *, doc: str) -> Any:
    """Return a tolerance to either side; 0: the size is exact."""
    return param(quantity, default=0.0, ge=0, le=100 if quantity is LENGTH else 90, doc=doc)


Hertz = Literal["hertz"]

Flat = Literal["flat"]

_DAMPED: Final = 0.06
"""Damping ratio of springs of metal with joints: 0.03 to 0.1, as a rule."""


@dataclass(frozen=True, kw_only=True)
class FollowerDynamicsSpec(ShortRepr):
    """The elasticity of a follower, and how its motion is integrated.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.FollowerDynamicsSpec(stiffness=2000.0, turns=5)
    FollowerDynamicsSpec(stiffness=2000, turns=5)
    """

    stiffness: float | None = param(
        STIFFNESS,
        default=None,
        gt=0,
        le=1e9,
        example=2000,
        doc="stiffness of the train between cam and mass, along the lift; rigid if left out",
    )
    torsion: float | None = param(
        STIFFNESS_PER_RAD,
        default=None,
        gt=0,
        le=1e9,
        word="stiffness",
        example=5000,
        doc="the same of an oscillating follower, about its pivot",
    )
    contact_stiffness: float | Hertz | None = param(
        STIFFNESS,
        default=None,
        gt=0,
        le=1e9,
        example=20000,
        doc="stiffness of the contact along its normal; hertz: of a line contact under the mean "
        "force; rigid if left out",
    )
    damping_ratio: tuple[float, float] = param(
        NUMBER,
        default=(_DAMPED, _DAMPED),
        ge=0.002,
        le=0.9,
        both=True,
        order="train and contact",
        doc="damping of train and contact, over that at which the mass behind it alone would not "
        "swing",
    )
    turns: int = param(
        COUNT,
        default=20,
        ge=1,
        le=10000,
        doc="largest number of turns until one repeats the one before",
    )
    method: str = param(
        TEXT,
        default="auto",
        choices=METHODS,
        doc="integrator; auto: dop853 up to 300 natural periods in a turn, else radau",
    )
    tolerance: float = param(
        NUMBER, default=1e-6, ge=1e-12, le=1e-3, doc="relative tolerance of a step"
    )

    rules = tuple(
        needs(name, "stiffness", "torsion", "contact_stiffness", one=True)
        for name in ("damping_ratio", "turns", "method", "tolerance")
    )

    @property
    def train(self) -> float | None:
        """Stiffness of the train, N/mm or N mm/rad; None if it is rigid."""
        return self.torsion if self.stiffness is None else self.stiffness

    @property
    def elastic(self) -> bool:
        """Whether anything is elastic."""
        return self.train is not None or self.contact_stiffness is not None

    def allowed_on(self, *, oscillating: bool) -> Iterator[Breach]:
        """Yield keys that do not suit the follower."""
        wrong, right = "torsion", "stiffness_n_mm"
        if oscillating:
            wrong, right = "stiffness", "stiffness_nm_rad"
        if getattr(self, wrong) is not None:
            what = "an oscillating" if oscillating else "a translating"
            yield wrong, None, f"does not suit {what} follower", right

    @staticmethod
    def train_key(*, oscillating: bool) -> str:
        """Return the key of the stiffness of the train."""
        return "dynamics.stiffness_nm_rad" if oscillating else "dynamics.stiffness_n_mm"


def _wanted(quantity: Quantity, *, word: str = "", example: float, doc: str) -> Any:
    """Return the largest deviation that is wanted, if there is one."""
    bounds = {"ge": LEAST_ALLOWANCE, "le": 100}
    return param(quantity, default=None, word=word, example=example, doc=doc, **bounds)


@dataclass(frozen=True, kw_only=True)
class PrecisionSpec(ShortRepr):
    """Tolerances of the sizes of a cam and its follower, and the error of the lift that is wanted.

    Tolerances are to either side of the size in the design; those of a roller or an arm hold for
    both of conjugate cams.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.PrecisionSpec(profile_tolerance=0.02, offset_tolerance=0.05, lift_error=0.1).tolerances
    {'profile': 0.02, 'offset': 0.05}
    """

    profile_tolerance: float = _tolerance(doc="of the profile along its normal, to either side")
    radius_tolerance: float = _tolerance(doc="of the radius of a roller or a dome")
    offset_tolerance: float = _tolerance(doc="of the place of the guide, across it")
    axis_tolerance: float = _tolerance(
        ANGLE,
        doc="of the direction of the guide: turned about the cam's axis, or over a translating cam "
        "about the roller's centre at zero lift",
    )
    face_angle_tolerance: float = _tolerance(
        ANGLE, doc="of the squareness of a face to its stem, turned about the stem"
    )
    arm_tolerance: float = _tolerance(doc="of the length of the arm")
    pivot_distance_tolerance: float = _tolerance(doc="of the distance of the pivot")
    pivot_height_tolerance: float = _tolerance(doc="of the place of the pivot across that distance")
    face_offset_tolerance: float = _tolerance(doc="of the offset of a face from its pivot")
    roller_distance_tolerance: float = _tolerance(doc="of the distance of the rollers")
    arms_angle_tolerance: float = _tolerance(ANGLE, doc="of the angle between the arms")
    cam_angle_tolerance: float = _tolerance(ANGLE, doc="of the cam's angle on its shaft")
    travel_tolerance: float = _tolerance(doc="of the place of a translating cam along its travel")
    lift_error: float | None = _wanted(
        LENGTH, example=0.1, doc="largest deviation of the lift that is wanted"
    )
    swing_error: float | None = _wanted(
        ANGLE, word="lift_error", example=0.1, doc="the same of an oscillating follower"
    )
    combined: str = param(
        TEXT,
        default="worst-case",
        choices=("worst-case", "root-of-squares"),
        doc="how errors of several sizes add up where they must keep the wanted one",
    )

    rules = (needs("combined", "lift_error", "swing_error", one=True),)

    @property
    def tolerances(self) -> dict[str, float]:
        """The tolerances above 0, mm or rad, by the names of their sizes."""
        every = {size: getattr(self, f"{size}_tolerance") for size in SIZES}
        return {size: tolerance for size, tolerance in every.items() if tolerance}

    @property
    def wanted(self) -> float | None:
        """The wanted error, mm or rad."""
        return self.lift_error or self.swing_error


SIZES: Final[Mapping[str, Param]] = {
    name.removesuffix("_tolerance"): param
    for name, param in params_of(PrecisionSpec).items()
    if name.endswith("_tolerance")
}
"""The sizes that may have tolerances, with the quantities of these."""


@dataclass(frozen=True, kw_only=True)
class CamOutputSpec(OutputSpec):
    """Which files and studies of a cam are written, and how exact (see `OutputSpec`).

    Parameters
    ----------
    pose : float, rad
        Cam angle of the assembly drawing.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.CamOutputSpec(files=("dxf", "tool-path"), tool_radius=4.0)
    CamOutputSpec(files=('dxf', 'tool-path'), tool_radius=4)
    """

    files: tuple[str, ...] = files_param(CAM_FORMATS, NAME)
    studies: tuple[str, ...] = studies_param(NAME)
    chord_tolerance: float | None = param(
        LENGTH,
        default=None,
        ge=FINEST,
        le=1,
        example=0.001,
        doc="largest distance of an outline from the true curve; 0.001 mm if left out",
    )
    pose: float = pose_param("theta", "cam angle of the assembly drawing")
    motion_step: float = param(
        ANGLE, default=math.radians(1), gt=0, le=90, doc="step of the cam angle in motion.csv"
    )
    inspection_points: int = param(
        COUNT,
        default=360,
        ge=8,
        le=100000,
        doc="number of points in inspection.csv, at equal steps of the cam angle",
    )
    tool_radius: float | None = positive_length(
        example=8,
        doc="radius of the cutter of the tool path; the follower's, or half a groove, if left out",
    )
    caliper_step: float = param(
        ANGLE, default=math.radians(1), ge=0.01, le=90, doc="step of the polar angle in caliper.csv"
    )
    grinding_wheel_radius: float | Flat | None = param(
        LENGTH,
        default=None,
        gt=0,
        le=LONGEST,
        example=50,
        doc="radius of the grinding wheel of grinding.csv; flat: of a flat one; the follower's, or "
        "half a groove, if left out",
    )


def _range(*, doc: str) -> Any:
    """Return the range of a size that is solved for."""
    return param(LENGTH, default=None, ge=-LONGEST, le=LONGEST, example=[20, 60], doc=doc)


@dataclass(frozen=True, kw_only=True)
class BoundsSpec(ShortRepr):
    """Ranges within which sizes are found whose value is "solve": least, largest; both may be one.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.BoundsSpec(offset=(0.0, 10.0))
    BoundsSpec(offset=(0, 10))
    """

    prime_radius: tuple[float, float] | None = _range(doc="range of cam.prime_radius_mm")
    base_radius: tuple[float, float] | None = _range(doc="range of cam.base_radius_mm")
    offset: tuple[float, float] | None = _range(doc="range of follower.offset_mm")
    pivot_distance: tuple[float, float] | None = _range(doc="range of follower.pivot_distance_mm")
    arm: tuple[float, float] | None = _range(doc="range of follower.arm_mm")
    roller_radius: tuple[float, float] | None = _range(doc="range of follower.roller_radius_mm")

    def problems(self) -> Iterator[Breach]:
        """Yield ranges that are empty."""
        for name, pair in vars(self).items():
            if pair is not None and not pair[0] <= pair[1]:
                yield name, None, "is an empty range", "the least value, then the largest"


GOALS: Final = {
    "cam.profile.radius_mm.max": "largest radius of the profile",
    "cam.pressure_angle_deg.max": "largest pressure angle",
    "cam.pressure_angle_deg.rise_max": "largest pressure angle of the rises",
    "cam.pressure_angle_deg.return_max": "largest pressure angle of the returns",
    "cam.curvature.profile_convex_min_mm": "least convex radius of the profile",
}
"""What a cam whose sizes are solved for may have least or most of."""
