"""Designs with Python functions: the same wheels as of a text, and what no file can do."""

from __future__ import annotations

import copy
import json
import math
import pickle
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import gearcam
from gearcam.base.errors import DesignError, InfeasibleError
from gearcam.base.tolerances import DEFAULT
from gearcam.laws.motion.formula import FormulaRise
from gearcam.laws.motion.simple import Cycloidal
from gearcam.laws.program import make_program
from gearcam.laws.ratio.ellipse import Ellipse
from gearcam.laws.ratio.formula import Formula, RackLaw
from gearcam.laws.ratio.position import MotionLaw
from gearcam.laws.ratio.span import ONE_LOBE, Lobes
from helpers_cams import back, dwell, rise
from helpers_processes import Bent, swing

gc: Any = gearcam
TEXT = "phi1 - 0.6*sin(phi1)"
TURN = 2.0 * math.pi
PLACES = np.linspace(0.0, TURN, 721)


def pair(law: Any, **changes: Any) -> Any:
    given: dict[str, Any] = {"teeth": (40, 40), "module": 2.0, **changes}
    return gc.GearPairDesign(name="mine", law=law, pair=gc.PairSpec(**given))


def cam(formula: Any) -> Any:
    return gc.CamDesign(
        name="mine",
        motion=(rise("formula", 150.0, 10.0, formula=formula), dwell(60.0), back("2-3", 150.0)),
        follower=gc.FollowerSpec(type="roller", roller_radius=6.0),
        cam=gc.CamSpec(prime_radius=40.0, thickness=8.0),
    )


# --- the same as of a text ------------------------------------------------------------------------


@pytest.mark.parametrize(
    "function",
    [
        lambda phi1: phi1 - 0.6 * np.sin(phi1),
        swing,
        (swing, lambda phi1: 1 - 0.6 * np.cos(phi1), lambda phi1: 0.6 * np.sin(phi1)),
    ],
    ids=["arrays", "floats", "derivatives"],
)
def test_the_wheels_of_a_function_are_those_of_its_text(function: Any) -> None:
    one, two = gc.build(pair(Formula(phi2=function))), gc.build(pair(Formula(phi2=TEXT)))
    exact = PLACES - 0.6 * np.sin(PLACES), 1.0 - 0.6 * np.cos(PLACES)
    np.testing.assert_allclose(one.law.derivatives(PLACES, 1), exact, rtol=0, atol=2e-15)
    told = one.facts["accuracy.flank_mm"] + two.facts["accuracy.flank_mm"]
    assert told < 1e-11  # of 60 mm
    for mine, known in zip(one.gears, two.gears, strict=True):
        # vertices may be elsewhere along the curve as well
        np.testing.assert_allclose(mine.outline, known.outline, rtol=0.0, atol=2.0 * told)


def test_an_ellipse_by_its_radius_is_the_ellipse() -> None:
    e = 0.3
    mine = Formula(r1=lambda phi1: 5.0 / (1.0 + e * np.cos(phi1)))
    known = Ellipse(eccentricity=e)
    one, two = (law.build(ONE_LOBE, DEFAULT) for law in (mine, known))
    difference = np.abs(np.subtract(one.derivatives(PLACES, 3), two.derivatives(PLACES, 3)))
    assert (difference.max(axis=1) < [1e-14, 1e-14, 1e-13, 1e-11]).all()
    a, b = gc.build(pair(mine)), gc.build(pair(known))
    np.testing.assert_allclose(a.gear1.outline, b.gear1.outline, rtol=0.0, atol=1e-11)


def test_a_cycloidal_function_is_the_cycloidal_rise() -> None:
    def cycloidal(x: Any) -> Any:
        return x - np.sin(TURN * x) / TURN

    phases = (rise("formula", 150.0, 10.0, formula=cycloidal), back("cycloidal", 210.0))
    known = (rise("cycloidal", 150.0, 10.0), back("cycloidal", 210.0))
    one, two = (make_program(many, DEFAULT) for many in (phases, known))
    np.testing.assert_allclose(
        one.derivatives(PLACES, 3), two.derivatives(PLACES, 3), rtol=0.0, atol=1e-12
    )
    assert one.continuity == two.continuity == 2
    assert 0.0 < one.errors[0] < 1e-13
    assert max(two.errors) == 0.0
    assert one.peaks == pytest.approx(two.peaks, rel=1e-13)


