"""Designs whose motion is a file of measured radii: read, refused with its lines, and built."""

from __future__ import annotations

import math
import pickle
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import gearcam
from gearcam.base.errors import DesignError, InfeasibleError
from gearcam.designs.design import hash_of, loads
from gearcam.kinds.cam.design import CamDesign
from gearcam.results.advice import remedies
from helpers_files import FLAT, ROLLER, SWINGING, read, table
from helpers_sampling import few

Rows = list[tuple[float, float]]

MOTION = '[motion]\nfile = "radii.csv"\n'
SLOW = ROLLER.replace("lift_mm = 10", "lift_mm = 6")


def by_radii(text: str, more: str = "") -> str:
    """A design with the phases of its motion replaced by the file."""
    start, end = text.index("[[motion]]"), text.index("[follower]")
    return text[:start] + MOTION + more + "\n" + text[end:]


def radii(text: str, step: float = 2.0, decimals: int = 9) -> Rows:
    """The caliper table of a design."""
    made = read(text.replace("[output]", f"[output]\ncaliper_step_deg = {step}"))
    rows = table(gearcam.build(made).files("caliper")["caliper.csv"])
    return [(a, round(r, decimals)) for a, r in zip(*(one.tolist() for one in rows.values()))]  # noqa: B905


def written(folder: Path, rows: Rows, head: str = "angle_deg,radius_mm") -> str:
    lines = [head, *(f"{a!r},{r!r}" for a, r in rows)]
    (folder / "radii.csv").write_text("\n".join(lines) + "\n")
    return str(folder / "turn.toml")


def design(folder: Path, text: str, rows: Rows | None = None, more: str = "") -> CamDesign:
    file = written(folder, radii(text) if rows is None else rows)
    return read(by_radii(text, more), file=file)


def lift_of(made: Any, theta: Any) -> Any:
    return gearcam.build(made).program.derivatives(theta, 0)[0]


THETA = np.linspace(0.0, 2.0 * math.pi, 300)


@pytest.mark.parametrize(
    ("text", "turns"),
    few([(SLOW, "ccw"), (SLOW, "cw"), (FLAT, "cw"), (FLAT, "ccw"), (SWINGING, "ccw"),
         (SWINGING, "cw")]),
    ids=["roller", "roller cw", "flat cw", "flat", "swinging", "swinging cw"],
)  # fmt: skip
def test_the_table_of_a_cam_is_read_back_as_its_lift(text: str, turns: str, tmp_path: Path) -> None:
    text = text.replace("thickness_mm", f'rotation = "{turns}"\nthickness_mm')
    made = design(tmp_path, text)
    result = gearcam.build(made)
    asked = lift_of(read(text), THETA)
    lever = result.follower.lever
    assert lever * np.abs(lift_of(made, THETA) - asked).max() < 2e-4
    assert lever * result.program.errors[0] < 1e-3
    told = result.facts["motion.measured"]
    assert told["radii"] == 180
    assert abs(result.facts["motion.measured.largest_mm"]) < 1e-6
    shown = [one.meaning for one in result.facts.shown()]
    assert "largest distance from the measured radii" in shown
    assert "deviation" not in result.facts["motion"]
    assert pickle.loads(pickle.dumps(made)) == made
    assert gearcam.design(made.to_dict()) == made


def test_conjugate_cams_are_copied_from_the_first(tmp_path: Path) -> None:
    text = SLOW.replace("offset_mm = 8", "roller_distance_mm = 80").replace("disc", "conjugate")
    made = read(text)
    rows = table(gearcam.build(made).files("caliper")["caliper.csv"])
    first = [*zip(rows["angle_deg"].tolist(), rows["radius_1_mm"].tolist(), strict=True)]
    copied = design(tmp_path, text, first)
    second = table(gearcam.build(copied).files("caliper")["caliper.csv"])["radius_2_mm"]
    np.testing.assert_allclose(second, rows["radius_2_mm"], atol=2e-5)


@pytest.mark.parametrize(
    ("head", "change"),
    [
        ("angle_deg,radius_in", lambda a, r: (a, r / 25.4)),
        ("angle_rad,radius_cm", lambda a, r: (math.radians(a), r / 10.0)),
        ("radius_um,note,angle_deg", None),
    ],
)
def test_radii_in_other_units_are_converted(
    head: str, change: Callable[[float, float], tuple[float, float]] | None, tmp_path: Path
) -> None:
    rows = radii(SLOW)
    plain = design(tmp_path, SLOW, rows)
    if change:
        file = written(tmp_path, [change(a, r) for a, r in rows], head)
    else:
        file = written(tmp_path, [(1e3 * r, a) for a, r in rows], head)
        path = tmp_path / "radii.csv"
        path.write_text(head + "\n" + "".join(f"{1e3 * r!r},7,{a!r}\n" for a, r in rows))
    other = read(by_radii(SLOW), file=file)
    np.testing.assert_allclose(lift_of(other, THETA), lift_of(plain, THETA), atol=1e-8)


