"""Tolerances: one frozen object, passed explicitly, each field with its unit and its reason."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class Tolerances:
    """How exact the inner computations are; never the tolerance of a part.

    Parameters
    ----------
    expansion : float
        Relative truncation error allowed to a Chebyshev expansion of a piece. Near the rounding
        error of double precision: expansions are the root of every length and angle.
    refusal : float
        Largest miss of the driven angle over a lobe that is built at all, rad: 1e-6 rad is 0.2
        micrometres at 200 mm. Ratios typed with seven digits pass, with a finding (see the check
        ``closure``).
    oversampling : int
        Dense points per final chord of an outline; 8 makes the error of the dense polygon about
        1/64 of the chord error.

    Examples
    --------
    >>> import gearcam as gc
    >>> design = gc.load("profiles/ellipse.toml")
    >>> gc.build(design, gc.Tolerances(oversampling=16)).tolerances.oversampling
    16
    """

    expansion: float = 1e-15
    refusal: float = 1e-6
    oversampling: int = 8


DEFAULT = Tolerances()
