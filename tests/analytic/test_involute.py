"""A circular wheel of 20 teeth has involute flanks, to 1e-9 modules."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from gearcam.base.tolerances import DEFAULT
from gearcam.gears.cutter import choose_cutter
from gearcam.gears.flank import Toothing
from gearcam.gears.rolling import roll
from gearcam.gears.spec import BasicRack
from gearcam.laws.ratio.constant import Constant
from gearcam.laws.ratio.span import Lobes
from witness import oracle
from witness.oracle import mp

TEETH, MODULE = 20, 3.0
ALPHA = mp.pi / 9


def wheel(number: Any) -> Toothing:
    law = Constant().build(Lobes(1, 1), DEFAULT)
    rolling = roll(
        law, teeth=(TEETH, TEETH), center_distance=None, module=MODULE, tolerances=DEFAULT
    )
    return Toothing(
        track=rolling.tracks[number - 1],
        wheel=number,
        teeth=TEETH,
        cutter=choose_cutter(BasicRack(), MODULE, 0.0),
    )


@pytest.mark.parametrize("number", [1, 2])
@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("tooth", [1, 8, 20])
def test_flanks_are_involutes(number: int, side: int, tooth: int) -> None:
    toothing = wheel(number)
    heights = np.linspace(-0.95, 0.75, 35)
    reach = heights * MODULE / float(mp.sin(ALPHA) * mp.cos(ALPHA))
    place = toothing.tooth_places[tooth - 1]
    sf = np.full_like(reach, place + side * np.pi * MODULE / 4)
    sigma = np.full_like(reach, side)
    frames = toothing.frames(toothing.track.angle(sf - side * reach))
    points = toothing.flank_points(frames, sf, sigma)

    exact = [oracle.circular_flank(TEETH, mp.mpf(float(h)), ALPHA) for h in heights]
    plus = np.array([complex(float(x), float(y)) for x, y in exact])
    flank = plus if side == 1 else plus.conj()
    angle = place / (MODULE * TEETH / 2)
    # wheel 2: polar angle pi - phi2, so that rising s turns clockwise
    expected = flank * np.exp(1j * angle) if number == 1 else -(flank * np.exp(1j * angle)).conj()
    assert np.abs(points / MODULE - expected).max() < 1e-9


def test_a_wrong_involute_is_caught() -> None:
    """The comparison sees a pressure angle that is off by a hundredth of a second of arc."""
    exact = oracle.circular_flank(TEETH, mp.mpf("0.7"), ALPHA)
    wrong = oracle.circular_flank(TEETH, mp.mpf("0.7"), ALPHA + mp.mpf("5e-8"))
    assert mp.hypot(exact[0] - wrong[0], exact[1] - wrong[1]) > 1e-9
