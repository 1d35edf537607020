"""Files in inches, read back by programs that know nothing of gearcam: each says its unit."""

from __future__ import annotations

import io
import json
import math
import re
import zipfile
from typing import Any

import ezdxf
import numpy as np
import pytest
import trimesh
from ezdxf import bbox
from numpy.typing import NDArray

import gearcam
from gearcam.base.errors import DesignError
from gearcam.export.dxf_read import read_outline
from helpers_built import built
from helpers_pairs import PROFILES
from helpers_step import read_step

INCH = 25.4
ROUNDING = 1e-12
"""Relative error of a length that was divided by 25.4."""

SINGLE = 1e-6
"""The same in single precision, of lengths that are differences."""


@pytest.fixture(scope="module")
def inch() -> Any:
    return built(PROFILES / "inch_pair.toml")


@pytest.fixture(scope="module")
def mm(inch: Any) -> Any:
    """The same design with files in mm."""
    return built(inch.design.with_({"output.units": "mm"}))


def drawn(data: bytes) -> tuple[Any, NDArray[np.float64]]:
    document = ezdxf.read(io.StringIO(data.decode()))  # pyright: ignore[reportPrivateImportUsage]
    found = bbox.extents(document.modelspace())
    return document, np.array([*found.extmin, *found.extmax])


@pytest.mark.parametrize(
    "style", [{}, {"dxf_curves": "splines"}, {"dxf_curves": "lines"}, {"dxf_version": "R12"}],
    ids=lambda style: "-".join(style.values()) or "arcs",
)  # fmt: skip
def test_dxf(inch: Any, mm: Any, style: dict[str, str]) -> None:
    changes: dict[str, Any] = {f"output.{key}": value for key, value in style.items()}
    if style:  # fewer points
        changes["output.chord_tolerance_mm"] = 0.02
    here, there = (built(one.design.with_(changes)) for one in (inch, mm))
    measured: dict[str, Any] = {}
    files, others = here.files("dxf", measured), there.files("dxf")
    assert files.keys() == others.keys()
    for name, data in files.items():
        (document, box), (_, other) = drawn(data), drawn(others[name])
        if style.keys() & {"dxf_version"} or "lines" in style.values():
            assert data.startswith(b"999\nlengths are in inches\n")
        else:
            assert document.header["$INSUNITS"] == 1
        assert box == pytest.approx(other / INCH, rel=1e-9, abs=1e-9)
        ends = np.array(document.header["$EXTMAX"]), np.array(document.header["$EXTMIN"])
        assert max(abs(ends[0] - ends[1])) == pytest.approx(max(box[3:] - box[:3]), rel=1e-3)
    assert max(measured["accuracy"]["dxf_mm"].values()) < here.profile_tolerance
    if not style:
        points, _ = read_outline(files["gear1.dxf"])
        assert points == pytest.approx(read_outline(others["gear1.dxf"])[0], rel=ROUNDING)


def test_stl_says_it_in_its_header(inch: Any, mm: Any) -> None:
    (data, *_), (other, *_) = inch.files("stl").values(), mm.files("stl").values()
    assert data[:80].rstrip(b"\0") == b"gearcam gear1 (in)"
    both: Any = [trimesh.load(io.BytesIO(one), file_type="stl") for one in (data, other)]
    mesh, whole = both
    assert mesh.is_watertight
    assert mesh.extents == pytest.approx(whole.extents / INCH, rel=SINGLE)
    assert mesh.volume == pytest.approx(whole.volume / INCH**3, rel=SINGLE)


def test_3mf_and_glb_state_it(inch: Any, mm: Any) -> None:
    for kind in ("3mf", "glb"):
        (data, *_), (other, *_) = inch.files(kind).values(), mm.files(kind).values()
        scene, whole = (trimesh.load(io.BytesIO(one), file_type=kind) for one in (data, other))
        assert scene.extents == pytest.approx(whole.extents / INCH, rel=SINGLE)
        if kind == "3mf":
            with zipfile.ZipFile(io.BytesIO(data)) as archive:
                model = next(one for one in archive.namelist() if one.endswith(".model"))
                assert b'unit="inch"' in archive.read(model)[:500]
        else:
            length = int.from_bytes(data[12:16], "little")
            header = json.loads(data[20 : 20 + length])
            assert header["scenes"][0]["extras"]["units"] == "in"


