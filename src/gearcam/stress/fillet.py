"""Stress along the free edge of a wheel, and its peaks in the fillets.

On a free edge the only stress in the plane is that along it: the modulus of the plane times the
strain. The strain follows from the displacements of the edge's own three nodes, at the two Gauss
points of each edge, where its error falls faster than elsewhere; nothing is extrapolated.

Looked at are the fillets: where the curve with the teeth is concave with a radius below 4 modules,
and a little beyond; not beside the load. At a sharp re-entrant corner, such as that of a keyway,
the stress of an elastic body has no limit, and none is given near it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.numeric.arrays import Array, Ints, Mask, Plane
from gearcam.stress.elastic import ElasticBody, edge_slopes
from gearcam.stress.hertz_load import SIDE, FlankLoad, past
from gearcam.stress.region import BoundaryCurve
from gearcam.stress.size_field import CONCAVE

_BEYOND: Final = 0.35
"""How far beyond its ends a fillet is looked at, in modules: a peak may be where it joins the
flank. As far from a sharp corner nothing is."""

BESIDE: Final = (1.6, 0.15)
"""How far from a load nothing is looked at: so many half-widths and so many modules. There the
pressure itself stresses the edge."""

_FITTED: Final = 7
"""Gauss points that the parabola of a peak is fitted to."""

_LEAST: Final = 5
"""Least number of them: three would always be met."""

_GAUSS: Final = np.array([-1.0, 1.0]) / np.sqrt(3.0)
"""Gauss points of an edge, from -1 to 1."""


class EdgeStress(NamedTuple):
    """Stress along a boundary curve at the Gauss points of its edges.

    Attributes
    ----------
    curve : BoundaryCurve
        The curve.
    s : (g,) array, mm
        Places on it, rising.
    stress : (g,) array, MPa
        Stress along the edge, positive in tension.
    """

    curve: BoundaryCurve
    s: Array
    stress: Array


@dataclass(frozen=True, kw_only=True)
class StressPeak(ShortRepr):
    """The largest tension or compression along a boundary.

    Parameters
    ----------
    stress : float, MPa
        Stress along the edge, negative in compression.
    s : float, mm
        Its place on the curve.
    point : complex, mm
        Its place.
    misfit : float, MPa
        Root mean square of the distances of the Gauss points beside it from their parabola.
    """

    stress: float
    s: float
    point: complex
    misfit: float = 0.0


def _edges(body: ElasticBody, curve: int) -> tuple[Ints, Array, Array]:
    """Return of the edges of a curve the nodes, and s at the Gauss points with half the lengths."""
    here = body.mesh.curve == curve
    low, high = body.mesh.arcs[here].T
    half = 0.5 * (high - low)[:, None]
    return body.mesh.edges[here], low[:, None] + half * (1.0 + _GAUSS), half


def edge_stress(body: ElasticBody, moved: Plane, curve: int) -> EdgeStress:
    """Return the stress along a boundary curve.

    With the derivatives of place x and displacement u along an edge of three nodes the strain is
    ``(x' . u')/|x'|^2``.

    Parameters
    ----------
    body : ElasticBody
        The body.
    moved : (n,) complex array, mm
        Displacements of its nodes.
    curve : int
        Number of the curve.

    Returns
    -------
    EdgeStress
    """
    nodes, s, _ = _edges(body, curve)
    slopes = edge_slopes(_GAUSS).T
    along, stretched = body.mesh.nodes[nodes] @ slopes, moved[nodes] @ slopes
    stress = body.moduli.along_edge * (stretched / along).real
    return EdgeStress(body.mesh.region.curves[curve], s.ravel(), stress.ravel())


def mean_stress(body: ElasticBody, curve: int, s: float, within: float) -> Plane:
    """Return the load whose work is the mean stress along a stretch of a boundary curve.

    Parameters
    ----------
    body : ElasticBody
        The body.
    curve : int
        Number of the curve.
    s, within : float, mm
        Middle of the stretch, and half its length; it has the nearest Gauss points at least.

    Returns
    -------
    (n,) complex array, N/mm^3
        The mean stress is the sum of the products, of vectors, with displacements of the nodes.
    """
    nodes, places, half = _edges(body, curve)
    away = np.abs(past(places, s, body.mesh.region.curves[curve].length))
    weights = np.where(away <= max(within, float(away.min())), half, 0.0)
    slopes = edge_slopes(_GAUSS)
    along = body.mesh.nodes[nodes] @ slopes.T
    shares = body.moduli.along_edge * weights / (weights.sum() * np.conj(along))
    made = np.zeros(len(body.mesh.nodes), dtype=np.complex128)
    np.add.at(made, nodes, shares @ slopes)
    return made


def fillets(curve: BoundaryCurve, module: float) -> Array:
    """Return the fillets of a curve, with what is looked at beyond their ends.

    Parameters
    ----------
    curve : BoundaryCurve
        The curve with the teeth.
    module : float, mm
        Module.

    Returns
    -------
    (k, 2) array, mm
        s at both ends of each, rising; the first may begin below 0, or the last end beyond the
        curve's length. None follows another without a gap.
    """
    places = curve.places
    bends = curve.curvature(0.5 * (places[1:] + places[:-1]))
    concave = bends * CONCAVE * module < -1.0
    low = places[:-1][concave] - _BEYOND * module
    high = places[1:][concave] + _BEYOND * module
    first = np.append(True, low[1:] > high[:-1])[: len(low)]
    found = np.column_stack([low[first], high[np.roll(first, -1)]])
    if len(found) > 1 and found[-1, 1] >= found[0, 0] + curve.length:  # one goes round the start
        found[0, 0] = found[-1, 0] - curve.length
        return found[:-1]
    return found


def sharp_corners(curve: BoundaryCurve) -> Array:
    """Return s, (k,), mm, of the re-entrant corners of a curve that are free to move."""
    before, after = (curve.corners + side * SIDE * curve.length for side in (-1.0, 1.0))
    turn = np.angle(curve.at(after)[1] * np.conj(curve.at(before)[1]))
    return curve.corners[(turn < 0.0) & ~(curve.held(before) & curve.held(after))]


def in_fillets(edge: EdgeStress, module: float) -> Mask:
    """Return which places of a curve, (g,), are in its fillets, and not near a sharp corner.

    Parameters
    ----------
    edge : EdgeStress
        Places on the curve with the teeth.
    module : float, mm
        Module.

    Returns
    -------
    (g,) bool array
    """
    curve, s = edge.curve, edge.s
    stretches = fillets(curve, module)
    made = np.zeros(len(s), dtype=bool)
    for turn in (-curve.length, 0.0, curve.length):
        number = np.searchsorted(stretches[:, 0], s + turn, side="right") - 1
        ends = np.append(stretches[:, 1], -np.inf)  # that of number -1, before the first
        made |= s + turn <= ends[number]
    for corner in sharp_corners(curve):
        made &= np.abs(past(s, corner, curve.length)) > _BEYOND * module
    return made


def looked_at(edge: EdgeStress, module: float, loads: Sequence[FlankLoad]) -> Mask:
    """Return where peaks are looked for: in fillets, and not beside a load.

    Parameters
    ----------
    edge : EdgeStress
        Places on the curve with the teeth.
    module : float, mm
        Module.
    loads : sequence of FlankLoad
        The loads, on the same curve.

    Returns
    -------
    (g,) bool array
    """
    looked = in_fillets(edge, module)
    for load in loads:
        beside = BESIDE[0] * load.half_width + BESIDE[1] * module
        looked &= np.abs(past(edge.s, load.place, edge.curve.length)) > beside
    return looked


def peak(edge: EdgeStress, looked: Mask, sign: int) -> StressPeak:
    """Return the largest tension or compression.

    It is the top of the parabola fitted to the highest Gauss point and three on either side; that
    point itself where the parabola has no top among them.

    Parameters
    ----------
    edge : EdgeStress
        Stress along a curve.
    looked : (g,) bool array
        Where it is looked for; somewhere.
    sign : {-1, +1}
        +1 for tension.

    Returns
    -------
    StressPeak
    """
    top = int(np.where(looked, sign * edge.stress, -np.inf).argmax())
    half = _FITTED // 2
    near = (top + np.arange(-half, half + 1)) % len(looked)
    joined = looked[near]
    joined[:half] = np.logical_and.accumulate(joined[:half][::-1])[::-1]
    joined[half:] = np.logical_and.accumulate(joined[half:])
    near = near[joined]
    s, stress, misfit = float(edge.s[top]), float(edge.stress[top]), 0.0
    if len(near) >= _LEAST:
        away = past(edge.s[near], s, edge.curve.length)
        scale = float(np.ptp(away))
        powers = (away / scale)[:, None] ** np.arange(3)
        level, slope, bend = np.linalg.lstsq(powers, edge.stress[near], rcond=None)[0]
        misfit = float(np.sqrt(np.mean((powers @ [level, slope, bend] - edge.stress[near]) ** 2)))
        middle = -0.5 * slope / bend if sign * bend < 0.0 else np.inf
        if away[0] <= middle * scale <= away[-1]:
            s, stress = s + float(middle) * scale, float(level + 0.5 * slope * middle)
    s %= edge.curve.length
    return StressPeak(
        stress=stress, s=s, point=complex(edge.curve.at(np.array([s]))[0][0]), misfit=misfit
    )
