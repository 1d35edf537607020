"""Designs of cams: what a file says becomes phases, follower, cam and blank, in mm and rad."""

from __future__ import annotations

import math
import re
import tomllib
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from arch import rules
from claims.motion import MOTION_CLAIMS
from gearcam.base.errors import DesignError
from gearcam.cams.spec import CamSpec, FollowerSpec
from gearcam.designs import document_of, load, loads
from gearcam.designs.kind import KINDS
from gearcam.designs.template import template
from gearcam.designs.validate import faults_of
from gearcam.kinds.cam.design import CamDesign, CamOutputSpec
from gearcam.kinds.cam.tables import CamBlank
from gearcam.laws.motion import MOTION_LAWS
from gearcam.laws.phases_of_lift import (
    PHASES,
    DwellPhase,
    Phase,
    ReturnPhase,
    RisePhase,
    SegmentPhase,
)
from gearcam.parts.blank import WheelBlank
from gearcam.study_commands import studied
from helpers_files import FLAT, ROLLER, SWINGING, changed, read
from helpers_tables import phase_table, rise_table, turn_tables


def phases_of(design: CamDesign) -> tuple[Phase, ...]:
    assert isinstance(design.motion, tuple)
    return design.motion


def shape(law: str) -> Any:
    return MOTION_LAWS[law].parameters()


def test_the_plate_cam_with_a_roller_is_read() -> None:
    design = read(ROLLER)
    assert (design.kind, design.name, design.source) == ("cam", "plate_cam_offset_roller", "")
    quarter = math.pi / 2
    assert design.motion == (
        RisePhase(angle=quarter, law=shape("cycloidal"), lift=10.0),
        DwellPhase(angle=quarter),
        ReturnPhase(angle=quarter, law=shape("cycloidal")),
        DwellPhase(angle=quarter),
    )
    assert type(phases_of(design)[2]) is ReturnPhase
    assert design.follower == FollowerSpec(type="roller", roller_radius=6.0, offset=8.0)
    assert design.cam == CamSpec(prime_radius=30.0, thickness=12.0)
    assert not design.cam.clockwise
    assert design.blank == CamBlank()
    assert design.limits == {}
    assert design.output == CamOutputSpec(files=("dxf", "stl", "csv"))
    assert design.output.motion_step == pytest.approx(math.pi / 180, rel=1e-15)
    assert (design.output.inspection_points, design.output.tool_radius) == (360, None)


def test_the_cam_with_a_swinging_roller_is_read() -> None:
    design = read(SWINGING)
    first, _, third, _ = phases_of(design)
    assert isinstance(first, RisePhase)
    assert isinstance(third, ReturnPhase)
    assert (first.law, third.law) == (shape("modified-sine"), shape("3-4-5"))
    assert first.lift == pytest.approx(math.pi / 9, rel=1e-15)
    assert third.lift is None
    assert [phase.angle for phase in phases_of(design)] == pytest.approx(
        [2 * math.pi / 3, math.pi / 3, 2 * math.pi / 3, math.pi / 3], rel=1e-15
    )
    assert design.follower == FollowerSpec(
        type="roller", motion="oscillating", roller_radius=8.0, arm=90.0, pivot_distance=100.0
    )


def test_a_segment_carries_its_end_in_the_units_of_the_lift() -> None:
    segment = 'type = "segment"\nangle_deg = 90\nto_mm = 4\nend_velocity_mm_per_rad = 2\n'
    end = 'type = "segment"\nangle_deg = 90\nto_mm = 0\n'
    text = changed('type = "dwell"\nangle_deg = 90\n', segment)
    text = changed('type = "return"\nlaw = "cycloidal"\nangle_deg = 90\n', end, text)
    _, second, third, _ = phases_of(read(text))
    assert second == SegmentPhase(angle=math.pi / 2, to=4.0, velocity=2.0)
    assert third == SegmentPhase(angle=math.pi / 2, to=0.0)
    segment = segment.replace("_mm", "_deg") + "end_acceleration_deg_per_rad2 = 9\n"
    text = changed('type = "dwell"\nangle_deg = 60\n', segment.replace("90", "60"), SWINGING)
    _, second, _, _ = phases_of(read(text))
    assert isinstance(second, SegmentPhase)
    assert second.end == pytest.approx((math.radians(4), math.radians(2), math.pi / 20), rel=1e-15)


