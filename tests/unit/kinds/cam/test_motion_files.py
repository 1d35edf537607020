"""Cams of a whole turn, in files and from Python: read, refused, compared, built, followed."""

from __future__ import annotations

import math
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import gearcam
from gearcam.base.errors import DesignError, InfeasibleError
from gearcam.cams.spec import CamSpec, FollowerSpec
from gearcam.designs import document_of
from gearcam.designs.design import hash_of
from gearcam.kinds.cam.design import CamDesign
from gearcam.laws.motion_formula import MotionFormula
from gearcam.laws.motion_table import MotionTable
from helpers_files import only, problems, read, table

THETA = np.arange(0.0, 360.0, 10.0)
LIFT = 5.0 * (1.0 - np.cos(np.radians(THETA)))
ROLLER = '[follower]\ntype = "roller"\nroller_radius_mm = 6\n[cam]\nprime_radius_mm = 30\n'
ARM = ROLLER.replace("[cam]", 'motion = "oscillating"\narm_mm = 90\npivot_distance_mm = 100\n[cam]')
BY_FILE = 'file = "rows.csv"'
BY_LISTS = f"theta_deg = {THETA.tolist()}\nlift_mm = {LIFT.tolist()}"
BY_FORMULA = 'lift = "5*(1 - cos(theta))"'


def text(motion: str, rest: str = ROLLER) -> str:
    return f'kind = "cam"\nname = "turn"\n[motion]\n{motion}\n{rest}'


def rows(unit: str = "mm", lift: Any = LIFT) -> str:
    lines = (f"{a},{b!r}" for a, b in zip(THETA.tolist(), lift.tolist(), strict=True))
    return f"theta_deg,lift_{unit}\n" + "\n".join(lines) + "\n"


def design(tmp_path: Path, motion: str = BY_FILE, rest: str = ROLLER, **changed: Any) -> CamDesign:
    (tmp_path / "rows.csv").write_text(rows(**changed))
    return read(text(motion, rest), file=str(tmp_path / "turn.toml"))


def lift_of(made: CamDesign, theta: Any) -> Any:
    return gearcam.build(made).program.derivatives(theta, 0)[0]


@pytest.mark.parametrize("motion", [BY_FILE, BY_LISTS, BY_FORMULA], ids=["file", "lists", "text"])
def test_a_motion_of_the_whole_turn_is_read_and_built(motion: str, tmp_path: Path) -> None:
    """An eccentric disc: the pitch curve of a point on it is known."""
    made = design(tmp_path, motion)
    result = gearcam.build(made)
    theta = np.linspace(0.0, 2 * math.pi, 500)
    np.testing.assert_allclose(lift_of(made, theta), 5.0 * (1.0 - np.cos(theta)), atol=2e-7)
    assert result.facts["motion.total_lift"] == pytest.approx(10.0, abs=1e-6)
    assert result.facts["motion.continuity"] == 3
    assert "deviation" not in result.facts["motion"]
    assert 0.0 <= result.facts["accuracy.profile_mm"] < 1e-6
    assert result.findings == ()
    assert {s.kind for s in result.program.stretches} == {"rise", "return"}
    again = gearcam.design(document_of(made))
    assert again == made
    assert pickle.loads(pickle.dumps(made)) == made


def test_rows_in_degrees_swing_an_arm(tmp_path: Path) -> None:
    made = design(tmp_path, f"{BY_FILE}\nsmoothing_tolerance_deg = 0.001", ARM, unit="deg")
    result = gearcam.build(made)
    assert result.program.range[1] == pytest.approx(math.radians(10.0), abs=2e-5)
    assert result.facts["motion.unit"] == "deg"
    told = result.facts.quantity("motion.deviation")
    assert 9e-4 < abs(told.value) <= 0.001
    assert result.program.errors[0] > 0.0
    assert result.facts["accuracy.profile_mm"] > 90.0 * result.program.errors[0]
    assert told.unit == "deg"
    assert told.place.startswith("at ")
    lists = BY_LISTS.replace("lift_mm", "lift_deg")
    assert lift_of(read(text(lists, ARM)), 3.0) == pytest.approx(math.radians(9.95), abs=1e-3)


