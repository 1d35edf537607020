"""Defaults of the rack yield to what is given, and the summary and the command say so."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import pytest

from gearcam.base.errors import InfeasibleError
from gearcam.base.readable import readable
from gearcam.cli import main
from gearcam.gears.spec import BasicRack, Rack
from gearcam.laws.ratio.ellipse import Ellipse
from helpers_pairs import job

ELLIPSE = Ellipse(eccentricity=0.2)


def used(x: float = 0.0, **given: float) -> BasicRack:
    """The rack of an ellipse with values given alone; both wheels have its clearance."""
    made = job(ELLIPSE, (20, 20), module=2.0, x=x, rack=Rack(**given)).pair
    rack, (one, two) = made.rack, (toothing.cutter for toothing in made.toothings)
    for own, mate in ((one, two), (two, one)):
        clearance = 2.0 * (rack.dedendum - rack.addendum)
        assert own.dedendum - mate.addendum == pytest.approx(clearance, abs=1e-12)
        assert own.fits  # its tip keeps a land
    return rack


@pytest.mark.parametrize("x", [0.0, 0.4, -0.8, 1.0])
@pytest.mark.parametrize("angle", range(5, 36, 2))
def test_a_pressure_angle_or_a_shift_alone_is_never_refused(angle: int, x: float) -> None:
    alpha = math.radians(angle)
    rack = used(x, pressure_angle=alpha)
    assert rack.pressure_angle == alpha
    assert rack.dedendum >= rack.addendum >= abs(x) + 0.1 - 1e-12
    land = math.pi / 4 - rack.tip_radius / math.cos(alpha)
    assert land > (rack.dedendum - rack.tip_radius) * math.tan(alpha)
    yielded = rack.yielded(Rack(pressure_angle=alpha))
    if rack.dedendum != 1.25:  # the tip radius has given all that it could
        assert rack.tip_radius < 0.1
    if not yielded:
        assert (rack.addendum, rack.dedendum, rack.tip_radius) == (1.0, 1.25, 0.38)


@pytest.mark.parametrize(
    "given",
    [
        {"addendum": 0.3},
        {"addendum": 1.3},
        {"addendum": 2.0},
        {"dedendum": 0.3},
        {"dedendum": 0.9},
        {"dedendum": 2.1},
        {"tip_radius": 0.0},
        {"tip_radius": 0.5},
        {"tip_radius": 0.7},
        {"dedendum": 1.1, "tip_radius": 0.4},
    ],
)
def test_heights_alone_make_the_others_yield(given: dict[str, float]) -> None:
    rack = used(**given)
    assert {name: getattr(rack, name) for name in given} == given
    assert rack.dedendum >= rack.addendum


@pytest.mark.parametrize(
    ("given", "x"),
    [
        ({"tip_radius": 0.5, "dedendum": 1.25}, 0.0),
        ({"dedendum": 2.4}, 0.0),
        ({"addendum": 1.2, "dedendum": 1.0}, 0.0),
        ({"tip_radius": 0.8}, 0.0),
        ({"addendum": 0.5}, 0.6),
    ],
)
def test_given_values_that_contradict_each_other_are_refused(given: Any, x: float) -> None:
    with pytest.raises(InfeasibleError):
        used(x, **given)


@pytest.mark.parametrize("angle", [25, 28, 35])
def test_what_yielded_is_said(
    angle: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "yields.toml"
    file.write_text(
        'kind = "gear-pair"\nname = "y"\n[law]\ntype = "ellipse"\neccentricity = 0.2\n'
        f"[pair]\nmodule_mm = 2\nteeth = [24, 24]\n[rack]\npressure_angle_deg = {angle}\n"
        '[output]\nfiles = ["csv"]\n',
        encoding="utf-8",
    )
    assert main(["check", str(file), "-o", str(tmp_path)]) == 0
    told = capsys.readouterr().out
    rack = used(pressure_angle=math.radians(angle))
    (line,) = (line for line in told.splitlines() if "tip radius" in line)
    assert readable(rack.tip_radius, "modules") in line
    assert "changed from the default 0.38" in line
    found = json.loads((tmp_path / "y" / "summary.json").read_text())["pair"]["rack"]
    assert found["tip_radius"] == pytest.approx(rack.tip_radius)
    assert found["yielded"] == {"tip_radius": 0.38} | ({"dedendum": 1.25} if angle == 35 else {})
