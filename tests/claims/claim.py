"""What a law must give for an example, known in closed form and independently of the code."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any, Protocol

from gearcam.base.tolerances import Tolerances
from gearcam.laws.motion.base import MotionLawParameters
from gearcam.laws.ratio.base import RatioLaw
from gearcam.laws.ratio.span import ONE_LOBE, RING, WHEEL, Lobes
from random_designs.draw import Draw
from random_designs.law_draw import Counts, Law, LawDraw
from witness.exact import Exact

RING_TEETH = (30, 90)
"""Teeth of a wheel and a ring."""


class LawParameters(Protocol):
    """What the parameters of a law can do."""

    def build(self, lobes: Lobes, tolerances: Tolerances) -> RatioLaw:
        """Return the law for `lobes`, to `tolerances`, or raise `InfeasibleError`."""
        ...


@dataclass(frozen=True, kw_only=True)
class LawClaim:
    """Values of a ratio law.

    Parameters
    ----------
    parameters : LawParameters
        The example.
    lobes : Lobes
        Its lobes.
    ratio : mapping of float to float
        i21 by driver angle, rad.
    driven : mapping of float to float
        phi2, rad, by driver angle, rad.
    continuity : int
        Least order of continuity over all knots (3 means at least 3).
    """

    parameters: LawParameters
    lobes: Lobes = ONE_LOBE
    ratio: Mapping[float, float]
    driven: Mapping[float, float]
    continuity: int


@dataclass(frozen=True, eq=False)
class ExactCase:
    """A pair whose law is known in 30 digits, its mathematics written anew (see `witness.exact`).

    Parameters
    ----------
    law : LawParameters
        As designs have them; every double is taken as it is.
    teeth : (int, int)
        Tooth counts.
    exact : callable
        ``exact(law)`` returns what it is; the built law gives places to begin with.
    mate : {WHEEL, RACK, RING}
        Type of the mate.
    """

    law: LawParameters
    teeth: tuple[int, int]
    exact: Callable[[Any], Exact]
    mate: int = WHEEL

    @property
    def lobes(self) -> Lobes:
        """Lobes of the tooth counts."""
        common = math.gcd(*self.teeth)
        mate = RING if self.mate == RING else WHEEL
        return Lobes(self.teeth[0] // common, self.teeth[1] // common, mate)


@dataclass(frozen=True, kw_only=True)
class LawClaims:
    """All that is claimed of a ratio law, and how random ones are drawn.

    Parameters
    ----------
    values : tuple of LawClaim
        Examples with their values; one with a ring as mate at least, unless the mate is a rack.
    ratio : callable or None
        The mathematics of the law once more: ``ratio(parameters, lobes, x, m)`` returns the ratio
        at driver angles x by functions of ``m``, which is numpy or `witness.exact`. None if
        `cases` has it.
    cases : callable
        Returns more pairs with their law in 30 digits, for the honesty of estimated errors: closed
        and open, wheels, rings and racks, and the extremes of the law. Those of `values` are among
        them if there is a `ratio`.
    usual : mapping of str to (float, float)
        Ranges of parameters, in the units of files, within which most random ones can be built.
        Others are drawn from their lower bound to the value in the law's example.
    draw : callable or None
        ``draw(d)`` returns the table of a random law and tooth counts, if ranges do not say it.
    """

    values: tuple[LawClaim, ...]
    ratio: Callable[[Any, Lobes, Any, Any], Any] | None = None
    cases: Callable[[], Iterable[ExactCase]] = tuple
    usual: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    draw: Callable[[LawDraw], tuple[Law, Counts]] | None = None


@dataclass(frozen=True, kw_only=True)
class MotionClaim:
    """Values of a motion law.

    Parameters
    ----------
    parameters : MotionLawParameters
        The example.
    values, velocities : mapping of float to float
        S and S' by phi.
    peak_velocity, peak_acceleration, peak_jerk : float
        Largest absolute values; infinite where a derivative below jumps.
    continuity : int
        Order of continuity between dwells (3 means at least 3).
    mirrored : bool
        Whether a return is the rise run backwards.
    """

    parameters: MotionLawParameters
    values: Mapping[float, float]
    velocities: Mapping[float, float] = field(default_factory=dict)
    peak_velocity: float
    peak_acceleration: float
    peak_jerk: float
    continuity: int
    mirrored: bool = False


@dataclass(frozen=True, kw_only=True)
class MotionClaims:
    """All that is claimed of a motion law, and how random ones are drawn.

    Parameters
    ----------
    values : tuple of MotionClaim
        Examples with their values.
    usual, draw :
        As for `LawClaims`; ``draw(d)`` returns the parameters in the units of files.
    """

    values: tuple[MotionClaim, ...]
    usual: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    draw: Callable[[Draw], Law] | None = None
