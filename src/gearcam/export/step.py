"""STEP: exact solids for CAD and CAM programs.

AP214, in the unit of files. Each part is one product of its name, with a solid for each of its
steps; several parts form an assembly in which each is turned and shifted to its place. Flanks, tips
and roots are B-spline faces within the tolerance, one for each smooth piece of the outline; bores,
hubs and marks are cylinders and planes. Cams in space are solids of bands (`step_bands`). The same
parts give the same bytes: the file has a fixed date.

Refused: no parts at all; invalid solids (see `step_shapes` and `step_bands`).

Depends on parts, `step_shapes` and `step_bands`; on OCP, the binding of the CAD kernel OCCT,
only inside the functions: it is large, and an extra of the package.
"""

from __future__ import annotations

import io
import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any, Final

from gearcam.base.errors import MissingExtraError
from gearcam.base.inches import file_unit
from gearcam.export.step_bands import banded_solid
from gearcam.export.step_shapes import occt, solids_of
from gearcam.numeric.pose import Pose
from gearcam.parts.bands import BandedBody
from gearcam.parts.body import Part
from gearcam.parts.solids import SolidError

DATE: Final = "1970-01-01T00:00:00"
"""The date in a file: the same for all."""

SETTINGS: Final[dict[str, str | int]] = {
    "write.step.schema": "AP214IS",
    "xstep.cascade.unit": "MM",
    "write.step.product.name": "part",
    "write.surfacecurve.mode": 0,  # edges as curves in space only: smaller, nothing is lost
    "write.step.assembly": 2,  # for more than one part
}
"""Settings of the kernel's translator; they are global, so each use sets them all."""

BANDED: Final = SETTINGS | {"write.surfacecurve.mode": 1}
"""Settings for bands: edges also over the parameters of their faces, of which some are slim."""

Item = Part | BandedBody
"""What has a solid."""

_MM: Final = 0.001
"""Millimetre, in metres."""

_USE: Final = re.compile(r"NEXT_ASSEMBLY_USAGE_OCCURRENCE\(\s*'\d+'(.*?\);)", re.DOTALL)
"""A part's place in the assembly, with a number that increases through the process."""

_TOKEN: Final = re.compile(r"'(gearcam-\d+)'")
"""Token given to the kernel in place of a name."""


def step_bytes(
    items: Sequence[tuple[Item, Pose]],
    name: str,
    tolerance: float,
    made: dict[Item, Any] | None = None,
) -> bytes:
    """Return parts as a STEP file.

    Parameters
    ----------
    items : sequence of (Part or BandedBody, Pose)
        One part, or those of an assembly with their places; a repeated part is one product.
    name : str
        Name of the assembly, and of the file without its ending.
    tolerance : float, mm
        Largest distance of the faces of parts from the dense points of the outlines; bands have
        their own.
    made : dict, optional
        Cache of the parts' solids to that tolerance; new ones are added.

    Returns
    -------
    bytes
        ASCII.

    Raises
    ------
    MissingExtraError
        If OCP is not installed.
    SolidError
        If a part does not give a valid solid of its volume.
    ValueError
        If there are no parts.
    """
    _require()
    if not items:
        raise ValueError("a STEP file needs at least one part")
    parts = dict.fromkeys(part for part, _ in items)
    texts = dict.fromkeys([f"{name}.step", name, *(part.name for part in parts)])
    tokens = {text: f"gearcam-{number}" for number, text in enumerate(texts)}
    with _silent(), _document() as document:
        made = {} if made is None else made
        made |= {p: _shape(p, tolerance) for p in parts if p not in made}
        _fill(document, items, {part: made[part] for part in parts}, tokens[name], tokens)
        banded = any(isinstance(part, BandedBody) for part in parts)
        written = _write(document, tokens[f"{name}.step"], BANDED if banded else SETTINGS)
    return _normal(written.decode("ascii"), tokens).encode("ascii")


def _shape(item: Item, tolerance: float) -> Any:
    if isinstance(item, BandedBody):
        return banded_solid(item)
    return _joined(solids_of(item, tolerance))


def _require() -> None:
    try:
        import OCP  # noqa: F401
    except ImportError as error:
        raise MissingExtraError("STEP files", "step") from error


@contextmanager
def _silent() -> Iterator[None]:
    """Suppress the kernel's messages on the terminal."""
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
    """Return a new document for shapes with names."""
    application = occt.XCAFApp_Application.GetApplication_s()
    form = occt.TCollection_ExtendedString("MDTV-XCAF")
    # the document it opens is the one returned, not the one passed in
    (document,) = application.NewDocument(form, occt.TDocStd_Document(form))
    try:
        occt.XCAFDoc_DocumentTool.SetLengthUnit_s(document, _MM)
        yield document
    finally:
        application.Close(document)


