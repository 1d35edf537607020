"""Type names of arrays, and a setting of the memory allocator for them."""

from __future__ import annotations

from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]
Ints = NDArray[np.int64]
Mask = NDArray[np.bool_]
Plane = NDArray[np.complex128]
"""Points or directions in the plane, ``x + 1j*y``."""

ArrayOrPlane = TypeVar("ArrayOrPlane", Array, Plane)
ScalarT = TypeVar("ScalarT", bound=np.generic)


_BLOCK = 31 << 20
"""Size of the block, bytes: just below 32 MiB, the largest for which glibc adapts its threshold."""


def keep_freed_memory() -> None:
    """Make the allocator keep freed arrays for reuse.

    The C library of most Linux systems returns freed arrays of some hundred kB to the system and
    requests them anew, page by page, until a larger block has been freed once. That costs a
    seventh of the time of an outline and two fifths of that of an overlap. The block here is never
    written to. On other systems this has no effect.
    """
    np.empty(_BLOCK, dtype=np.uint8)


def as_complex(pairs: Array) -> Plane:
    """Return points (n, 2) as complex numbers (n,)."""
    return np.ascontiguousarray(pairs, dtype=np.float64).view(np.complex128).ravel()


def as_pairs(points: Plane) -> Array:
    """Return complex numbers (n,) as points (n, 2)."""
    return np.ascontiguousarray(points, dtype=np.complex128).view(np.float64).reshape(-1, 2)


def complex_of(real: Array, imag: Array) -> Plane:
    """Return ``real + 1j*imag`` without multiplication."""
    result = np.empty(np.shape(real), dtype=np.complex128)
    result.real, result.imag = real, imag
    return result


def distinct(first: NDArray[ScalarT], *others: ArrayLike) -> NDArray[ScalarT]:
    """Return all values of arrays, rising, each once.

    `numpy.unique` and `numpy.union1d` do the same, but the first call loads `numpy.ma`, which takes
    longer than all else that is done with such values in a build.

    Parameters
    ----------
    first : array
        Of any shape.
    *others : array_like
        More of them, of any shapes; their values are of the first array's type.

    Returns
    -------
    (n,) array
        Empty if all are empty. Values are compared exactly; none may be NaN, which equals nothing.
    """
    values = np.concatenate([np.ravel(one) for one in (first, *others)])
    values.sort()
    new = np.ones(values.shape, dtype=np.bool_)
    new[1:] = values[1:] != values[:-1]
    made: NDArray[ScalarT] = values[new]
    return made


def first_least(values: Array, alike: float) -> int:
    """Return the index of the least value; the first of those that differ from it by rounding.

    Parameters
    ----------
    values : (n,) array
    alike : float
        Difference up to which values are equal: rounding separates what symmetry makes equal.
    """
    return int(np.argmax(values <= values.min() + alike))


def apart(rising: Array, least: float) -> Array:
    """Return rising values (n,) without those that follow another by no more than `least`."""
    return rising[np.diff(rising, prepend=-np.inf) > least]


def away(values: Array, others: Array, least: float) -> Array:
    """Return the values (n,) that are farther than `least` from all `others` (k,)."""
    return values[np.abs(values[:, None] - others).min(axis=1) > least]


def snapped(values: Array, marks: Array, within: ArrayLike) -> Array:
    """Return values (n,), moved onto the nearest of `marks` (k,) `within` one or n distances."""
    nearest = marks[np.abs(values[:, None] - marks).argmin(axis=1)]
    return np.where(np.abs(values - nearest) <= within, nearest, values)


def indices_among(values: Ints, others: Ints) -> Ints:
    """Return where `values`, (n,), stand among `others`, (k,), which have each of them once."""
    order = np.argsort(others)
    made: Ints = order[np.searchsorted(others, values, sorter=order)]
    return made


def opposite(one: Array, other: Array) -> Mask:
    """Return where `one` and `other` have opposite signs; their products may underflow to 0."""
    return np.sign(one) * np.sign(other) < 0.0


def divided(values: ArrayOrPlane, counts: Ints) -> ArrayOrPlane:
    """Return values with even steps between them.

    Parameters
    ----------
    values : (n,) array
        Numbers or points.
    counts : (n - 1,) array of int
        Steps from each to the next one, at least 1.

    Returns
    -------
    (sum(counts) + 1,) array
    """
    group, place = in_groups(counts)
    step = np.diff(values) / counts
    made: Any = np.append(values[:-1][group] + place * step[group], values[-1])
    return made


def in_groups(counts: Ints) -> tuple[Ints, Ints]:
    """Return of entries in groups of `counts` (n,) the numbers of their groups, and their places.

    Both (sum(counts),), the places from 0 in each group.
    """
    group = np.repeat(np.arange(len(counts)), counts)
    return group, np.arange(len(group)) - (np.cumsum(counts) - counts)[group]


def runs_of(mask: Mask) -> list[tuple[int, int]]:
    """Return the first and the last index of each run of neighbours for which a mask holds."""
    rows = np.flatnonzero(mask)
    groups = np.split(rows, np.flatnonzero(np.diff(rows) > 1) + 1) if rows.size else []
    return [(int(one[0]), int(one[-1])) for one in groups]


def lengths_along(points: Plane) -> Array:
    """Return the length of a chain of points (n,) from the first up to each of them, (n,)."""
    return np.append(0.0, np.cumsum(np.abs(np.diff(points))))


def bounds(points: Plane) -> tuple[complex, complex]:
    """Return the lower left and the upper right corner of the box around complex points."""
    x, y = points.real, points.imag
    return complex(x.min(), y.min()), complex(x.max(), y.max())
