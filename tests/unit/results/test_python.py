"""What the package gives to people who write Python: designs as values, results that travel."""

from __future__ import annotations

import copy
import json
import pickle
from concurrent.futures import ProcessPoolExecutor
from dataclasses import fields, replace
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import gearcam as gc
from gearcam.base.errors import (
    Adjustment,
    DesignError,
    InfeasibleError,
    MissingExtraError,
    Problem,
    WriteError,
)
from gearcam.base.tolerances import Tolerances
from gearcam.designs.design import document_of
from helpers_sampling import few

PROFILES = sorted(Path("profiles").glob("*.toml"))
PAIR: dict[str, Any] = {
    "kind": "gear-pair",
    "name": "mine",
    "law": {"type": "ellipse", "eccentricity": 0.3},
    "pair": {"teeth": [20, 20], "module_mm": 2.0},
}


@pytest.mark.parametrize("path", few(PROFILES, 3), ids=lambda path: path.stem)
def test_designs_compare_by_value_and_come_back_from_their_documents(path: Path) -> None:
    one, two = gc.load(path), gc.load(path)
    assert one == two
    assert hash(one) == hash(two)
    assert pickle.loads(pickle.dumps(one)) == one == copy.deepcopy(one)
    assert gc.design(document_of(one)) == one
    assert one.with_({"name": "other"}) != one
    assert "\n" not in repr(one) and len(repr(one)) < 80  # noqa: PT018


def test_designs_of_two_tables_differ_where_only_their_rows_do(tmp_path: Path) -> None:
    text = Path("profiles/measured.toml").read_text(encoding="utf-8")
    rows = Path("profiles/measured.csv").read_text(encoding="utf-8").splitlines()
    made = []
    for name, drop in (("one", None), ("two", 10), ("three", None)):
        (tmp_path / name).mkdir()
        (tmp_path / name / "measured.csv").write_text(
            "\n".join(row for k, row in enumerate(rows) if k != drop), encoding="utf-8"
        )
        (tmp_path / name / "measured.toml").write_text(text, encoding="utf-8")
        made.append(gc.load(tmp_path / name / "measured.toml"))
    assert made[0] != made[1]
    assert made[0] == made[2]
    assert made[0] != "measured"


def test_a_design_is_made_of_a_dict_with_the_numbers_of_numpy() -> None:
    pair = {"teeth": tuple(np.array([20, 20])), "module_mm": np.float64(2.0)}
    design = gc.design({**PAIR, "pair": pair})
    assert design == gc.design(PAIR)
    assert design.pair.module == 2.0  # pyright: ignore
    text = 'kind = "gear-pair"\nname = "mine"\n[law]\ntype = "ellipse"\neccentricity = 0.3\n'
    assert design == gc.loads(text + "[pair]\nteeth = [20, 20]\nmodule_mm = 2\n")


@pytest.mark.parametrize(
    ("change", "key", "words"),
    [
        ({"law.eccentricity": 1.5}, "law.eccentricity", "1.5 is out of range"),
        ({"law.eccentricty": 0.2}, "law.eccentricty", "did you mean eccentricity?"),
        ({"pair.teeth[2]": 7}, "pair.teeth[2]", "there is no such key or index"),
        ({"pair.teeth[2]": 7}, "pair.teeth[2]", "a number from 0 to 1 in the brackets"),
        ({"name.first": 7}, "name.first", "there is no such key or index"),
        ({"limits.contact_ratio": "high"}, "limits.contact_ratio", "is not a number"),
    ],
)
def test_bad_changes_are_refused_with_the_words_of_a_file(
    change: dict[str, object], key: str, words: str
) -> None:
    design = gc.design(PAIR)
    with pytest.raises(DesignError) as caught:
        design.with_(change)
    (problem,) = caught.value.problems
    assert problem.key == key
    assert problem.line is None
    assert words in str(problem)
    assert design == gc.design(PAIR)


def test_a_changed_design_is_a_checked_copy() -> None:
    design = gc.design(PAIR)
    other = design.with_({"law.eccentricity": 0.4, "limits.contact_ratio": 1.3})
    assert document_of(other)["law"]["eccentricity"] == 0.4
    assert other.limits["contact_ratio"] == 1.3
    assert document_of(design) == document_of(gc.design(PAIR))
    assert design.with_({"pair.teeth": np.array([30, 30])}) == design.with_(
        {"pair.teeth": [30, 30]}
    )
    with pytest.raises(DesignError, match="law: unknown table"):
        design.with_({"kind": "cam"})


ERRORS = (
    DesignError([Problem("is wrong", "a.toml", 3, "law.type", 1, "this", "that"), Problem("too")]),
    InfeasibleError(
        "cannot be", where="here", value=1.0, limit=2.0, unit="mm", nearest="no",
        adjustments=[Adjustment(near={"pair.x": 0.1})], more_teeth=1.5,
    ),
    MissingExtraError("STEP files", "step"),
    MissingExtraError("solids", packages="one two"),
    WriteError(28, "no space left", "a.dxf"),
)  # fmt: skip


