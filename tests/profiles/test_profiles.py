"""Every design file in the gallery builds, and shows numbers that were known beforehand.

Sources of the numbers: the source text's printed results, closed forms in high precision, and
integrals of the raw law by mpmath. A file without two such numbers fails.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import mpmath as mp
import pytest

from gearcam.base.errors import GearcamError
from helpers_built import built
from helpers_gallery import CAM_NUMBERS, MACHINE_NUMBERS, NUMBERS, Number, misses
from helpers_pairs import PROFILES, profile
from helpers_sampling import chosen


def formula_distance() -> float:
    """Centre distance of ``phi2 = phi1 - 0.08*sin(2*phi1)``, m = 1.5, z = 24: A*L(1) = pi*m*z."""

    def speed(phi: Any) -> Any:
        ratio, slope = 1 - mp.mpf("0.16") * mp.cos(2 * phi), mp.mpf("0.32") * mp.sin(2 * phi)
        return mp.sqrt((ratio / (1 + ratio)) ** 2 + (slope / (1 + ratio) ** 2) ** 2)

    with mp.workdps(30):
        return float(mp.pi * 1.5 * 24 / mp.quad(speed, mp.linspace(0, 2 * mp.pi, 9)))


def formula_least_radius() -> float:
    """Smallest convex radius of its driver, at phi1 = 90 deg, by the law's own derivatives there.

    With i = 1.16, i' = 0, i'' = -0.64 and a = 1/(1 + i): r = A*i*a, r'' = A*a*a*i'', and rho =
    r*r/(r - r'').
    """
    ratio, bend, a = 1.16, -0.64, 1 / 2.16
    distance = formula_distance()
    r, ddr = distance * ratio * a, distance * a * a * bend
    return r * r / (r - ddr)


EXPECTED: dict[str, dict[str, Number]] = {
    **NUMBERS,
    "ellipse": {
        # A = 2a with perimeter 4*a*E(e) = pi*m*z; rho = a*(1 - e^2) at the vertices
        "pair.center_distance_mm": (41.9606757804, 1e-10),
        "gears[0].centrode.length_mm": (math.pi * 41, 1e-11),
        "gears[0].centrode.min_convex_radius_mm": (41.9606757804 / 2 * (1 - 0.3**2), 1e-9),
        "gears[1].centrode.min_convex_radius_mm": (41.9606757804 / 2 * (1 - 0.3**2), 1e-9),
        "pair.ratio.max": (1.3 / 0.7, 1e-12),
    },
    "quiet_ellipse": {
        # both centrodes are ellipses with the half axis of half the distance: 4*a*E(e)
        "gears[0].centrode.length_mm": (float(4 * 21 * mp.ellipe(mp.mpf("0.09"))), 1e-11),
        "pair.ratio.max": (1.3 / 0.7, 1e-12),
        "pair.center_distance_mm": (42.0, 1e-12),
    },
    "formula": {
        "pair.center_distance_mm": (formula_distance, 1e-11),
        "gears[0].centrode.min_convex_radius_mm": (formula_least_radius, 1e-11),
        "pair.ratio.min": (0.84, 1e-13),
        "pair.ratio.max": (1.16, 1e-13),
    },
    "nail_machine_two_phase": {
        "pair.module_mm": (4.9229880875, 1e-10),
        "gears[0].centrode.length_mm": (556.7768355399, 1e-10),
        "gears[1].centrode.length_mm": (556.7768355399, 1e-10),
        "gears[0].centrode.min_convex_radius_mm": (68.0793, 5e-5),
        "gears[0].centrode.max_concave_curvature_per_mm": (1 / 144.4514, 5e-5 / 144.4514**2),
        "gears[1].centrode.min_convex_radius_mm": (29.2869, 5e-5),
    },
    "nail_machine_three_phase": {
        "pair.module_mm": (4.9604944536, 1e-10),
        "pair.solved.ratios[2]": (1.06, 1e-12),
        "gears[0].centrode.length_mm": (561.0187056128, 1e-10),
        # 59.7386 is printed, a sample beside the minimum; the raw law's own minimum is this:
        "gears[0].centrode.min_convex_radius_mm": (59.738483, 5e-7),
        "gears[0].centrode.max_concave_curvature_per_mm": (1 / 88.9888, 5e-5 / 88.9888**2),
        "gears[1].centrode.min_convex_radius_mm": (26.0013, 5e-5),
    },
}

UNDERCUT: dict[str, list[list[int]]] = {
    **{name: [[], []] for name in NUMBERS},
    "furnace_door": [[], [1, 3, 4]],
    "two_lobed_ellipse": [[9, 11, 27, 29], [2, 17, 20, 35]],
    "rounded_square": [[k + 8 * side for side in range(4) for k in (3, 4, 5, 6, 7)], []],
    "ellipse": [[], []],
    "quiet_ellipse": [[], []],
    "formula": [[], []],
    "nail_machine_two_phase": [[], [15, 17, 18]],
    "nail_machine_three_phase": [[], [15, 16, 17, 18]],
    "loaded_nail_machine": [[], [15, 17, 18]],
    "rattling_pair": [[], [15, 17, 18]],
}
"""Undercut teeth of both wheels."""

ALL = EXPECTED | CAM_NUMBERS | MACHINE_NUMBERS
FLAWED = {"undercut_cam"}
"""Cams that show what an error is."""

LONG = {"globoidal_indexer", "ordered_drum"}
"""Whose numbers `tests/unit/spatial` and a witness prove of smaller cams."""

FEWEST = 2
"""Numbers that a file must come with."""


def unproved(folder: Path, expected: Mapping[str, Mapping[str, Number]]) -> set[str]:
    """Names that are a file without enough numbers, or numbers without a file."""
    files = {path.stem for path in folder.glob("*.toml")}
    proved = {name for name, numbers in expected.items() if len(numbers) >= FEWEST}
    return files ^ proved


def test_every_file_of_the_gallery_has_its_numbers() -> None:
    assert unproved(PROFILES, ALL) == set()
    assert set(UNDERCUT) == set(EXPECTED)


@pytest.mark.parametrize("numbers", [None, {}, {"pair.module_mm": (1.0, 1e-9)}])
def test_a_file_without_its_numbers_fails(tmp_path: Path, numbers: dict | None) -> None:
    for path in PROFILES.glob("*.toml"):
        (tmp_path / path.name).write_bytes(path.read_bytes())
    (tmp_path / "newcomer.toml").touch()
    extra = {} if numbers is None else {"newcomer": numbers}
    assert unproved(tmp_path, {**ALL, **extra}) == {"newcomer"}


def test_numbers_without_their_file_fail() -> None:
    extra: dict[str, dict[str, Number]] = {"gone": {"a": (1.0, 0.0), "b": (1.0, 0.0)}}
    assert unproved(PROFILES, ALL | extra) == {"gone"}


@pytest.mark.parametrize("name", sorted(EXPECTED))
def test_a_file_shows_its_numbers(name: str) -> None:
    summary = profile(name).facts.document
    assert list(misses(summary, EXPECTED[name])) == []
    assert [gear["undercut_teeth"] for gear in summary["gears"]] == UNDERCUT[name]
    assert [finding for finding in profile(name).findings if finding.severity == "error"] == []


@pytest.mark.parametrize("name", chosen(sorted(CAM_NUMBERS), *(set(CAM_NUMBERS) - LONG)))
def test_a_cam_shows_its_numbers(name: str) -> None:
    result = built(PROFILES / f"{name}.toml")
    assert list(misses(result.facts.document, CAM_NUMBERS[name])) == []
    errors = [finding for finding in result.findings if finding.severity == "error"]
    assert bool(errors) == (name in FLAWED)


@pytest.mark.parametrize("name", sorted(MACHINE_NUMBERS))
def test_a_machine_shows_its_numbers(name: str) -> None:
    result = built(PROFILES / f"{name}.toml")
    assert list(misses(result.facts.document, MACHINE_NUMBERS[name])) == []
    assert [finding for finding in result.findings if finding.severity == "error"] == []


def test_a_wrong_number_is_seen() -> None:
    summary = profile("ellipse").facts.document
    off = {"pair.center_distance_mm": (41.9606757804 + 2e-10, 1e-10)}
    assert len(list(misses(summary, off))) == 1


STEMS = {
    **{
        one: one
        for one in ("inspection", "tool_path", "curvature", "report", "caliper", "grinding")
    },
    "measures": "inspection",
    "rotary_path": "tool_path",
}
"""The word in ``output.files`` of files whose names begin so."""


def kind_of(file: str) -> str:
    """The word in ``output.files`` that asks for a file."""
    stem, suffix = Path(file).stem, Path(file).suffix[1:]
    for start, word in STEMS.items():
        if stem.startswith(start):
            return word.replace("_", "-")
    if suffix == "nc":
        return "gcode"
    role = next((f"{one}-" for one in ("drawing", "cut", "print") if stem.endswith(one)), "")
    return role + suffix


WRITTEN = (
    "flat_follower", "lathe_slide", "valve_train", "tappet", "cylinder_cam", "ring_ellipse",
    "nail_machine_two_phase", "straight_line", "four_bar",
)  # fmt: skip
"""Which are written each time: of each kind of design those of many kinds of files, soon made."""


@pytest.mark.parametrize("name", chosen(sorted(ALL), *WRITTEN))
def test_a_file_writes_what_it_lists(name: str, tmp_path: Path) -> None:
    made = profile(name) if name in EXPECTED else built(PROFILES / f"{name}.toml")
    try:
        written = made.write(tmp_path)
    except GearcamError as error:  # pragma: no cover
        pytest.fail(str(error))
    kinds = {kind_of(file) for file in written.files} - {"json", "toml"}
    assert kinds == set(made.design.output.files)
    assert {path.name for path in (tmp_path / name).iterdir()} == set(written.files)
