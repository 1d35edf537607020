"""Settings of the meshing study in a design."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Final

from gearcam.base.display import ShortRepr
from gearcam.base.quantities import ANGLE, COUNT, LENGTH, TEXT, param, positive_length
from gearcam.base.rules import Breach, above, distinct, excluded
from gearcam.laws.columns import ColumnsError, FromFile

_TILTS: Final = "in the plane of the axes and across it"
"""What both tilts are called."""

KIND = "meshing"
"""Registered checks of a study."""

ERRORS = "errors"
"""Registered checks of a study of errors."""

TRIALS = "random assemblies of a pair"
"""Registered checks of the random assemblies of a study of errors."""

FORCES = "forces of a pair"
"""Registered checks of a study of forces."""

DYNAMIC_FORCES = "forces of a pair in motion"
"""Registered checks of the forces of the teeth in a study of dynamics."""

STRESS = "stress of a pair"
"""Registered checks of a study of stress."""


@dataclass(frozen=True, kw_only=True)
class MeshingSpec(ShortRepr):
    """Phases of the driver, overclosure, and mounted centre distance.

    The phases divide the range from `start` to `end` into `steps` equal parts, without its end;
    open wheels and racks are studied at both ends. The default `end` is a turn of the driver, or
    the travel of open wheels and racks. At each phase the driver is turned ahead by `overclosure`;
    a negative one holds it back, so that the coast flanks touch. With `teeth` only the phases in
    which these teeth of the driver are near the pitch point are studied. By default the wheels are
    mounted at the design centre distance; a larger `center_distance` gives backlash, but presses a
    wheel into its ring.

    Examples
    --------
    >>> import gearcam as gc
    >>> design = gc.load("profiles/ellipse.toml").with_({"meshing.steps": 72})
    >>> design.meshing == gc.MeshingSpec(steps=72)
    True
    """

    steps: int = param(COUNT, default=360, ge=1, le=1000000, doc="number of phases, evenly spaced")
    start: float = param(
        ANGLE, default=0.0, ge=-36000, le=36000, word="from", doc="driver angle of the first phase"
    )
    end: float | None = param(
        ANGLE,
        default=None,
        ge=-36000,
        le=36000,
        word="to",
        example=8,
        doc="driver angle at the end of the study; by default a turn, or the end of travel",
    )
    overclosure: float = param(
        ANGLE,
        default=math.radians(0.005),
        ge=-1,
        le=1,
        doc="how far the driver is turned ahead (or back), so that flanks overlap; not 0",
    )
    teeth: tuple[int, ...] | None = param(
        COUNT,
        default=None,
        ge=1,
        min_length=1,
        example=[1, 2],
        doc="tooth numbers of the driver to study; all by default",
    )
    step: int = param(
        COUNT, default=1, ge=1, le=100, doc="step of stepped gears to study, counted from below"
    )
    center_distance: float | None = positive_length(
        example=80.1, doc="centre distance as mounted, not for racks; as designed by default"
    )
    solids: bool = param(
        default=False, doc="whether to intersect the wheels' solids too; on tilted axes always"
    )

    rules = (
        above("end", "start", why="the study would end before it begins, at {}"),
        excluded(
            "overclosure",
            0,
            why="unless the driver is turned ahead no flanks overlap: no contact is found",
            allowed="-1 to 1, but not 0; 0.005 is usual",
        ),
        distinct("teeth", "tooth"),
    )


_TRIALS: Final = 100
"""Number of random assemblies unless given."""

_PERCENTILES: Final = (50.0, 90.0, 99.0)
"""Percentages unless given."""

_PITCH_COLUMNS: Final = ("wheel", "tooth", "pitch_mm")
"""Columns of a file of pitch errors."""


@dataclass(frozen=True, kw_only=True)
class ErrorsSpec(FromFile):
    """Errors of mounting and making, and tolerances for random assemblies.

    Errors have the values given; a tolerance adds a random error to them in each of the `trials`.
    A uniform error lies anywhere within its tolerance; of a normal one the tolerance is three times
    the standard deviation. The size of a random
    eccentricity is that of such an error, in any direction. A tooth with a
    positive error of pitch is moved along the pitch curve, towards the next number.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.ErrorsSpec(center=0.02, eccentricity=(0.05, 0.0))
    ErrorsSpec(center=0.02, eccentricity=(0.05, 0))
    """

    center: float = param(LENGTH, default=0.0, ge=-100, le=100, doc="added to the centre distance")
    eccentricity: tuple[float, float] = param(
        LENGTH,
        default=(0.0, 0.0),
        ge=0,
        le=100,
        both=True,
        doc="distance of the teeth's middle from the shaft",
    )
    eccentricity_angle: tuple[float, float] = param(
        ANGLE,
        default=(0.0, 0.0),
        ge=-360,
        le=360,
        both=True,
        word="eccentricity",
        doc="its direction, in the wheel's own coordinates",
    )
    tilt: tuple[float, float] = param(
        ANGLE,
        default=(0.0, 0.0),
        ge=-10,
        le=10,
        order=_TILTS,
        doc="tilt of the driver's axis in the plane of the axes, and across it",
    )
    file: str | None = param(
        TEXT,
        default=None,
        example="pitch.csv",
        doc="CSV file of errors of pitch: columns wheel, tooth, pitch_mm (towards the next number)",
    )
    outline1: str | None = param(
        TEXT,
        default=None,
        example="measured.csv",
        doc="DXF or CSV file (columns x_mm, y_mm) of an outline of wheel 1 that was measured",
    )
    outline2: str | None = param(
        TEXT, default=None, example="measured.csv", doc="the same of wheel 2"
    )
    center_tolerance: float = param(
        LENGTH, default=0.0, ge=0, le=100, doc="tolerance of the centre distance"
    )
    eccentricity_tolerance: tuple[float, float] = param(
        LENGTH, default=(0.0, 0.0), ge=0, le=100, both=True, doc="tolerance of the eccentricity"
    )
    tilt_tolerance: tuple[float, float] = param(
        ANGLE, default=(0.0, 0.0), ge=0, le=10, order=_TILTS, doc="tolerance of both tilts"
    )
    pitch_tolerance: float = param(
        LENGTH, default=0.0, ge=0, le=100, doc="tolerance of the place of each tooth of both wheels"
    )
    distribution: str = param(
        TEXT, default="uniform", choices=("uniform", "normal"), doc="of random errors"
    )
    trials: int | None = param(
        COUNT,
        default=None,
        ge=0,
        le=100000,
        example=500,
        doc="number of random assemblies; 100 by default if there are tolerances",
    )
    seed: int = param(
        COUNT, default=1, ge=0, le=1000000, doc="of the random numbers: the same gives the same"
    )
    percentiles: tuple[float, ...] = param(
        default=_PERCENTILES,
        gt=0,
        le=100,
        min_length=1,
        doc="percentiles of the transmission error of random assemblies, in percent",
    )
    steps: int = param(
        COUNT, default=360, ge=8, le=100000, doc="number of phases in a turn of the driver"
    )

    rules = (distinct("percentiles", "percentage"),)

    @property
    def assemblies(self) -> int:
        """Number of random assemblies."""
        if self.trials is None:
            return _TRIALS if any(self.tolerances) else 0
        return self.trials

    @property
    def tolerances(self) -> tuple[float, ...]:
        """All tolerances."""
        return (
            self.center_tolerance,
            *self.eccentricity_tolerance,
            *self.tilt_tolerance,
            self.pitch_tolerance,
        )

    @property
    def alike(self) -> bool:
        """Whether the tolerances keep wheel 2's teeth alike."""
        return not (self.eccentricity_tolerance[1] or self.pitch_tolerance)

    @cached_property
    def pitch_errors(self) -> tuple[Mapping[int, float], Mapping[int, float]]:
        """Errors of pitch of both wheels, mm, by tooth; raises `ColumnsError` (see `FromFile`)."""
        errors: tuple[dict[int, float], dict[int, float]] = {}, {}
        if self.rows is not None:
            table, lines = self.rows.columns(_PITCH_COLUMNS)
            for (wheel, tooth, error), line in zip(table.tolist(), lines, strict=True):
                if wheel not in (1, 2) or tooth != int(tooth):
                    raise ColumnsError(f"line {line}: no tooth {tooth:g} of a wheel {wheel:g}")
                if int(tooth) in errors[int(wheel) - 1]:
                    raise ColumnsError(f"line {line}: a second error of tooth {tooth:g}")
                errors[int(wheel) - 1][int(tooth)] = error
        return errors

    def problems(self) -> Iterator[Breach]:
        """Yield the faults of a file that cannot be read, and of trials without tolerances."""
        if not any(self.tolerances):
            usual = {
                "trials": None,
                "seed": 1,
                "distribution": "uniform",
                "percentiles": _PERCENTILES,
            }
            for name in (name for name, one in usual.items() if getattr(self, name) != one):
                yield name, None, "needs a tolerance", "with center_tolerance_mm, for example"
        for wheel, one in enumerate(self.eccentricity_angle):
            alike = len({*self.eccentricity_angle}) == 1 and any(self.eccentricity)
            if one and not self.eccentricity[wheel] and not alike:
                rule = "with eccentricity_mm of this wheel"
                yield "eccentricity_angle", wheel, "is the direction of no eccentricity", rule
        try:
            _ = self.pitch_errors
        except ColumnsError as error:
            yield "file", None, str(error), f"a CSV file with {', '.join(_PITCH_COLUMNS)}"
