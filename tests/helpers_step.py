"""STEP files: exact parts, a reader of the text without a CAD kernel, and the kernel's reader."""

from __future__ import annotations

import io
import math
import re
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gearcam.export.step_shapes import occt, properties, subshapes
from gearcam.numeric.contour import Contour, Run
from gearcam.numeric.splines import fit_splines
from gearcam.parts.body import Part
from gearcam.parts.shapes import Loop
from helpers_curves import cubics

KEYED = 10.0, 2.5, 12.8
"""Radius of a bore, half the width of its keyway, and where that ends, mm."""

DENT = 0.25
"""Bulge of the keyway's floor, which bows into the opening: an arc that turns right."""


def keyed_bore() -> Loop:
    """Three arcs, of at most a half circle, and a keyway upwards, its floor an arc."""
    radius, half, top = KEYED
    x, y = half, math.sqrt(radius**2 - half**2)
    begin = math.atan2(y, -half)
    angles = np.linspace(begin, 2 * math.pi + math.atan2(y, half), 4)
    arcs = radius * np.exp(1j * angles)
    points = np.append(arcs, [complex(x, top), complex(-x, top)])
    bend = math.tan((angles[1] - angles[0]) / 4)
    return Loop(points=points, bulges=np.array([bend, bend, bend, 0.0, -DENT, 0.0]))


def keyed_area() -> float:
    """Circle, less the segment above the chord between the walls, and the keyway from there on."""
    radius, half, top = KEYED
    y = math.sqrt(radius**2 - half**2)
    keyway = 2 * half * (top - y) - segment(half, floor_radius())
    return math.pi * radius**2 - segment(half, radius) + keyway


def floor_radius() -> float:
    """Of the keyway's floor, mm, from its half chord and sagitta."""
    half = KEYED[1]
    return half * (1 + DENT**2) / (2 * DENT)


def segment(half: float, radius: float) -> float:
    """Area between a circle and the chord of a half length, mm^2."""
    return radius**2 * math.asin(half / radius) - half * math.sqrt(radius**2 - half**2)


def plate(contour: Contour, width: float = 6.0, **wanted: object) -> Part:
    return Part(name="gear1", contours=(contour,), width=width, **wanted)  # type: ignore[arg-type]


def one_run(contour: Contour, *, joints: bool = True, doubled: bool = False) -> Contour:
    """The runs of a smooth outline as one, joints where they met, perhaps with a piece of 0 mm."""
    ends = np.cumsum([len(run.points) - 1 for run in contour.runs])[:-1].tolist()
    points, tangents = (
        np.concatenate([*(values[:-1] for values in each), each[-1][-1:]])
        for each in (
            [run.points for run in contour.runs],
            [run.tangents for run in contour.runs],
        )
    )
    if doubled:
        points, tangents = (np.insert(v, ends[0], v[ends[0]]) for v in (points, tangents))
        ends = [ends[0], *(end + 1 for end in ends)]
    run = Run(points=points, tangents=tangents, joints=tuple(ends) if joints else ())
    return replace(contour, dense=lambda: (run,))


def pieces(contour: Contour) -> tuple[int, int]:
    """How many pieces are curved and how many straight: these have one tangent."""
    straight = [
        bool(np.abs(piece.tangents - piece.tangents[0]).max() < 1e-9)
        for run in contour.runs
        for piece in run.pieces
    ]
    return len(straight) - sum(straight), sum(straight)


def spline_area(contour: Contour, tolerance: float) -> float:
    """Area inside the fitted cubics, integrated exactly (degree 5) from their Bezier points."""
    place, weight = np.polynomial.legendre.leggauss(3)
    t, s = 0.5 * (1 + place), 0.5 * (1 - place)
    basis = np.stack([s**3, 3 * s * s * t, 3 * s * t * t, t**3])
    slopes = 3 * np.stack([s * s, 2 * s * t, t * t])
    total = 0.0
    # all at once, as the file's: how many are fitted together decides on lengths that are tried
    for spline in fit_splines([piece for run in contour.runs for piece in run.pieces], tolerance):
        x, y = cubics(spline).real, cubics(spline).imag
        swept = (x @ basis) * (np.diff(y) @ slopes) - (y @ basis) * (np.diff(x) @ slopes)
        total += 0.25 * float((swept @ weight).sum())
    return total


def entities(data: bytes) -> dict[str, list[str]]:
    """What stands between the brackets of each simple entity, by kind."""
    text = re.sub(r"\n *", "", data.decode("ascii"))
    found: dict[str, list[str]] = {}
    for kind, inside in re.findall(r"#\d+ = (\w+)\((.*?)\);", text):
        found.setdefault(kind, []).append(inside)
    return found


