"""For tests of STEP files: what the CAD kernel reads back from them."""

from __future__ import annotations

import io
import re
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gearcam.export.step_shapes import occt, properties, subshapes

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