def _set_all(settings: Mapping[str, str | int]) -> None:
    occt.STEPControl_Controller.Init_s()  # there are no settings before this
    unit = {"write.step.unit": "MM" if file_unit().size == 1.0 else "INCH"}
    for key, value in {**settings, **unit}.items():
        text = isinstance(value, str)
        setter = occt.Interface_Static.SetCVal_s if text else occt.Interface_Static.SetIVal_s
        if not setter(key, value):
            raise RuntimeError(f"the STEP writer rejects {key} = {value}")


def _joined(solids: Sequence[Any]) -> Any:
    """Return one shape: a single solid, or a compound of several."""
    if len(solids) == 1:
        return solids[0]
    builder, compound = occt.BRep_Builder(), occt.TopoDS_Compound()
    builder.MakeCompound(compound)
    for solid in solids:
        builder.Add(compound, solid)
    return compound


def _fill(
    document: Any,
    items: Sequence[tuple[Item, Pose]],
    shapes: Mapping[Item, Any],
    name: str,
    names: Mapping[str, str],
) -> None:
    """Add the shapes to the document: one in its place, several as an assembly."""
    tool = occt.XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    if len(items) == 1:
        ((part, pose),) = items
        # a shape with a location would be written as an assembly: its points are moved instead
        moved = occt.BRepBuilderAPI_Transform(shapes[part], _motion(pose), True).Shape()
        _set_name(tool.AddShape(moved, False), names[part.name])
        return
    root = tool.NewShape()
    _set_name(root, name)
    labels = {part: tool.AddShape(shape, False) for part, shape in shapes.items()}
    for part, label in labels.items():
        _set_name(label, names[part.name])
    for part, pose in items:
        place = occt.TopLoc_Location(_motion(pose))
        _set_name(tool.AddComponent(root, labels[part], place), names[part.name])
    tool.UpdateAssemblies()


def _motion(pose: Pose) -> Any:
    turn, shift = occt.gp_Trsf(), occt.gp_Trsf()
    axis = occt.gp_Ax1(occt.gp_Pnt(0.0, 0.0, 0.0), occt.gp_Dir(0.0, 0.0, 1.0))
    turn.SetRotation(axis, float(pose.turn))
    place = complex(pose.shift)
    shift.SetTranslation(occt.gp_Vec(place.real, place.imag, pose.height))
    return shift * turn


def _set_name(label: Any, name: str) -> None:
    occt.TDataStd_Name.Set_s(label, occt.TCollection_ExtendedString(name, True))  # True: UTF-8


def _write(document: Any, file: str, settings: Mapping[str, str | int]) -> bytes:
    """Return the document as STEP, written by the kernel."""
    _set_all(settings)
    writer = occt.STEPCAFControl_Writer()
    writer.SetNameMode(True)
    for other in (writer.SetColorMode, writer.SetLayerMode, writer.SetPropsMode):
        other(False)
    if not writer.Transfer(document, occt.STEPControl_StepModelType.STEPControl_AsIs):
        raise SolidError("the STEP writer rejects the shapes")
    header = occt.APIHeaderSection_MakeHeader(writer.ChangeWriter().Model())
    header.SetName(occt.TCollection_HAsciiString(file))
    header.SetTimeStamp(occt.TCollection_HAsciiString(DATE))
    header.SetAuthorValue(1, occt.TCollection_HAsciiString(""))
    header.SetOrganizationValue(1, occt.TCollection_HAsciiString(""))
    header.SetOriginatingSystem(occt.TCollection_HAsciiString("gearcam"))
    stream = io.BytesIO()
    if writer.WriteStream(stream) != occt.IFSelect_ReturnStatus.IFSelect_RetDone:
        raise SolidError("the STEP writer wrote nothing")
    return stream.getvalue()


def _normal(text: str, tokens: Mapping[str, str]) -> str:
    """Return the file with places in the assembly counted from 1, and names instead of tokens.

    The kernel breaks long names inside a letter, and writes letters that the format does not allow.
    """
    count = iter(range(1, 1 + text.count("\n")))

    def use(found: re.Match[str]) -> str:
        # the number's length changes the line breaks
        rest = re.sub(r"\n *", "", found[1])
        return f"NEXT_ASSEMBLY_USAGE_OCCURRENCE('{next(count)}'{rest}"

    literals = {token: _literal(name) for name, token in tokens.items()}
    return _TOKEN.sub(lambda found: literals[found[1]], _USE.sub(use, text))


def _literal(name: str) -> str:
    """Return a name as a string of ISO 10303-21."""

    def encoded(found: re.Match[str]) -> str:
        wide = max(found[0]) > "\uffff"
        code = found[0].encode("utf-32-be" if wide else "utf-16-be").hex().upper()
        return f"\\X{4 if wide else 2}\\{code}\\X0\\"

    safe = name.replace("\\", "\\\\").replace("'", "''")
    return "'" + re.sub(r"[^\x20-\x7e]+", encoded, safe) + "'"