@pytest.mark.parametrize("name", ["rise", "return"])
def test_every_law_is_read_with_its_parameters(name: str) -> None:
    for law, claims in MOTION_CLAIMS.items():
        assert not set(phase_table(name).entries) & set(rise_table(law).entries), law
        assert not {"type", "law"} & set(rise_table(law).entries), law
        for claim in claims.values:
            document = tomllib.loads(ROLLER)
            number = 0 if name == "rise" else 2
            own = rise_table(law).document(claim.parameters)
            document["motion"][number] |= {"law": law, **own}
            phases = [_made(raw) for raw in document["motion"]]
            made = replace(read(ROLLER), motion=tuple(phases))
            assert document_of(made)["motion"][number].items() >= own.items()


def _made(raw: dict[str, Any]) -> Phase:
    """A phase from its keys, by another way than the reader's."""
    rest = {key: value for key, value in raw.items() if key not in ("type", "law")}
    values = phase_table(raw["type"]).inward(rest)
    if "law" in raw:
        own = rise_table(raw["law"]).inward(rest)
        values["law"] = MOTION_LAWS[raw["law"]].parameters(**own)
    return PHASES[raw["type"]](**values)


def test_a_cam_that_turns_clockwise_and_a_blank_of_single_values() -> None:
    blank = "[blank]\nbore_diameter_mm = 12\nbolts = 3\nbolt_circle_mm = 30\nbolt_diameter_mm = 4\n"
    text = changed("[output]", f'rotation = "cw"\n{blank}bolt_angle_deg = 90\n[output]')
    design = read(text + "theta_deg = 45\ntool_radius_mm = 5\n[limits]\nwall_mm = 2\n")
    assert design.cam.clockwise
    assert design.blank == CamBlank(
        bore_diameter=12.0,
        bolts=3,
        bolt_circle=30.0,
        bolt_diameter=4.0,
        bolt_angle=math.radians(90),
    )
    assert design.output.pose == math.radians(45)
    assert design.output.tool_radius == 5.0
    assert design.limits == {"wall": 2.0}


def test_the_table_of_a_law_lies_beside_the_design_file(tmp_path: Path) -> None:
    text = changed('"cycloidal"', '"table"\nfile = "points.csv"')
    (tmp_path / "cam.toml").write_text(text)
    with pytest.raises(DesignError, match=re.escape("motion[0].file")):
        load(tmp_path / "cam.toml")
    (tmp_path / "points.csv").write_text("x,y\n0,0\n0.4,0.3\n0.7,0.8\n1,1\n")
    (rise, *_) = phases_of(read(text, file=str(tmp_path / "cam.toml")))
    assert isinstance(rise, RisePhase)
    assert rise.law.file == str(tmp_path / "points.csv")


@pytest.mark.parametrize("text", [ROLLER, SWINGING, FLAT], ids=["roller", "swinging", "flat"])
def test_a_design_made_in_python_equals_the_one_read(text: str) -> None:
    one = read(text)
    made = CamDesign(
        name=one.name,
        motion=tuple(_made(raw) for raw in tomllib.loads(text)["motion"]),
        follower=replace(one.follower),
        cam=replace(one.cam),
        output=CamOutputSpec(files=one.output.files),
    )
    assert made.motion == one.motion
    assert document_of(made) == document_of(one)
    (again,) = [CamDesign(**vars(one))]
    assert document_of(again) == document_of(one)
    document, given = document_of(one), tomllib.loads(text)
    assert document["motion"] == given["motion"]
    for title in ("follower", "cam", "output"):
        assert document[title].items() >= given[title].items()