def corners(data: bytes) -> np.ndarray:
    """The places of all vertices, (n, 3), in the file's numbers."""
    text = re.sub(r"\n *", "", data.decode("ascii"))
    points = dict(re.findall(r"#(\d+) = CARTESIAN_POINT\('',\((.*?)\)\);", text))
    used = re.findall(r"VERTEX_POINT\('',#(\d+)\)", text)
    return np.array([[float(number) for number in points[key].split(",")] for key in used])


MM = 0.001
"""In metres."""


@dataclass(frozen=True)
class StepSolid:
    """What a STEP file says about a solid, where the assembly has put it; lengths in mm."""

    name: str
    """Of its product."""
    faces: dict[str, int]
    """How many faces of each kind: ``"plane"``, ``"cylinder"``, ``"bspline"``."""
    volume: float
    """Integrated over its faces, to a billionth on each."""
    center: NDArray[np.float64]
    bounds: NDArray[np.float64]
    """Lower and upper corner of the box around it, (2, 3)."""


def read_step(data: bytes) -> list[StepSolid]:
    """Solids in the order of the file; those of a part that comes twice, twice."""
    with silent(), _document() as document:
        occt.STEPControl_Controller.Init_s()  # before this there are no settings
        assert occt.Interface_Static.SetCVal_s("xstep.cascade.unit", "MM")
        reader = occt.STEPCAFControl_Reader()
        reader.SetNameMode(True)
        status = reader.ReadStream("step", io.BytesIO(data))
        if status != occt.IFSelect_ReturnStatus.IFSelect_RetDone or not reader.Transfer(document):
            raise ValueError("this is no STEP file with shapes")
        roots = occt.Sequence_TDF_Label()
        occt.XCAFDoc_DocumentTool.ShapeTool_s(document.Main()).GetFreeShapes(roots)
        return [solid for root in roots for solid in _solids(root, occt.TopLoc_Location())]


@contextmanager
def silent() -> Iterator[None]:
    """Keep what the kernel says of broken files from the terminal."""
    messenger = occt.Message.DefaultMessenger_s()
    printers = list(messenger.Printers())
    for printer in printers:
        messenger.RemovePrinter(printer)
    try:
        yield
    finally:
        for printer in printers:
            messenger.AddPrinter(printer)


@contextmanager
def _document() -> Iterator[Any]:
    application = occt.XCAFApp_Application.GetApplication_s()
    form = occt.TCollection_ExtendedString("MDTV-XCAF")
    # the document that it opens is the one returned, not the one that it is given
    (document,) = application.NewDocument(form, occt.TDocStd_Document(form))
    try:
        occt.XCAFDoc_DocumentTool.SetLengthUnit_s(document, MM)
        yield document
    finally:
        application.Close(document)


def _solids(label: Any, place: Any) -> Iterator[StepSolid]:
    """Walk down an assembly."""
    tool = occt.XCAFDoc_ShapeTool
    if not tool.IsAssembly_s(label):
        found = occt.TDataStd_Name()
        name = found.Get().ToExtString() if label.FindAttribute(found.GetID_s(), found) else ""
        shape = tool.GetShape_s(label).Moved(place)
        yield from (_described(solid, name) for solid in subshapes(shape, "SOLID"))
        return
    components = occt.Sequence_TDF_Label()
    tool.GetComponents_s(label, components, False)
    for component in components:
        target = occt.TDF_Label()
        tool.GetReferredShape_s(component, target)
        yield from _solids(target, place * tool.GetLocation_s(component))


def _described(solid: Any, name: str) -> StepSolid:
    kinds = Counter(
        occt.BRepAdaptor_Surface(occt.TopoDS.Face(face)).GetType().name
        for face in subshapes(solid, "FACE")
    )
    box = occt.Bnd_Box()
    occt.BRepBndLib.AddOptimal_s(solid, box, False, False)
    found = properties(solid)
    return StepSolid(
        name=name,
        faces={
            re.sub("GeomAbs_|SurfaceOf|Surface", "", kind).lower(): count
            for kind, count in sorted(kinds.items())
        },
        volume=found.Mass(),
        center=_numbers(found.CentreOfMass()),
        bounds=np.stack([_numbers(box.CornerMin()), _numbers(box.CornerMax())]),
    )


def _numbers(point: Any) -> NDArray[np.float64]:
    return np.array([point.X(), point.Y(), point.Z()])
