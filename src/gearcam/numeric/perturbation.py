"""Error estimates by perturbing inputs.

How far the errors of its inputs change a result depends on its conditioning, for which there is no
general formula. So the result is computed again, a few times, from inputs that are off by as much
as they may be: numbers by their rounding, expansions and interpolations by their known errors. The
estimate is the largest change.
"""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Sequence
from dataclasses import fields, replace
from typing import Any, Final, Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray

from gearcam.numeric.arrays import Array

EPS: Final = float(np.finfo(float).eps)

_TRIALS: Final = 4

T = TypeVar("T")


class Perturb(Protocol):
    """What changes the inputs of a trial."""

    def __call__(self, values: Array | float, off: Array | float, /) -> Array:
        """Return `values`, each changed by `off` up or down."""
        ...


def largest_changes(compute: Callable[[Perturb], Sequence[NDArray[Any]]]) -> list[Array]:
    """Return the largest changes of results if their inputs are perturbed.

    Parameters
    ----------
    compute : callable
        ``compute(perturb)`` returns arrays, real or complex. It passes each input through
        ``perturb(values, off)`` with the amount by which it may be off.

    Returns
    -------
    list of arrays
        The largest change of each value, 0 where it has none. The trials are the same in every run.
    """
    draw = random.Random(0)  # to load `numpy.random` takes longer than most estimates

    def unperturbed(values: Array | float, _: Array | float) -> Array:
        return np.asarray(values, dtype=np.float64)

    def perturbed(values: Array | float, off: Array | float) -> Array:
        shape = np.broadcast_shapes(np.shape(values), np.shape(off))
        odd = np.frombuffer(draw.randbytes(math.prod(shape)), dtype=np.uint8) % 2
        signs = np.where(odd, 1.0, -1.0).reshape(shape)
        return np.asarray(values + signs * off, dtype=np.float64)

    exact = compute(unperturbed)
    changes = [np.zeros(np.shape(values)) for values in exact]
    with np.errstate(divide="ignore", invalid="ignore"):
        for _ in range(_TRIALS):
            for largest, own, other in zip(changes, exact, compute(perturbed), strict=True):
                change = np.abs(other - own)
                np.maximum(largest, change, out=largest, where=np.isfinite(change))
    return changes


def perturbed_sizes(sizes: T, perturb: Perturb, share: float) -> T:
    """Return sizes with each finite number among them perturbed, both parts of a complex one.

    Parameters
    ----------
    sizes : dataclass
        Any; fields of other types than float and complex are kept.
    perturb : callable
        See `largest_changes`.
    share : float
        By how much each may be off, relative to itself.
    """

    def moved(value: float) -> float:
        return float(perturb(value, share * value)) if math.isfinite(value) else value

    changed: dict[str, float | complex] = {}
    for field in fields(sizes):  # type: ignore[arg-type]
        value = getattr(sizes, field.name)
        if isinstance(value, complex):
            changed[field.name] = complex(moved(value.real), moved(value.imag))
        elif isinstance(value, float):
            changed[field.name] = moved(value)
    return replace(sizes, **changed)  # type: ignore[type-var]
