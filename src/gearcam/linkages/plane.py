"""Points and directions of the plane as jets: ``x + 1j*y`` with their derivatives."""

from __future__ import annotations

import cmath
from typing import Any, NamedTuple

import numpy as np

from gearcam.numeric import jets
from gearcam.numeric.jets import Jet


class Frame(NamedTuple):
    """A member's or a guide's own frame.

    Attributes
    ----------
    origin : Jet
        Of complex numbers, mm.
    direction : Jet
        Its x axis, of complex numbers of size 1.
    """

    origin: Jet
    direction: Jet

    def at(self, point: complex) -> Jet:
        """Return the jet of a `point` of the member, given in its frame, mm."""
        return self.origin + self.direction * point


def real(z: Jet) -> Jet:
    """Return the x coordinates of complex jets."""
    return Jet([value if isinstance(value, float) else np.real(value) for value in z.c])


def imaginary(z: Jet) -> Jet:
    """Return the y coordinates of complex jets."""
    return Jet([0.0 if isinstance(value, float) else np.imag(value) for value in z.c])


def conjugate(z: Jet) -> Jet:
    """Return mirror images at the x axis."""
    return Jet([value if isinstance(value, float) else np.conj(value) for value in z.c])


def dot(first: Jet, second: Jet) -> Jet:
    """Return the scalar products of `first` and `second` vectors."""
    return real(conjugate(first) * second)


def cross(first: Jet, second: Jet) -> Jet:
    """Return the z components of the vector products of `first` and `second` vectors."""
    return imaginary(conjugate(first) * second)


def square(z: Jet) -> Jet:
    """Return the squared lengths of vectors."""
    return real(z * conjugate(z))


def towards(angle: Jet) -> Jet:
    """Return the unit vectors at angles, rad."""
    sine, cosine = jets.sin_cos(angle)
    return cosine + sine * 1j


def turned(angle: Jet | float) -> Any:
    """Return the unit vector at an angle, rad: of a number a number, of a jet a jet."""
    return towards(angle) if isinstance(angle, Jet) else cmath.exp(1j * angle)


def parts(vector: Any) -> tuple[Any, Any]:
    """Return the x and y coordinates of a vector, of a number or a jet."""
    if isinstance(vector, Jet):
        return real(vector), imaginary(vector)
    return vector.real, vector.imag


def turning(direction: Jet) -> Jet:
    """Return the derivative of the angle of a turning unit vector, its `direction`: ``u x u'``."""
    return cross(direction.shortened(), direction.differentiated())


def rotation(direction: Jet) -> Jet:
    """Return the angle of a turning unit vector, rad.

    Parameters
    ----------
    direction : Jet
        Of complex numbers of size 1.

    Returns
    -------
    Jet
        Values in (-pi, pi], and the derivatives of the angle (see `turning`).
    """
    value = np.asarray(np.angle(direction.c[0]), dtype=np.float64)
    if not direction.order:
        return Jet([value])
    return Jet([value, *(one / k for k, one in enumerate(turning(direction).c, start=1))])