def test_the_same_from_python(tmp_path: Path) -> None:
    made = design(tmp_path, f"{BY_LISTS}\nsmoothing_tolerance_mm = 0.01")
    parts: dict[str, Any] = {
        "name": "turn",
        "follower": FollowerSpec(type="roller", roller_radius=6.0),
        "cam": CamSpec(prime_radius=30.0),
    }
    table = MotionTable(theta=tuple(np.radians(THETA)), lift=tuple(LIFT), smoothing_tolerance=0.01)
    assert CamDesign(motion=table, **parts) == made
    arrays: Any = {"theta": np.radians(THETA), "lift": LIFT, "smoothing_tolerance": 0.01}
    assert CamDesign(motion=MotionTable(**arrays), **parts) == made
    other = made.with_({"motion.smoothing_tolerance_mm": 0.02})
    assert other != made
    assert hash_of(other) != hash_of(made)
    with pytest.raises(DesignError, match=r"motion\.theta_deg\[3\]: .* is given twice"):
        CamDesign(motion=MotionTable(theta=(0.0, 1, 2, 2, 3, 4, 5), lift=(0.0, 1, 2, 3, 4, 3, 1)),
                  **parts)  # fmt: skip
    with pytest.raises(DesignError, match=r"motion: is a str\n.*of tuple or MotionFormula or M"):
        CamDesign(motion="rows.csv", **parts)  # pyright: ignore
    function: Any = MotionFormula(lift=lambda x: 5.0 * (1.0 - np.cos(x)))
    by_function = CamDesign(motion=function, **parts)
    theta = np.linspace(0.0, 6.0, 50)
    np.testing.assert_allclose(lift_of(by_function, theta), 5 * (1 - np.cos(theta)), atol=1e-13)
    assert by_function == CamDesign(motion=function, **parts)
    with pytest.raises(DesignError, match=r"motion\.lift: the Python function"):
        by_function.to_dict()


def test_rows_count_and_not_where_they_lie(tmp_path: Path) -> None:
    made = []
    for name, lift in (("a", LIFT), ("b", LIFT), ("c", 1.001 * LIFT)):
        (tmp_path / name).mkdir()
        made.append(design(tmp_path / name, lift=lift))
    assert made[0] == made[1]
    assert made[0] != made[2]
    assert hash_of(made[0]) == hash_of(made[1]) != hash_of(made[2])


@pytest.mark.parametrize(
    ("motion", "key", "line", "words"),
    [
        ("", "motion.theta_deg", 3, "is missing: a table has both columns, or a file"),
        ('file = "none.csv"', "motion.file", 4, "cannot be read"),
        (f"{BY_LISTS}\n{BY_FILE}", "motion.file", 6, "the rows are given twice"),
        (
            BY_LISTS.replace("lift_mm", "lift_deg"),
            "motion.lift_deg",
            5,
            "wrong unit for the lift of a transl",
        ),
        (f"{BY_LISTS}\nsmoothing_tolerance_deg = 1", "motion.smoothing_tolerance_deg", 6, "wrong"),
        (f"{BY_LISTS}\nsmoothing_tolerance_mm = 5", "motion.smoothing_tolerance_mm", 6, "no lift"),
        (f"{BY_LISTS}\nsmoothing_mm = 1", "motion.smoothing_mm", 6, "mean smoothing_tolerance_mm"),
        (BY_LISTS.replace("20.0", "9.0", 1), "motion.theta_deg[2]", 4, "9 deg follows 10 deg"),
        (BY_LISTS.replace("20.0", "nan", 1), "motion.theta_deg[2]", 4, "not a finite number"),
        (BY_LISTS.replace("[0.0, 10.0, ", "["), "motion.lift_mm", 5, "36 values, but theta has 34"),
        (BY_LISTS.replace("[0.0, 10.0", "[0.0, 800", 1), "motion.theta_deg[1]", 4, "out of range"),
        ('lift = "5*(1 - cos(x))"', "motion.lift", 4, "unknown name 'x'"),
        ("lift = 3", "motion.lift", 4, "is not text"),
        (f"{BY_FORMULA}\n{BY_FILE}", "motion.file", 5, "unknown key"),
    ],
)
def test_what_is_wrong_is_told_where_it_stands(
    motion: str, key: str, line: int, words: str
) -> None:
    problem = only(text(motion))
    assert (problem.key, problem.line) == (key, line)
    assert words in str(problem), str(problem)


def test_a_file_is_refused_with_its_line(tmp_path: Path) -> None:
    for old, new, words in (
        ("20.0,", "5.0,", "line 4: 5 deg follows 10 deg"),
        ("20.0,", "10.0,", "line 4: 10 deg is given twice"),
        (
            "lift_mm",
            "lift_deg",
            "line 1: lift_deg is of the wrong kind for a translating",
        ),
        ("350.0,", "360.0,", "line 37: the lift after the turn is 0.07596123494 mm: it jumps by"),
    ):
        (tmp_path / "rows.csv").write_text(rows().replace(old, new, 1))
        with pytest.raises(DesignError) as caught:
            read(text(BY_FILE), file=str(tmp_path / "turn.toml"))
        (problem,) = caught.value.problems
        assert (problem.key, problem.line) == ("motion.file", 4)
        assert words in problem.message
    made = design(tmp_path)
    (tmp_path / "rows.csv").unlink()
    assert lift_of(made, 1.0) > 0.0  # read once and never again
    other = made.with_({"name": "other"}) if (tmp_path / "rows.csv").exists() else made
    assert other is made