def test_step_states_it(inch: Any) -> None:
    (data, *_) = inch.files("step").values()
    assert b"CONVERSION_BASED_UNIT('INCH'" in data
    (solid,) = read_step(data)  # which converts to mm
    assert solid.volume == pytest.approx(inch.parts[0].volume, rel=1e-6)


def test_svg_for_cutting_has_its_size(inch: Any, mm: Any) -> None:
    data, other = (one.files("cut-svg")["cut.svg"].decode() for one in (inch, mm))
    sizes = [
        [float(one) for one in re.findall(rf'(?:width|height)="([\d.]+){unit}"', text)]
        for text, unit in ((data, "in"), (other, "mm"))
    ]
    assert len(sizes[0]) == 2
    assert sizes[0] == pytest.approx(np.array(sizes[1]) / INCH, abs=1e-6)
    paths, others = (re.findall(r' d="[^"]*"', text) for text in (data, other))
    assert paths == others  # the view box is in mm, and scales them
    assert "1:1 in inches" in data


def test_columns_are_named_in_inches(inch: Any, mm: Any) -> None:
    for name, data in inch.files("csv").items():
        head, *_ = data.decode().splitlines()
        before, *_ = mm.files("csv")[name].decode().splitlines()
        assert head == before.replace("_mm", "_in")
        both: Any = [
            np.genfromtxt(io.BytesIO(one), delimiter=",", names=True)
            for one in (data, mm.files("csv")[name])
        ]
        here, there = both
        for new, old in zip(here.dtype.names, there.dtype.names, strict=True):
            factor = INCH if old != new else 1.0
            assert here[new] * factor == pytest.approx(there[old], rel=ROUNDING)


def test_a_program_is_in_inches() -> None:
    design = gearcam.load(PROFILES / "rotary_axis_cam.toml").with_({"output.units": "inch"})
    (text,) = (one.decode() for one in built(design).files("gcode").values())
    (plain,) = (
        one.decode() for one in built(PROFILES / "rotary_axis_cam.toml").files("gcode").values()
    )
    assert "G20" in text.split()
    assert "G21" not in text
    assert not re.search(r"\d mm\b", text)
    heads = [
        np.array(re.findall(r"\b[XYZ](-?\d+(?:\.\d+)?)", "\n".join(lines))).astype(float)
        for lines in ([x for x in one.splitlines() if "(" in x] for one in (text, plain))
    ]
    assert len(heads[0]) == len(heads[1]) > 10
    assert np.any(heads[1] > INCH)
    assert heads[0] * INCH == pytest.approx(heads[1], abs=1e-3)
    for axis, factor in (("X", INCH), ("Z", INCH), ("A", 1.0), ("F", 1.0)):
        here, there = (
            np.array(re.findall(rf"(?<![A-Z(]){axis}(-?[\d.]+)", "\n".join(lines))).astype(float)
            for lines in ([x for x in one.splitlines() if "(" not in x] for one in (text, plain))
        )
        assert len(here) == len(there) > 100
        assert here * factor == pytest.approx(there, abs=1e-3)


@pytest.mark.parametrize(
    ("name", "scaled"),
    [
        ("tappet", {"s", "ds", "d2s", "d3s"}),
        ("translating_cam", {"s", "d2s", "d3s"}),  # ds is mm per mm
        ("plate_cam_oscillating", set()),
        ("cylinder_cam", {"s", "ds", "d2s", "d3s", "X", "Y", "Z"}),
        ("globoidal_indexer", {"X", "Y", "Z"}),
    ],
)
def test_columns_that_name_no_unit_are_in_inches_too(name: str, scaled: set[str]) -> None:
    coarse = {"output.wall_step_deg": 3} if scaled >= {"X"} else {}
    mm, inch = (
        built(gearcam.load(PROFILES / f"{name}.toml").with_({"output.units": units} | coarse))
        for units in ("mm", "inch")
    )
    both = zip(mm.files("csv").values(), inch.files("csv").values(), strict=True)
    powers = {"d2s": 1, "d3s": 2} if name == "translating_cam" else {}
    changed = set[str]()
    for old, new in both:
        there, here = (
            np.genfromtxt(io.BytesIO(one), delimiter=",", names=True, dtype=None, encoding="utf-8")
            for one in (old, new)
        )
        for column in {*(there.dtype.names or ())} & {*(here.dtype.names or ())} - {"wall"}:
            plain = np.array_equal(there[column], here[column])
            changed |= set[str]() if plain else {column}
            factor = INCH ** powers.get(column, -1) if column in scaled else 1.0
            assert here[column] == pytest.approx(there[column] * factor, rel=1e-9, abs=1e-9)
    assert changed == scaled


