"""Tolerances of the internal computations, passed explicitly."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class Tolerances:
    """Tolerances of the internal computations, not of a part.

    Parameters
    ----------
    expansion : float
        Largest relative truncation error of Chebyshev expansions, near the rounding error of
        double precision, since all lengths and angles derive from expansions.
    refusal : float
        Largest closing error of the driven angle over a lobe, rad; beyond it the design is refused.
        1e-6 rad is 0.2 micrometres at 200 mm: ratios typed with seven digits pass, with a finding
        of the check ``closure``.
    oversampling : int
        Dense points per final chord of an outline; with 8 the error of the dense polygon is about
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