@pytest.mark.parametrize("error", ERRORS, ids=lambda error: type(error).__name__)
def test_errors_pickle_whole(error: Exception) -> None:
    back = pickle.loads(pickle.dumps(error))
    assert type(back) is type(error)
    assert str(back) == str(error)
    assert vars(back) == vars(error)


def test_a_result_travels_as_its_design_and_is_computed_again() -> None:
    result = gc.build(gc.design(PAIR))
    result.tolerances = Tolerances(oversampling=5)
    outline = result.gear1.outline
    assert repr(result) == '<GearPairResult of "mine", computed: law, centrodes, gear1>'
    back = pickle.loads(pickle.dumps(result))
    assert back.tolerances == result.tolerances
    assert not back.timings
    assert (back.gear1.outline == outline).all()


def _built(design: Any) -> tuple[bytes, ...]:
    """What comes of a design, to the last bit; the times that it took and what was loaded apart."""
    result = gc.build(design)
    told = result.to_dict()
    del told["timings_s"], told["versions"]
    wheels = result.gears if told["kind"] == "gear-pair" else (result.cam,)
    arrays = [wheel.outline for wheel in wheels] + list(result.motion([0.1, 1.0]).values())
    return json.dumps(told).encode(), *(array.tobytes() for array in arrays)