def test_rows_may_begin_anywhere_and_repeat_the_first(tmp_path: Path) -> None:
    rows = radii(SLOW)
    plain, first = design(tmp_path, SLOW, rows), rows[40]
    turned = [*rows[40:], *((a + 360.0, r) for a, r in rows[:40]), (first[0] + 360.0, first[1])]
    other = design(tmp_path, SLOW, turned)
    np.testing.assert_allclose(lift_of(other, THETA), lift_of(plain, THETA), atol=1e-9)
    assert hash_of(other) != hash_of(plain)


CHANGES: dict[str, tuple[Callable[[Rows], Rows], str]] = {
    "order": (lambda r: [*r[:5], r[6], r[5], *r[7:]], "line 8: 10 deg follows 12 deg"),
    "twice": (lambda r: [*r[:5], r[4], *r[5:]], "line 7: 8 deg is given twice"),
    "open": (lambda r: r[:150], "the rows go from 0 deg to 298 deg"),
    "coarse": (lambda r: [*r[:60], *r[70:]], "line 62: the radius before is 22 deg away"),
    "negative": (lambda r: [*r[:9], (18.0, -24.1), *r[10:]], "line 11: the radius is -24.1 mm"),
    "zero": (lambda r: [*r[:9], (18.0, 0.0), *r[10:]], "line 11: the radius is 0 mm"),
    "round": (lambda r: [(a, 24.0) for a, _ in r], "the follower never moves"),
    "jump": (lambda r: [*r, (360.0, r[0][1] + 0.4)], "it jumps by 0.4 mm"),
    "few": (lambda r: r[::36], "has 5 rows"),
}


@pytest.mark.parametrize("name", CHANGES)
def test_what_is_wrong_in_the_file_is_told_with_its_line(name: str, tmp_path: Path) -> None:
    change, words = CHANGES[name]
    with pytest.raises(DesignError) as caught:
        design(tmp_path, SLOW, change(radii(SLOW)))
    (problem,) = caught.value.problems
    assert problem.key == "motion.file"
    assert words in problem.message


@pytest.mark.parametrize(
    ("head", "words"),
    [
        ("angle_deg,radius", "write angle_deg,radius_mm, if radius is in mm"),
        ("theta_deg,radius_mm", "none is angle_deg"),
        ("angle_deg,radius_furlong", "none is radius_mm"),
        ("angle_deg,height_mm", "none is theta_deg or lift_mm"),
    ],
)
def test_other_names_of_columns_are_refused(head: str, words: str, tmp_path: Path) -> None:
    file = written(tmp_path, radii(SLOW), head)
    with pytest.raises(DesignError) as caught:
        read(by_radii(SLOW), file=file)
    (problem,) = caught.value.problems
    assert words in problem.message
    assert "angle_deg and radius_mm" in problem.allowed


def test_a_lift_beside_a_radius_is_the_motion(tmp_path: Path) -> None:
    lift = 3.0 - 3.0 * np.cos(np.radians(np.arange(0.0, 360.0, 5.0)))
    lines = [f"{5 * k},{s!r},{30 + s!r}" for k, s in enumerate(lift.tolist())]
    (tmp_path / "radii.csv").write_text("theta_deg,lift_mm,radius_mm\n" + "\n".join(lines))
    made = read(by_radii(SLOW), file=str(tmp_path / "turn.toml"))
    np.testing.assert_allclose(lift_of(made, THETA), 3.0 - 3.0 * np.cos(THETA), atol=1e-7)
    assert "measured" not in gearcam.build(made).facts["motion"]
    with pytest.raises(DesignError, match=r"radius_tolerance_mm.*is of radii, but the rows are"):
        read(by_radii(SLOW, "radius_tolerance_mm = 0.01\n"), file=str(tmp_path / "turn.toml"))


