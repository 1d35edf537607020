"""The same part gives the same files, also in another process, where sets have another order."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

SCRIPT = """
import hashlib, json
from gearcam.pictures.drawings import wheel_drawing
from gearcam.export.dxf import DxfStyle, dxf_bytes
from gearcam.export.sheet_dxf import sheet_dxf
from gearcam.export.sheet_svg import sheet_svg
from gearcam.parts.body import Hub, Part
from gearcam.export.sheet_pdf import sheet_pdf
from gearcam.sheets.paper import Heading
from gearcam.sheets.part import part_sheet
from gearcam.sheets.spec import DrawingSpec
from helpers_contour import bore, square_contour
style = DxfStyle(tolerance=1e-3)
part = Part(name="p", contours=(square_contour(9.0),), openings=bore(2.0), width=1.0)
hub = Hub(diameter=9.0, front=2.0)
wide = Part(name="p", contours=(square_contour(90.0),), width=1.0, hub=hub)
heading = Heading(title="t", notes=DrawingSpec())
sheets = [part_sheet(wide, {"a": "1"}, heading) for _ in range(2)]
files = [
    dxf_bytes(wheel_drawing(part), style),
    *(sheet_svg(one) + sheet_dxf(one, style) + sheet_pdf([one], "t") for one in sheets),
]
found = [hashlib.sha256(file).hexdigest() for file in files]
print(json.dumps([found, list({"one", "two", "three", "four", "five"})]))
"""


def test_the_same_part_gives_the_same_bytes() -> None:
    roots = os.pathsep.join([str(Path(__file__).parents[1]), *sys.path])
    found = []
    for seed in ("0", "11"):
        place = {**os.environ, "PYTHONPATH": roots, "PYTHONHASHSEED": seed}
        run = [sys.executable, "-c", SCRIPT]
        done = subprocess.run(run, env=place, capture_output=True, check=True)
        found.append(json.loads(done.stdout))
    (files, order), (other_files, other_order) = found
    assert files == other_files
    _, first, second = files
    assert first == second
    assert order != other_order, "the control: sets have another order"
