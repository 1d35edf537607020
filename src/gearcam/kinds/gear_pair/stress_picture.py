"""What is drawn of a certified stress: the loaded tooth with its neighbours, turned upright."""

from __future__ import annotations

from typing import Final

import numpy as np

from gearcam.base.numerals import formatted
from gearcam.pictures.stress_field import StressField
from gearcam.stress.certify import Certificate
from gearcam.stress.fillet import edge_stress
from gearcam.stress.hertz_load import past

_SEEN: Final = 3.4
"""Distance from the middle of the picture up to which it shows the wheel, in modules."""

_QUARTERS: Final = np.array([[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]])
"""Quarters of a triangle by its nodes: corners 0, 1, 2, middles of the edges 01, 12, 02."""

_BELOW: Final = 0.4
"""How far that middle is below the load, in modules."""


def stress_field(certificate: Certificate, module: float) -> StressField:
    """Return the field of a certified stress around its load.

    Parameters
    ----------
    certificate : Certificate
        The stress.
    module : float, mm
        Module of the wheel.

    Returns
    -------
    StressField
        Turned so that the tooth points up.
    """
    body, load = certificate.body, certificate.loads[0]
    mesh, moved = body.mesh, certificate.moved
    curve = mesh.region.teeth
    places = np.array([one.place for one in certificate.loads])
    at = curve.at(places)[0]
    upright = 1j * np.conj(at[0]) / abs(at[0])
    middle = at[0] - _BELOW * module * at[0] / abs(at[0])
    nodes = mesh.shapes(at_nodes=True).nodes
    means = mesh.averaged(body.moduli.von_mises(body.stress(moved, at_nodes=True)))[0]
    quarters = nodes[:, _QUARTERS].reshape(-1, 3)
    triangles = mesh.nodes[quarters]
    near = np.abs(triangles.mean(axis=1) - middle) < _SEEN * module
    edge = edge_stress(body, moved[:, 0], load.curve)
    points = curve.at(edge.s)[0]
    chains = np.stack([points, np.roll(points, -1)], axis=1)
    along = np.stack([edge.stress, np.roll(edge.stress, -1)], axis=1)
    seen = np.abs(chains - middle).max(axis=1) < _SEEN * module
    # beside a load the edge is stressed by the pressure itself
    for one in certificate.loads:
        away = np.abs(past(edge.s, one.place, curve.length))
        seen &= away > one.half_width
    peaks = (("tension", certificate.tension), ("compression", certificate.compression))
    inside = np.abs(at - middle) < _SEEN * module
    forces = np.array([one.force / abs(one.force) for one in certificate.loads])
    return StressField(
        triangles=triangles[near] * upright,
        von_mises=means[quarters[near]].mean(axis=1),
        edges=chains[seen] * upright,
        along=along[seen],
        marked=[
            (complex(one.point * upright), f"{name} {formatted(abs(one.stress), 4)} MPa")
            for name, one in peaks
            if abs(one.point - middle) < _SEEN * module
        ],
        loads=np.stack([at, forces], axis=1)[inside] * upright,
    )