def test_a_slide_and_a_rack_of_functions_are_those_of_texts() -> None:
    def position(phi1: Any) -> Any:
        led = phi1 - 0.2 * np.sin(phi1)
        return 1 - np.cos(led) + 3 * (1 - np.sqrt(1 - (np.sin(led) / 3) ** 2))

    law = MotionLaw(slide=position, rod=3.0).build(ONE_LOBE, DEFAULT)
    exact = PLACES - 0.2 * np.sin(PLACES), 1.0 - 0.2 * np.cos(PLACES)
    found = law.derivatives(PLACES, 1)
    for one, two in zip(found, exact, strict=True):
        np.testing.assert_allclose(one, two, rtol=0.0, atol=1e-12)
    assert np.abs(found[0] - exact[0]).max() <= law.error < 1e-12
    radii = RackLaw(r1=lambda phi1: 1 + 0.2 * np.cos(phi1)).build(ONE_LOBE, DEFAULT)
    np.testing.assert_allclose(radii.phi2(PLACES), PLACES + 0.2 * np.sin(PLACES), atol=1e-14)
    with pytest.raises(InfeasibleError, match="slide needs more than 96 harmonics"):
        MotionLaw(slide=lambda phi1: phi1 * (6 - phi1), rod=3.0).build(ONE_LOBE, DEFAULT)


REFUSED: dict[str, tuple[str, str, Any, Lobes]] = {
    "turning back": ("phi2", "phi1 - 1.2*sin(phi1)", lambda x: x - 1.2 * np.sin(x), ONE_LOBE),
    "not closed": ("phi2", "1.1*phi1", lambda x: 1.1 * x, ONE_LOBE),
    "a corner at the end": ("r1", "2 + sin(phi1/2)", lambda x: 2 + np.sin(x / 2), ONE_LOBE),
    "a step at the end": ("r1", "2 + phi1", lambda x: 2 + x, ONE_LOBE),
    "negative": ("ratio", "cos(phi1)", np.cos, ONE_LOBE),
    "not finite": ("r1", "1/(phi1 - pi)", lambda x: 1 / (x - np.pi), ONE_LOBE),
    "not repeated": ("ratio", "1 + 0.1*cos(phi1)", lambda x: 1 + 0.1 * np.cos(x), Lobes(2, 1)),
    "another second lobe": (
        "r1",
        "3 + 0.1*cos(2*phi1) + 0.1*exp(-((phi1 - 4.5)*9)**2)",
        lambda x: 3 + 0.1 * np.cos(2 * x) + 0.1 * np.exp(-(((x - 4.5) * 9) ** 2)),
        Lobes(2, 1),
    ),
}


@pytest.mark.parametrize("name", REFUSED)
def test_a_function_is_refused_with_the_words_of_its_text(name: str) -> None:
    field, text, function, lobes = REFUSED[name]
    said = []
    for given in (text, function):
        law: Any = {field: given}
        with pytest.raises(InfeasibleError) as caught:
            Formula(**law).build(lobes, DEFAULT)
        said.append(caught.value)
    assert said[0].what == said[1].what
    assert said[0].where == said[1].where


def test_a_corner_is_refused_with_its_angle_and_a_remedy_that_works() -> None:
    def bent(phi1: Any) -> Any:
        return 1.0 + 0.1 * np.abs(np.sin(phi1 - 1.0))

    words = r"r1 is not smooth \(phi1 = 57\.29\d* deg\)"
    with pytest.raises(InfeasibleError, match=words) as caught:
        _ = gc.build(pair(Formula(r1=bent))).law
    assert 'the law "table"' in caught.value.nearest
    phi1 = np.linspace(0.0, TURN, 361)
    law = gc.laws.TableLaw(phi1=tuple(phi1), r1=tuple(bent(phi1)))
    assert gc.build(pair(law)).law.closure_error < 1e-9

    def parabolas(x: Any) -> Any:
        return np.where(x < 0.5, 2 * x**2, 1 - 2 * (1 - x) ** 2)

    with pytest.raises(InfeasibleError, match=r"S is not smooth \(motion.formula, x = 0.5\)") as no:
        FormulaRise(formula=parabolas).build(DEFAULT)
    assert 'law "table"' in no.value.nearest
    x = np.linspace(0.0, 1.0, 41)
    rows = gc.motion_laws.TableRise(x=tuple(x), y=tuple(parabolas(x)))
    assert abs(rows.build(DEFAULT).function(0.3) - 0.18) < 1e-6
    with pytest.raises(InfeasibleError, match=r"must give 1 at x = 1 .*value 2.*divide by 2"):
        FormulaRise(formula=lambda x: 2 * x**3).build(DEFAULT)