def test_followed_lifts_are_in_inches() -> None:
    found = []
    for units in ("mm", "inch"):
        result = built(gearcam.load(PROFILES / "tappet.toml").with_({"output.units": units}))
        points = result.contours[0].points
        outline = np.column_stack([points.real, points.imag])
        data = result.follow(outline).files["followed.csv"]
        found.append(np.genfromtxt(io.BytesIO(data), delimiter=",", names=True))
    mm, inch = found
    assert np.ptp(mm["s"]) > 8.0
    for name in ("s", "s_asked", "difference", "error"):
        assert inch[name] * INCH == pytest.approx(mm[name], rel=1e-9, abs=1e-12)


def test_the_summary_says_its_unit(inch: Any, mm: Any) -> None:
    here, there = inch.to_dict(), mm.to_dict()
    assert here["units"] == "inch"
    assert "units" not in there
    assert here["pair"]["diametral_pitch"] == 12
    distance = there["pair"]["center_distance_mm"]
    assert here["pair"]["center_distance_in"] == pytest.approx(distance / INCH, rel=ROUNDING)
    assert here["gears"][0]["mass"]["volume_in3"] == pytest.approx(
        there["gears"][0]["mass"]["volume_mm3"] / INCH**3, rel=ROUNDING
    )
    assert here["design"]["blank"]["bore_diameter_in"] == [0.5, 0.5]
    assert there["design"]["units"] == "inch"  # only its files are in mm
    assert not re.search(r"(?<!_kg)(?<!_g)(?<!_n)(?<!_n_s)_mm\b", json.dumps(here))


def test_the_report_is_in_inches(inch: Any) -> None:
    from gearcam.report.page import document

    page = document(inch)
    words = " ".join(page["blocks"].values()).replace("<wbr>", "")
    words = re.sub(r"<[^>]*>", " ", words)
    assert "centre distance 3.0482 in" in words
    assert not re.search(r"(?<!kg )(?<!g )(?<!N )(?<![/\w])mm\b", words)
    labels = [one["y"] for one in page["charts"]] + [one["x"] for one in page["charts"]]
    assert not [one for one in labels if one.endswith((", mm", ", um"))]
    assert [one for one in labels if one.endswith(", in")]


def test_a_table_in_inches_is_read(tmp_path: Any) -> None:
    theta = np.arange(0.0, 360.0, 10.0)
    lift = 0.2 * (1.0 - np.cos(np.radians(theta)))
    rows = [f"{a},{s!r}" for a, s in zip(theta, lift.tolist(), strict=True)]
    (tmp_path / "t.csv").write_text("\n".join(["theta_deg,lift_in", *rows]), encoding="utf-8")
    text = """
kind = "cam"
name = "c"
units = "inch"
[motion]
file = "t.csv"
[follower]
type = "roller"
roller_radius_in = 0.25
[cam]
prime_radius_in = 1.5
thickness_in = 0.4
"""
    (tmp_path / "c.toml").write_text(text, encoding="utf-8")
    result = built(tmp_path / "c.toml")
    assert result.facts["motion.total_lift"] == pytest.approx(0.4 * INCH, rel=1e-6)
    assert result.to_dict()["motion"]["unit"] == "in"
    assert result.to_dict()["motion"]["total_lift"] == pytest.approx(0.4, rel=1e-6)
    (tmp_path / "t.csv").write_text(
        "\n".join(["theta_deg,lift_in", *rows[:5], *rows[4:]]), encoding="utf-8"
    )
    with pytest.raises((gearcam.InfeasibleError, DesignError)) as caught:
        _ = gearcam.build(gearcam.load(tmp_path / "c.toml")).parts
    assert not re.search(r"_mm\b|\d mm\b", str(caught.value))


def test_units_of_files_are_those_of_the_design_if_none_are_given(inch: Any) -> None:
    assert (inch.design.units, inch.design.output.units, inch.design.files_in) == (
        "inch", None, "inch"
    )  # fmt: skip
    design: Any = gearcam.load(PROFILES / "ellipse.toml").with_({"output.units": "inch"})
    assert (design.units, design.files_in) == ("mm", "inch")
    assert b"x_in,y_in" in gearcam.build(design).files("csv")["gear1_outline.csv"]
    assert math.isclose(design.pair.face_width, 10.0)
