# pyright: strict
"""The public interface as people write it who check types strictly (see test_types.py)."""

from __future__ import annotations

from concurrent.futures import ProcessPoolExecutor
from typing import TYPE_CHECKING, assert_type

import numpy as np
from numpy.typing import NDArray

import gearcam as gc

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Floats = NDArray[np.float64]


def ratio(phi1: Floats) -> Floats:
    return 1.0 - 0.3 * np.cos(phi1)


def pair_of(eccentricity: float) -> gc.GearPairDesign:
    return gc.GearPairDesign(
        name="mine",
        law=gc.laws.Ellipse(eccentricity=eccentricity),
        pair=gc.PairSpec(teeth=(20, 20), module=2.0),
        rack=gc.Rack(pressure_angle=np.radians(25.0)),
        blank=gc.Blank(bore_diameter=(10.0, 12.0), tip_rounding=(0.1, 0.1)),
        limits={"contact_ratio": 1.2},
    )


def laws_of_other_kinds() -> tuple[object, ...]:
    angles = np.radians(np.arange(0.0, 361.0, 10.0))
    return (
        gc.laws.Formula(ratio="1 - 0.3*cos(phi1)"),
        gc.laws.Formula(ratio=ratio),
        gc.laws.Phases(knots=(0.0, 3.0, 2.0 * np.pi), ratios=(1.6, "solve", 1.6)),
        gc.laws.TableLaw(phi1=angles, ratio=ratio(angles)),
        gc.laws.Fourier(cosines=[0.1, 0.02]),
        gc.motion_laws.TableRise(x=angles, y=angles**2),
    )


def least(design: gc.GearPairDesign) -> float:
    return gc.build(design).contact_ratio


def sweep() -> list[float]:
    first = pair_of(0.1)
    designs = [first.with_({"law.eccentricity": e, "name": f"e{e:.1f}"}) for e in (0.2, 0.3)]
    assert_type(designs, list[gc.GearPairDesign])
    with ProcessPoolExecutor(2) as pool:
        return list(pool.map(least, designs))


def of_pairs(design: gc.GearPairDesign, ax: Axes) -> Floats:
    result = gc.build(design)
    assert_type(result, gc.GearPairResult)
    assert_type(result.contact_ratio, float)
    module: float = result.facts["pair.module_mm"]
    print(result.facts, module, *(fact.text for fact in result.facts.shown()))
    table = result.motion(np.linspace(0.0, 1.0, 5))
    assert_type(table, gc.Columns)
    for name, column in result.contact(0.1, side="coast").items():
        print(name, column.shape, result.centrodes(100)["r1_mm"].max())
    for part in result.parts:
        print(part.name, part.outline.shape)
    study = result.mesh(steps=36, center_distance_mm=40.1)
    assert_type(study, gc.StudyResult)
    print(study.columns["lag_rad"], study.facts, study.findings, study.complete)
    print([mesh.volume for mesh in result.solids.values()], result.gear1.flanks.points)
    print(result.plot("ratio", ax).get_title(), result.charts, result.to_dict()["hash"])
    written = result.write("output", files=["dxf"])
    print(written.directory / written.files[0], result.gear2.outline.T)
    return result.gear1.outline


def cams(theta: Floats, lift: Floats) -> gc.CamResult:
    follower = gc.FollowerSpec(type="roller", roller_radius=6.0)
    size = gc.CamSpec(prime_radius=40.0, thickness=8.0)
    up = gc.RisePhase(angle=2.0, law=gc.motion_laws.Cycloidal(), lift=10.0)
    back = gc.ReturnPhase(angle=2.0, law=gc.motion_laws.Polynomial345())
    phases = [up, gc.DwellPhase(angle=1.0), back, gc.DwellPhase(angle="rest")]
    gc.CamDesign(name="phases", motion=phases, follower=follower, cam=size)
    gc.CamDesign(name="formula", motion=gc.MotionFormula(lift=np.sin), follower=follower, cam=size)
    motion = gc.MotionTable(theta=theta, lift=lift, smoothing_tolerance=0.01)
    design = gc.CamDesign(name="rows", motion=motion, follower=follower, cam=size)
    result = gc.build(design.with_({"cam.rotation": "cw"}))
    assert_type(result, gc.CamResult)
    study = result.follow(result.cam.outline)
    print(study.facts["followed.largest_difference"], result.motion(0.5)["lift_mm"])
    return result


def from_elsewhere(path: str) -> Floats | None:
    try:
        design = gc.load(path)
    except gc.DesignError as error:
        print([(problem.key, problem.line, problem.hint) for problem in error.problems])
        return None
    print(design.name, design.kind, design.limits, design.to_dict())
    if isinstance(design, gc.CamDesign):
        return gc.build(design).cam.outline
    if not isinstance(design, gc.GearPairDesign):
        return None
    try:
        result = gc.build(design)
        print([(f.severity, f.code, f.value, f.limit, f.where) for f in result.findings])
    except gc.InfeasibleError as refusal:
        print(refusal.what, refusal.where, refusal.value, refusal.limit)
        remedies = gc.remedies(gc.build(design), refusal, patience=1.0)
        print([remedy.changes for remedy in remedies.found])
        return None
    return result.gear1.outline


def show(result: gc.Result, columns: gc.Columns, facts: gc.Facts) -> str:
    errors = [finding for finding in result.findings if finding.severity == "error"]
    return f"{result.design.name}: {len(errors)} errors, {len(facts)} facts, {len(columns)} columns"
