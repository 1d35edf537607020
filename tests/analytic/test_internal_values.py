"""Flanks of wheel and ring through the mesh, against points known to thirty digits."""

from __future__ import annotations

import math

import numpy as np
import pytest

import gearcam as gc
from gearcam.gears.pair import GearPair

CLOSE = 1e-9
"""mm."""

TWO, THREE = (1, 2, 24, 48), (2, 3, 40, 60)
"""Lobes and teeth of two pairs, module 2: r1 = p/(1 + 0.3*cos(phi1)), p/(1 + 0.2*cos(2*phi1))."""

# tooth, sigma, phi1 in deg, u = sf - s, points in the frames of wheel 1 and of the ring
POINTS = [
    (TWO, 1, 1, 3, 0.670422458743, (17.3669675696998, 1.50032475382222),
     (40.2736992412249, 1.49456196954045)),
    (TWO, 5, 1, 82.847443087281, -2 / 3, (3.13978485125321, 20.9506597590129),
     (35.4267312088711, 26.1907893140537)),
    (TWO, 5, -1, 62, 3.91049855615, (5.76908841828522, 18.6201588573513),
     (35.6791213785957, 22.5025153446057)),
    (TWO, 13, 1, 182, 0.456247828366, (-32.0296446730783, -1.52377105198177),
     (-1.52211673957626, 54.9191400056075)),
    (THREE, 1, 1, 3, -0.0736252436139, (31.3533126119044, 1.5789209538115),
     (50.3294840651883, 1.57946003539188)),
    (THREE, 5, 1, 45.184870469123, -2 / 3, (26.620401290116, 26.1304226359781),
     (49.5061653300549, 26.7318093630524)),
    (THREE, 13, -1, 104.2020789582, -2 / 3, (-10.7888974450768, 44.7722430322602),
     (22.6275060442496, 60.9494894166484)),
]  # fmt: skip


def pair(case: tuple[int, int, int, int]) -> GearPair:
    n1, n2, z1, z2 = case
    law = gc.laws.Ellipse(eccentricity=0.3 if n1 == 1 else 0.2, lobes=(n1, n2))
    spec = gc.PairSpec(type="internal", teeth=(z1, z2), module=2.0)
    return gc.build(gc.GearPairDesign(name="ring", law=law, pair=spec)).pair


@pytest.mark.parametrize(("case", "tooth", "sigma", "phi1", "u", "one", "two"), POINTS)
def test_flanks_share_their_points(
    case: tuple[int, int, int, int],
    tooth: int,
    sigma: int,
    phi1: float,
    u: float,
    one: tuple[float, float],
    two: tuple[float, float],
) -> None:
    made = pair(case)
    pitch, angle = 2.0 * math.pi, np.array([math.radians(phi1)])
    sf = np.array([(tooth - 1 + 0.25 * sigma) * pitch])
    found = []
    for toothing, side in zip(made.toothings, (sigma, -sigma), strict=True):
        frames = toothing.frames(angle)
        assert float((sf - frames.s)[0]) == pytest.approx(u, abs=CLOSE)
        found.append(complex(toothing.flank_points(frames, sf, np.array([float(side)]))[0]))
    assert abs(found[0] - complex(*one)) < CLOSE
    assert abs(found[1] - complex(*two)) < CLOSE
    turned = found[1] * np.exp(-1j * float(made.law.phi2(angle)[0])) - made.center_distance
    assert abs(found[0] * np.exp(-1j * angle[0]) - turned) < CLOSE