# --- designs as values ----------------------------------------------------------------------------


def test_functions_compare_by_identity() -> None:
    one, other = (lambda x: x - 0.1 * np.sin(x)), (lambda x: x - 0.1 * np.sin(x))
    design = pair(Formula(phi2=one))
    assert design == pair(Formula(phi2=one))
    assert hash(design) == hash(pair(Formula(phi2=one)))
    assert design != pair(Formula(phi2=other))
    assert design != pair(Formula(phi2=(one, other)))
    assert design != pair(Formula(phi2=TEXT)) != design
    assert copy.deepcopy(design) == design == copy.copy(design)
    changed = design.with_({"pair.module_mm": 3.0})
    assert changed.law.phi2 is one
    assert changed != design
    assert design.with_({"law.phi2": TEXT}) == pair(Formula(phi2=TEXT))
    assert cam(one).with_({"motion[0].lift_mm": 8.0}).motion[0].law.formula is one


def test_a_document_takes_functions_and_none_gives_them() -> None:
    document = {"kind": "gear-pair", "name": "mine", "pair": {"teeth": [40, 40], "module_mm": 2.0}}
    design = gc.design({**document, "law": {"type": "formula", "phi2": (swing, Bent(0.6))}})
    assert design.law.phi2[0] is swing
    assert isinstance(design.law.phi2, tuple)
    for made, key in ((pair(Formula(r1=swing)), "law.r1"), (cam(swing), "motion[0].formula")):
        with pytest.raises(DesignError, match=r"Python function \S+swing cannot be written to a"):
            made.to_dict()
        with pytest.raises(DesignError) as caught:
            made.to_dict()
        assert [problem.key for problem in caught.value.problems] == [key]
    assert gc.design(pair(Formula(phi2=TEXT)).to_dict()) == pair(Formula(phi2=TEXT))


@pytest.mark.parametrize(
    ("law", "key", "words"),
    [
        (Formula(phi2=3.0), "law.phi2", "3.0 is not text"),  # pyright: ignore
        (Formula(phi2=(swing, 1)), "law.phi2", "is not text"),  # pyright: ignore
        (Formula(phi2=()), "law.phi2", "is not text"),
        (Formula(phi2=swing, r1=lambda x: x), "law.r1", "is given beside phi2 = a Python"),
        (Ellipse(eccentricity=swing), "law.eccentricity", "is not a number"),  # pyright: ignore
    ],
)
def test_what_is_neither_text_nor_function_is_refused(law: Any, key: str, words: str) -> None:
    with pytest.raises(DesignError, match=words) as caught:
        pair(law)
    assert [problem.key for problem in caught.value.problems] == [key]
    back = pickle.loads(pickle.dumps(caught.value))
    assert str(back) == str(caught.value)


def test_designs_pickle_where_their_functions_do() -> None:
    for function in (swing, Bent(0.6)):
        result = gc.build(pair(Formula(phi2=function)))
        again = pickle.loads(pickle.dumps(result))
        assert (again.gear1.outline == result.gear1.outline).all()
        assert again.design_hash == result.design_hash
    design = pair(Formula(phi2=lambda x: x))
    for one in (design, gc.build(design), cam(lambda x: x)):
        with pytest.raises(DesignError, match=r"<lambda> cannot be pickled") as caught:
            pickle.dumps(one)
        (problem,) = caught.value.problems
        assert problem.key == ("motion[0].formula" if one.__class__ is gc.CamDesign else "law.phi2")