def test_a_file_with_semicolons_and_decimal_commas_is_told(tmp_path: Path) -> None:
    made = design(tmp_path)
    text_of_rows = (tmp_path / "rows.csv").read_text()
    (tmp_path / "rows.csv").write_text(text_of_rows.replace(",", ";").replace(".", ","))
    other = read(text(BY_FILE), file=str(tmp_path / "turn.toml"))
    np.testing.assert_array_equal(lift_of(other, [1.0, 2.0]), lift_of(made, [1.0, 2.0]))
    told = [one for one in gearcam.build(other).facts.shown() if one.name.startswith("tables")]
    assert [one.value for one in told] == ["read with semicolons and decimal commas"]


def test_both_ways_to_give_a_motion_are_told_where_there_is_none() -> None:
    (problem,) = problems('kind = "cam"\nname = "x"\n' + ROLLER)
    assert "[[motion]] for each phase" in problem.allowed
    assert "or one [motion] with rows or lift" in problem.allowed
    stray = problems(text(BY_LISTS, ROLLER.replace("[cam]", "[cam]\nsmoothing_tolerance_mm = 1")))
    assert "belongs under [motion]" in str(stray[0])


def test_the_made_profile_gives_back_the_rows(tmp_path: Path) -> None:
    """Measured, smoothed, cut within 1 um, and followed again: within both tolerances."""
    result = gearcam.build(gearcam.load("profiles/measured_cam.toml"))
    measured = table(Path("profiles/measured_cam.csv").read_bytes().partition(b"\n")[2])
    asked = table(result.files("csv")["motion.csv"])
    off = asked["s"][:360] - measured["lift_mm"]
    told = result.facts["motion.deviation"]
    assert np.abs(off).max() == pytest.approx(abs(told), abs=1e-12)
    assert 0.0059 < abs(told) <= 0.006
    written = result.write(tmp_path, files=["csv", "dxf"])
    for name in ("profile.csv", "cam.dxf"):
        found = result.follow(written.directory / name).write(tmp_path)
        followed = table((found.directory / "followed.csv").read_bytes())
        # 1 um along the normal is less than 1.04 um of lift at 15.1 deg of pressure angle
        assert np.abs(followed["s"][:360] - measured["lift_mm"]).max() < 0.006 + 0.00104


def test_a_formula_closes_to_the_last_digit_and_shows_its_peaks() -> None:
    """A miss of typed digits is spread over the turn; a bump of a degree's width is seen."""
    near = gearcam.build(read(text('lift = "5*(1 - cos(theta)) + 1e-10*theta"'))).program
    start, end = near.lift([0.0, 2.0 * math.pi])
    assert end == pytest.approx(start, abs=1e-15)
    bump = gearcam.build(read(text('lift = "exp(-((theta - 2)/0.01)**2)"'))).program
    u = math.sqrt((48.0 - math.sqrt(48.0**2 - 4 * 16 * 12)) / 32.0)
    highest = (12.0 * u - 8.0 * u**3) * math.exp(-u * u) / 0.01**3
    assert bump.peaks[2] == pytest.approx(highest, rel=1e-9)


def test_the_error_of_a_function_is_told() -> None:
    function: Any = MotionFormula(lift=lambda x: 5.0 * np.exp(np.cos(x)))
    program = gearcam.build(
        CamDesign(
            name="f",
            motion=function,
            follower=FollowerSpec(type="roller", roller_radius=6.0),
            cam=CamSpec(prime_radius=30.0),
        )
    ).program
    theta = np.linspace(0.0, 6.28, 3000)
    error = np.abs(program.derivatives(theta, 0)[0] - 5.0 * np.exp(np.cos(theta))).max()
    assert 0.0 < error <= program.errors[0] < 1e-12


def test_remedies_are_sought_for_tables_too() -> None:
    """Only sizes of the cam can help: rows stay as they are."""
    deep = f"theta_deg = {THETA.tolist()}\nlift_mm = {(LIFT - 40.0).tolist()}"
    result = gearcam.build(read(text(deep)))
    with pytest.raises(InfeasibleError, match="onto the cam's axis"):
        result.profile  # noqa: B018
    found = gearcam.remedies(result, patience=3.0).found
    assert found
    assert {key for one in found for key in one.changes} == {"cam.prime_radius_mm"}


def test_a_formula_that_is_no_motion_is_refused_with_its_place() -> None:
    for lift, words in (
        (
            "theta",
            r"does not repeat after the turn \(motion\.lift\); value 6.283185307 mm, limit 0",
        ),
        ("2 + 0*theta", "the follower never moves"),
        ("5*(1 - cos(theta)) + abs(theta - 2)", "unknown"),
        ("sqrt(theta*(2*pi - theta))", r"its velocity is not finite|cannot be computed|not smooth"),
        ("1/(theta - 1)", "the lift is not"),
    ):
        with pytest.raises((InfeasibleError, DesignError), match=words):
            gearcam.build(read(text(f'lift = "{lift}"'))).program  # noqa: B018
    jumping = gearcam.build(read(text('lift = "5*sin(theta/2)"')))
    (jump,) = jumping.program.jumps
    assert (jump.theta, jump.order) == (0.0, 1)
    assert (jump.before, jump.after) == (pytest.approx(-2.5), pytest.approx(2.5))