@pytest.mark.parametrize(
    ("change", "more", "key", "words"),
    [
        (("", ""), "smoothing_tolerance_mm = 0.01\n", "motion.smoothing_tolerance_mm", "of lifts"),
        (("", ""), "radius_tolerance_mm = 9\n", "motion.radius_tolerance_mm", "leaves no lift"),
        (("prime_radius_mm = 30", 'prime_radius_mm = "solve"'), "", "cam.prime_radius_mm", "gives"),
        (("offset_mm = 8", 'offset_mm = "solve"'), "", "follower.offset_mm", "gives it"),
        (('form = "disc"', 'form = "yoke"'), "", "motion.file", "a yoke cam does"),
        (("[output]", "[drive]\npolydyne = true\n[output]"), "", "drive.polydyne", "would change"),
    ],
)
def test_what_does_not_go_with_a_measured_profile_is_refused(
    change: tuple[str, str], more: str, key: str, words: str, tmp_path: Path
) -> None:
    file = written(tmp_path, radii(SLOW))
    with pytest.raises(DesignError) as caught:
        read(by_radii(SLOW, more).replace(*change), file=file)
    told = {one.key: one.message for one in caught.value.problems}
    assert words in told[key]


def test_a_cam_in_space_has_no_radii(tmp_path: Path) -> None:
    written(tmp_path, radii(SLOW))
    text = Path("profiles/cylinder_cam.toml").read_text()
    with pytest.raises(DesignError) as caught:
        loads(by_radii(text), file=str(tmp_path / "turn.toml"))
    (problem,) = caught.value.problems
    assert problem.key == "motion.file"
    assert "which a cylinder cam does not have" in problem.message


def test_the_circle_of_the_design_is_that_of_the_profile(tmp_path: Path) -> None:
    """Within 0.1 mm the lift takes it up, so that the profile stays; else it is refused."""
    rows = radii(SLOW)
    near = design(tmp_path, SLOW.replace("prime_radius_mm = 30", "prime_radius_mm = 30.05"), rows)
    result = gearcam.build(near)
    assert result.program.range[0] == pytest.approx(-0.05, abs=3e-3)
    assert abs(result.facts["motion.measured.largest_mm"]) < 1e-6
    for key, value, own in (("prime", 31.0, 30.0), ("base", 24.2, 24.0)):
        far = design(
            tmp_path, SLOW.replace("prime_radius_mm = 30", f"{key}_radius_mm = {value}"), rows
        )
        with pytest.raises(InfeasibleError, match="the measured profile has another size") as told:
            gearcam.build(far).program  # noqa: B018
        assert told.value.where == f"cam.{key}_radius_mm"
        assert told.value.limit == pytest.approx(own, abs=1e-3)
        least = min(rows, key=lambda row: row[1])
        assert f"in line {rows.index(least) + 2}, is 24 mm" in told.value.nearest
        changed = far.with_({told.value.where: own})
        assert gearcam.build(changed).program.range[1] == pytest.approx(6.0, abs=0.01)


def test_a_hollow_is_refused_with_its_line_and_what_helps(tmp_path: Path) -> None:
    """Hundredths of a millimetre at each degree scatter so that a flat face rests on their tops."""
    made = design(tmp_path, FLAT, radii(FLAT, 1.0, 2))
    with pytest.raises(InfeasibleError, match="does not reach the measured profile") as told:
        gearcam.build(made).program  # noqa: B018
    line, angle = re.findall(r"line (\d+), at (\d+) deg", told.value.where)[0]
    assert int(line) == int(angle) + 2
    found = remedies(gearcam.build(made), told.value).found
    assert any("motion.radius_tolerance_mm" in one.changes for one in found)
    smooth = made.with_({"motion.radius_tolerance_mm": 0.01})
    assert np.abs(lift_of(smooth, THETA) - lift_of(read(FLAT), THETA)).max() < 0.012


def test_scattered_radii_are_told_with_a_tolerance_that_averages_them(tmp_path: Path) -> None:
    made = design(tmp_path, SLOW, radii(SLOW, 1.0, 2))
    (found,) = (one for one in gearcam.build(made).findings if one.code == "coarse-rows")
    (value,) = re.findall(r"motion\.radius_tolerance_mm = ([\d.]+)", found.message)
    smooth = gearcam.build(made.with_({"motion.radius_tolerance_mm": float(value)}))
    assert "coarse-rows" not in [one.code for one in smooth.findings]
    assert 1e-3 < abs(smooth.facts["motion.measured.largest_mm"]) <= float(value) + 1e-6


def test_a_slip_of_the_decimal_point_is_found(tmp_path: Path) -> None:
    rows = radii(SLOW)
    rows[50] = (rows[50][0], rows[50][1] + 0.9)
    result = gearcam.build(design(tmp_path, SLOW, rows, "radius_tolerance_mm = 0.95\n"))
    (found,) = (one for one in result.findings if one.code == "stray-row")
    assert "The radius" in found.message
    assert "line 52" in found.where