def test_files_are_made_and_the_summary_names_the_function(tmp_path: Path) -> None:
    result = gc.build(pair(Formula(phi2=swing)))
    written = result.write(tmp_path, files=["csv"])
    summary = json.loads((tmp_path / "mine" / "summary.json").read_text("utf-8"))
    law = {"type": "formula", "phi2": "Python function helpers_processes.swing"}
    assert summary["design"]["law"] == law
    assert "Python function" in summary["accuracy"]["how"]["driven_angle_rad"]
    assert len(written.files) > 2
    assert not result.check(tmp_path).summary.get("outdated")
    others = [pair(Formula(phi2=given)) for given in (swing, Bent(0.6), TEXT)]
    hashes = {gc.build(other).design_hash for other in others}
    assert len(hashes | {result.design_hash}) == 4
    assert set(gc.build(others[1]).check(tmp_path).summary["outdated"]) == set(summary["files"])


def test_the_error_of_a_function_is_told() -> None:
    facts = gc.build(pair(Formula(r1=lambda x: 3.0 + 0.2 * np.cos(x)))).facts
    plain = gc.build(pair(Formula(r1="3 + 0.2*cos(phi1)"))).facts
    assert plain["accuracy.driven_angle_rad"] < facts["accuracy.driven_angle_rad"] < 1e-13
    told = gc.build(cam(lambda x: x * x * (3 - 2 * x))).facts["accuracy"]
    assert "the lift" in told["how"]["profile_mm"]
    assert 0.0 < told["profile_mm"] < 1e-12


@pytest.mark.parametrize("name", ["phi2", "ratio", "r1"])
def test_the_error_of_a_function_that_scatters_is_that_of_its_values(name: str) -> None:
    small = 1e-12
    line = {"phi2": 1.0, "ratio": 0.0, "r1": 0.0}[name]

    def given(phi1: Any) -> Any:
        smooth = line * phi1 + (1.0 - line) * 3.0 + 0.2 * np.sin(phi1)
        return smooth + small * np.sin(1.7e12 * phi1)

    fields: Any = {name: given}
    law = Formula(**fields).build(ONE_LOBE, DEFAULT)
    size = {"phi2": 1.0, "ratio": TURN / 3.0, "r1": TURN * 4.0 / 6.0}[name]
    assert 0.5 * small * size < law.function_error < 2.0 * small * size
    assert law.function_error < law.error


def test_a_motion_may_be_run_backwards() -> None:
    given: dict[str, Any] = {"x_from": 2.0, "x_to": 0.0, "driver_travel": 3.0, "driven_travel": 2.0}
    one = MotionLaw(y=lambda x: x + 0.2 * np.tanh(9 * (x - 0.7)), **given)
    two = MotionLaw(y="x + 0.2*tanh(9*(x - 0.7))", **given)
    made = [
        law.build(ONE_LOBE, DEFAULT).derivatives(np.linspace(0.0, 3.0, 91), 2) for law in (one, two)
    ]
    for order, (mine, known) in enumerate(zip(*made, strict=True)):
        np.testing.assert_allclose(mine, known, rtol=0.0, atol=[3e-14, 5e-12, 5e-9][order])


def test_a_text_loads_nothing_that_functions_need() -> None:
    code = (
        "import sys, gearcam\n"
        "gearcam.build(gearcam.load('profiles/formula.toml')).law\n"
        "print('gearcam.laws.formula' in sys.modules, 'gearcam.laws.functions' in sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["True", "False"]


@pytest.mark.slow
def test_remedies_keep_the_function() -> None:
    design = pair(Formula(phi2=swing), teeth=(18, 18))
    found: Any = gearcam.remedies(gc.build(design)).found
    assert found
    assert all(remedy.design.law.phi2 is swing for remedy in found)


def test_a_function_that_fails_is_told_with_its_angle() -> None:
    def table(phi1: float) -> float:
        return {0.0: 0.0}[phi1]

    with pytest.raises(InfeasibleError, match=r"phi2 raises KeyError: 0\.003\d+ \(phi1 = 0\.17"):
        _ = gc.build(pair(Formula(phi2=table))).law


def test_cycloidal_is_what_it_is() -> None:
    """The closed form that the function above is held against."""
    x = np.linspace(0.0, 1.0, 11)
    np.testing.assert_allclose(
        Cycloidal().function()(x), x - np.sin(TURN * x) / TURN, rtol=0.0, atol=1e-15
    )