@pytest.mark.slow
@pytest.mark.parametrize("count", [10, 100])
def test_a_pool_of_two_builds_the_same_to_the_last_bit(count: int) -> None:
    pair = gc.design({**PAIR, "output": {"chord_tolerance_mm": 0.01}})
    cam = gc.load("profiles/eccentric_cam.toml").with_({"output.files": ["csv"]})
    half = count // 2
    designs = [pair.with_({"law.eccentricity": e}) for e in np.linspace(0.01, 0.4, half)]
    designs += [cam.with_({"output.chord_tolerance_mm": t}) for t in np.linspace(1e-3, 0.02, half)]
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        found = list(pool.map(_built, designs, chunksize=half // 5))
    assert found == [_built(design) for design in designs]
    assert len(set(found)) == count


def test_names_at_the_top_are_shown_and_brought_in_when_asked_for() -> None:
    names = dir(gc)
    for name in names:
        assert getattr(gc, name) is not None
    assert {"GearPairDesign", "CamDesign", "PairSpec", "RisePhase", "FollowerSpec", "laws"} <= {
        *names
    }
    assert {"Ellipse", "Phases"} <= {*dir(gc.laws)}
    assert "Cycloidal" in dir(gc.motion_laws)
    with pytest.raises(AttributeError, match="gearcam has no Gearpair"):
        gc.Gearpair  # noqa: B018  # pyright: ignore
    with pytest.raises(AttributeError, match="there is no law Elipse"):
        gc.laws.Elipse  # noqa: B018  # pyright: ignore


def test_a_design_is_made_of_what_the_top_gives() -> None:
    namespace: Any = gc
    design = namespace.GearPairDesign(
        name="mine",
        law=namespace.laws.Ellipse(eccentricity=0.3),
        pair=namespace.PairSpec(teeth=(20, 20), module=2.0),
    )
    assert design == gc.design(PAIR)
    assert design.law_type == "ellipse"


ANY: Any = gc
UP = ANY.RisePhase(angle=2.0, law=ANY.motion_laws.Cycloidal(), lift=0.2)
PHASES = [UP, ANY.SegmentPhase(angle=1.0, to=0.1, velocity=-0.05), ANY.ReturnPhase(
    angle="rest", law=ANY.motion_laws.Polynomial345()
)]  # fmt: skip
SLIDING = ANY.FollowerSpec(type="roller", roller_radius=6.0)
SWINGING = ANY.FollowerSpec(
    type="roller", motion="oscillating", roller_radius=6.0, arm=90.0, pivot_distance=100.0
)


def cam(motion: Any, follower: Any = SLIDING, **more: Any) -> Any:
    size = ANY.CamSpec(prime_radius=40.0, thickness=8.0)
    return ANY.CamDesign(name="mine", motion=motion, follower=follower, cam=size, **more)


def test_a_phase_says_each_thing_once_in_the_unit_of_its_follower() -> None:
    names = [[item.name for item in fields(phase)] for phase in PHASES]
    assert names == [
        ["angle", "law", "lift"],
        ["angle", "to", "velocity", "acceleration"],
        ["angle", "law", "lift"],
    ]
    for follower, unit, scale in ((SLIDING, "mm", 1.0), (SWINGING, "deg", 180.0 / np.pi)):
        design = cam(PHASES, follower)
        up, segment, _ = design.to_dict()["motion"]
        assert up == {
            "type": "rise",
            "law": "cycloidal",
            "angle_deg": pytest.approx(360.0 / np.pi),
            f"lift_{unit}": pytest.approx(0.2 * scale),
        }
        assert segment[f"to_{unit}"] == pytest.approx(0.1 * scale)
        assert segment[f"end_velocity_{unit}_per_rad"] == pytest.approx(-0.05 * scale)
        assert gc.design(design.to_dict()) == design
        assert gc.build(design).program.range == pytest.approx((0.0, 0.2))


def test_lists_and_arrays_become_tuples_of_plain_numbers() -> None:
    x = np.linspace(0.0, 1.0, 5)
    law = ANY.motion_laws.TableRise(x=x, y=[0.0, 0.1, 0.5, 0.9, np.float64(1.0)])
    design = cam(
        [replace(UP, law=law), ANY.ReturnPhase(angle="rest", law=ANY.motion_laws.Cycloidal())]
    )
    assert design.motion[0].law.x == (0.0, 0.25, 0.5, 0.75, 1.0)
    assert type(design.motion[0].law.y[4]) is float
    assert gc.build(design).program.range == pytest.approx((0.0, 0.2))
    angles = np.radians(np.arange(0.0, 361.0, 10.0))
    table = ANY.laws.TableLaw(phi1=angles, ratio=1.0 + 0.1 * np.cos(angles))
    pair = ANY.PairSpec(teeth=np.array([20, 20]), module=2.0)
    made = ANY.GearPairDesign(name="mine", law=table, pair=pair)
    assert made.law.phi1 == tuple(angles)
    assert made.pair.teeth == (20, 20)
    assert hash(made.law) == hash(replace(made.law))
    kept = ANY.laws.Ellipse(eccentricity=0.3)
    assert ANY.GearPairDesign(name="mine", law=kept, pair=pair).law is kept


@pytest.mark.parametrize(
    ("changes", "key", "words"),
    [
        ({"motion": [replace(UP, lift=None)]}, "motion[0].lift_mm", "is missing"),
        ({"motion": [replace(UP, angle="rest", lift=-1.0)]}, "motion[0].lift_mm", "out of range"),
        (
            {"motion": [replace(UP, angle="all")]},
            "motion[0].angle_deg",
            "is not one of the allowed words",
        ),
        ({"motion": [replace(UP, law="cycloidal")]}, "motion[0].law", "is a str"),
        ({"motion": [replace(UP, law=ANY.laws.Constant())]}, "motion[0].law", "is a Constant"),
        ({"motion": [PHASES[1], 3]}, "motion[1]", "is a int"),
        ({"motion": 3}, "motion", "is a int"),
        ({"motion": PHASES, "limits": 3}, "limits", "is a int"),
        ({"motion": PHASES, "limits": {"wall": "thin"}}, "limits.wall_mm", "is not a number"),
        ({"motion": PHASES, "name": 3}, "name", "is not text"),
        ({"motion": PHASES, "follower": "roller"}, "follower", "is a str"),
    ],
)
def test_bad_arguments_are_refused_with_their_names(
    changes: dict[str, Any], key: str, words: str
) -> None:
    size = ANY.CamSpec(prime_radius=40.0, thickness=8.0)
    given = {"name": "mine", "follower": SLIDING, "cam": size, **changes}
    with pytest.raises(DesignError, match=words) as caught:
        ANY.CamDesign(**given)
    assert key in [problem.key for problem in caught.value.problems]
    pickle.loads(pickle.dumps(caught.value))


@pytest.mark.parametrize(
    ("take", "name", "given"),
    [
        (gc.build, "design", "pair.toml"),
        (gc.build, "design", PAIR),
        (gc.load, "path", 3),
        (gc.loads, "text", b"name"),
        (gc.design, "document", [PAIR]),
        (gc.design(PAIR).with_, "changes", "name"),
        (gc.remedies, "result", gc.design(PAIR)),
    ],
)
def test_arguments_of_other_types_are_refused_by_name(take: Any, name: str, given: Any) -> None:
    with pytest.raises(DesignError, match=f"^{name}: is a {type(given).__name__}\\n") as caught:
        take(given)
    assert caught.value.problems[0].key == name


def test_a_line_of_a_text_is_told_as_one() -> None:
    with pytest.raises(DesignError, match=r"^line 2: an = is missing after the key"):
        gc.loads('name = "mine"\nkind')


def test_one_kind_of_file_is_enough(tmp_path: Path) -> None:
    assert gc.build(gc.design(PAIR)).write(tmp_path, files="csv").files[-1] == "summary.json"


def test_a_value_for_both_wheels_is_two() -> None:
    design = gc.design({**PAIR, "blank": {"bore_diameter_mm": 6.0}})
    for bore in (6.0, (6.0, 6.0)):
        assert replace(design, blank=gc.Blank(bore_diameter=bore)) == design
    assert replace(design, blank=gc.Blank(bore_diameter=(6.0, 5.0))) != design


def test_a_result_is_computed_to_given_tolerances() -> None:
    design, tolerances = gc.design(PAIR), Tolerances(oversampling=5)
    assert gc.build(design, tolerances).tolerances == tolerances
    assert gc.build(design).tolerances == Tolerances()
