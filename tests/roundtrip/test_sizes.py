"""The overall size of each part is that of its files, as other readers measure them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import ezdxf
import ezdxf.bbox
import numpy as np
import pytest
import trimesh

import gearcam as gc
from gearcam.pictures.drawings import OUTER
from helpers_pairs import PROFILES
from helpers_sampling import few

PARTS = {
    "shop_order": ("gears.{}", ("gear1", "gear2")),
    "ring_ellipse": ("gears.{}", ("gear1", "gear2")),
    "feeder": ("gears.{}", ("gear1", "gear2")),
    "stepped_ellipse": ("gears.{}", ("gear1", "gear2")),
    "log_spiral": ("gears.{}", ("gear1", "gear2")),
    "tappet": ("part", ("cam",)),
    "groove_cam": ("part", ("cam",)),
    "translating_cam": ("part", ("cam",)),
    "conjugate_cams": ("part.{}", ("cam1", "cam2")),
}
LONG = ("stepped_ellipse", "feeder", "log_spiral", "shop_order")
"""Those whose files take long; others, and fewer steps, are measured each time."""


def box(path: Path) -> Any:
    """Extents along x, y and z of a mesh; along x and y of the outer edges of a drawing."""
    if path.suffix == ".stl":
        return trimesh.load_mesh(path).extents
    drawing = ezdxf.readfile(path)  # type: ignore[attr-defined]
    edges = [one for one in drawing.modelspace() if one.dxf.layer in OUTER]
    return np.array(ezdxf.bbox.extents(edges).size)[:2]


@pytest.mark.parametrize(
    ("name", "changes"),
    [
        *few((name, {}) for name in PARTS if name not in LONG),
        ("stepped_ellipse", {"steps.count": 2}),
        *(pytest.param(name, {}, marks=pytest.mark.slow) for name in LONG),
    ],
)
def test_the_size_of_a_part_is_that_of_its_files(
    name: str, changes: dict[str, int], tmp_path: Path
) -> None:
    group, stems = PARTS[name]
    files = {"output.files": ["stl", "dxf"]}
    result = gc.build(gc.load(PROFILES / f"{name}.toml").with_(files | changes))
    folder = Path(result.write(tmp_path).directory)
    for number, stem in enumerate(stems):
        size = result.facts[f"{group.format(number)}.size_mm"]
        solid = box(folder / f"{stem}.stl")
        assert size == pytest.approx(solid.tolist(), abs=2.1e-3)  # of chords on both sides
        assert solid[2] > 1.0
        drawings = [folder / f"{stem}.dxf"]
        if not drawings[0].exists():  # a stepped wheel has one for each step
            drawings = sorted(folder.glob(f"{stem}_step*.dxf"))
        plane = np.max([box(one) for one in drawings], axis=0)
        tolerance = 2e-3 if len(drawings) == 1 else 0.5
        assert size[:2] == pytest.approx(plane.tolist(), abs=tolerance)


def test_it_is_shown_and_needs_no_parts() -> None:
    """A pair that orders no parts has the size of its outlines, without having made parts."""
    result = gc.build(gc.load(PROFILES / "ellipse.toml"))
    quantity = result.facts.quantity("gears.1.size_mm")
    assert quantity.meaning == "overall size of wheel 2"
    assert "parts" not in vars(result)
    wide, high = np.ptp(result.gear2.outline, axis=0)
    assert quantity.value == [wide, high, 10.0]
    assert quantity.text == f"{wide:.2f} x {high:.2f} x 10 mm"
    assert any("overall size of wheel 2" in line for line in result.facts.lines())


def test_coarse_chords_do_not_change_it() -> None:
    """Drawings have the sizes of the true curves, and so has the summary, at any tolerance."""
    files = ["drawing-svg"]
    design = gc.load(PROFILES / "ellipse.toml")
    sizes = [
        gc.build(design.with_({"output.files": files, "output.chord_tolerance_mm": one})).facts[
            "gears.0.size_mm"
        ]
        for one in (0.02, 0.0005)
    ]
    assert sizes[0] == pytest.approx(sizes[1], abs=1e-6)