def test_a_design_made_in_python_meets_the_same_rules() -> None:
    good = vars(read(ROLLER))

    def refused(words: str, **changes: Any) -> None:
        with pytest.raises(DesignError, match=words):
            CamDesign(**{**good, **changes})

    rise, dwell, *rest = good["motion"]
    refused("take 270 deg", motion=(rise, dwell, rest[0]))
    refused(r"motion\[1\]: is a int", motion=(rise, 3))
    refused("motion: is a int", motion=3)
    refused(r"motion\[0\].law: is a str", motion=(replace(rise, law="cycloidal"), dwell, *rest))
    refused("instance of FollowerSpec", follower=3)
    refused("instance of CamBlank", blank=None)
    refused("instance of CamOutputSpec", output=None)
    refused("blank.stop_pin: does not apply to a disc cam", blank=WheelBlank(stop_pin=2.0))
    refused("missing beside bolts", blank=WheelBlank(bolts=2))
    refused(r"limits\.no_such", limits={"no_such": 1.0})
    refused("out of range", cam=CamSpec(prime_radius=-1.0))
    design = CamDesign(**{**good, "motion": list(good["motion"]), "blank": WheelBlank(bolts=0)})
    assert design.motion == good["motion"]
    assert isinstance(design.blank, CamBlank)
    assert not design.blank.timing_marks
    with pytest.raises(DesignError, match='for designs of kind = "gear-pair"'):
        studied(KINDS["gear-pair"].studies["mesh"], design, {"steps": 3})
    drum = load(rules.ROOT / "profiles" / "cylinder_cam.toml")
    with pytest.raises(DesignError, match=r'not for kind = "cam" with cam\.form = "cylinder"'):
        studied(KINDS["cam"].studies["precision"], drum, {})


@pytest.mark.parametrize("kind", list(KINDS))
def test_the_template_reads_and_what_it_tells_of_may_be_written(kind: str) -> None:
    text = template(kind, "mine")
    assert loads(text).kind == kind
    assert loads(text).name == "mine"
    assert loads(template(kind)).name == f"my_{kind}".replace("-", "_")
    for title in (*KINDS[kind].tables, "limits"):
        known = KINDS[kind].table(title)
        head = f"[[{title}]]" if title in KINDS[kind].several else f"[{title}]"
        (part,) = re.findall(
            rf"^(?:# )?{re.escape(head)}(.*?)(?=^(?:# )?\[|\Z)", text, re.MULTILINE | re.DOTALL
        )
        shown = re.findall(r"^(?:# )?(\w+) = (.*?) +#", part, re.MULTILINE)
        bare = re.findall(r"^# (\w+)  +#", part, re.MULTILINE)
        assert {key for key, _ in shown} | set(bare) == set(known.entries)
        for key, value in shown:
            faults = faults_of(known, tomllib.loads(f"{key} = {value}"), home=lambda *_: "")
            assert [fault.message for fault in faults if fault.message != "is missing"] == []


def test_the_template_shows_every_phase_and_every_law() -> None:
    text = template("cam")
    assert re.search(r'^angle_deg = "rest" +#', text, re.MULTILINE)
    (part,) = re.findall(r"^# \[motion\]\n(.*?)^$", text, re.MULTILINE | re.DOTALL)
    for key in (key for known in turn_tables() for key in known.entries):
        assert re.search(rf"^# (?:{key} = |  or {key}: )", part, re.MULTILINE), key
    for name in PHASES:
        assert re.search(rf'^(# )?type = "{name}" +#', text, re.MULTILINE)
        for key in phase_table(name).entries:
            assert re.search(rf"^(# )?{key} = ", text, re.MULTILINE), key
    for law in MOTION_LAWS:
        (part,) = re.findall(
            rf'^# law = "{law}"(.*?)(?:^#?$|\Z)', text, re.MULTILINE | re.DOTALL
        ) or [""]
        assert part or law == "cycloidal"
        for key, value in re.findall(r"^# (\w+) = (.*?) +#", part, re.MULTILINE):
            assert key in rise_table(law).entries
            tomllib.loads(f"{key} = {value}")
