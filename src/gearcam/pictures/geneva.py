"""Shapes of Geneva wheels and their cranks, as drawings of machines show them.

Their sizes in the plane are true: slots, path of the pin, the rest in which the wheel is locked.
The pin's diameter and what is left around it are chosen to be seen.

Depends on drawings, numpy only.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from gearcam.numeric.arrays import Array, Plane
from gearcam.parts.shapes import Circle
from gearcam.pictures.drawings import BORE, CENTER, MEMBER, Cross, Feature, Path
from gearcam.pictures.links import link

_PIN: Final = 0.09
"""Radius of the pin, as a share of the crank."""

_ARM: Final = 1.4
"""Half width of the crank, in radii of the pin."""

_LOCK: Final = 0.82
"""Radius of the locking disc, as a share of the crank: inside the pin's path."""

_RIM: Final = 1.3
"""What an internal wheel has outside its slots, as a share of the crank."""

_STEPS: Final = 65
"""Corners of an arc."""


def geneva_wheel(crank: float, slots: int, *, internal: bool) -> tuple[Feature, ...]:
    """Return a slotted wheel in its frame, x along a slot.

    Parameters
    ----------
    crank : float, mm
        Length of its crank.
    slots : int
        Number of slots.
    internal : bool
        Whether it surrounds the crank.

    Returns
    -------
    tuple of Feature
    """
    pitch = math.tau / slots
    distance, pin = crank / math.sin(0.5 * pitch), _PIN * crank
    mouth = distance * math.cos(0.5 * pitch)
    turns = np.exp(1j * pitch * np.arange(slots))
    center = Feature(layer=CENTER, shape=Cross(center=0j, size=3.0 * pin))
    if internal:
        rim = Circle(center=0j, diameter=2.0 * (distance + _RIM * crank))
        tooth = _inside(distance, mouth, crank, pin)
        edge = Path(points=_repeated(tooth, turns))
        return (
            Feature(layer=MEMBER, shape=rim),
            Feature(layer=f"{MEMBER}_{BORE}", shape=edge),
            center,
        )
    tooth = _outside(distance, mouth, crank, pin, pitch)
    return Feature(layer=MEMBER, shape=Path(points=_repeated(tooth, turns))), center


def _repeated(tooth: Plane, turns: Plane) -> Plane:
    return np.asarray(np.outer(turns, tooth), dtype=np.complex128).ravel()


def _outside(distance: float, mouth: float, crank: float, pin: float, pitch: float) -> Plane:
    """Return the edge of an external wheel from one slot to the next: slot, rim, locking arc."""
    bottom = distance - crank - 0.5 * pin
    slot = _slot(bottom, math.sqrt(mouth**2 - pin**2), pin)
    lock, middle = _LOCK * crank, distance * np.exp(0.5j * pitch)
    # where the arc of the locking disc meets the rim
    cosine = (distance**2 + lock**2 - mouth**2) / (2.0 * distance * lock)
    half = math.acos(min(1.0, cosine))
    way = -middle / abs(middle)
    arc = middle + lock * way * np.exp(1j * _spread(half, -half))
    return np.asarray(np.concatenate([slot, arc]), dtype=np.complex128)


def _inside(distance: float, mouth: float, crank: float, pin: float) -> Plane:
    """Return the edge of an internal wheel's opening from one slot to the next."""
    slot = _slot(distance + crank + 0.5 * pin, math.sqrt(mouth**2 - pin**2), pin)
    beside, pitch = math.asin(pin / mouth), 2.0 * math.acos(mouth / distance)
    rim = mouth * np.exp(1j * _spread(beside, pitch - beside))
    return np.asarray(np.concatenate([slot, rim[1:-1]]), dtype=np.complex128)


def _slot(bottom: float, mouth: float, pin: float) -> Plane:
    """Return the edge of a slot along x, counter-clockwise about the wheel."""
    inward = 1.0 if bottom < mouth else -1.0
    end = bottom + inward * pin
    round_ = end - inward * pin * np.exp(1j * inward * _spread(0.5 * math.pi, -0.5 * math.pi))
    edge = np.concatenate([[mouth - 1j * pin], round_, [mouth + 1j * pin]])
    return np.asarray(edge, dtype=np.complex128)


def _spread(first: float, last: float) -> Array:
    return np.linspace(first, last, _STEPS)


def geneva_crank(crank: float, slots: int, *, internal: bool) -> tuple[Feature, ...]:
    """Return the crank in its frame, x towards its pin (see `geneva_wheel`)."""
    pitch, pin = math.tau / slots, _PIN * crank
    distance, lock = crank / math.sin(0.5 * pitch), _LOCK * crank
    mouth = distance * math.cos(0.5 * pitch)
    made = [*link((0j, complex(crank)), _ARM * pin)[:1]]
    if not internal:
        half = math.acos(min(1.0, (distance**2 + lock**2 - mouth**2) / (2.0 * distance * lock)))
        other = math.asin(min(1.0, lock * math.sin(half) / mouth))
        around = lock * np.exp(1j * _spread(half, math.tau - half))
        bite = distance + mouth * np.exp(1j * _spread(math.pi + other, math.pi - other))
        edge = np.concatenate([around, bite[1:-1]])
        disc = Path(points=np.asarray(edge, dtype=np.complex128))
        made.insert(0, Feature(layer=MEMBER, shape=disc))
    made.append(Feature(layer=f"{MEMBER}_{BORE}", shape=Circle(center=crank, diameter=2.0 * pin)))
    made.append(Feature(layer=CENTER, shape=Cross(center=0j, size=3.0 * pin)))
    return tuple(made)
