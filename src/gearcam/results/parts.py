"""Results of designs of which parts are made: drawings, solids, their places, and their files."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any, ClassVar, Final, Self

from gearcam.base.inches import files_in
from gearcam.designs.outputs import DRAWINGS, MESHES
from gearcam.results.kind import Files
from gearcam.results.result import Result

if TYPE_CHECKING:
    from trimesh import Trimesh

    from gearcam.base.facts import Tree
    from gearcam.export.dxf import DxfStyle
    from gearcam.numeric.mesh import Mesh
    from gearcam.numeric.pose import Pose, SpacePose
    from gearcam.parts.body import Part
    from gearcam.pictures.drawings import Drawing
    from gearcam.sheets.paper import Heading, Values
    from gearcam.sheets.sheet import Sheet
    from gearcam.sheets.wheel import Sense, Teeth

Measured = dict[str, Any]
"""Facts measured on files, by group."""

Estimates = Mapping[str, tuple[float, str]]
"""Estimated error and its method, by name."""

_STEP_PART: Final = 2e-3
"""Tolerance of STEP surfaces over that of the outlines: their volumes are then good to 1e-6."""

COARSE: Final = 0.02
"""Chord tolerance of a draft, mm: a fifth of a pixel at 10 pixels per mm."""

_DRAFTED: Final = 2
"""Points per chord from which the areas of a draft are computed: they are good to a millionth."""

CHORDS: Final = ("outlines, between their points", ["chord_mm"])
"""The chord error among the `main_errors`."""

_CHORD_HOW: Final = (
    "largest distance of the curve from a chord: measured at 13 places, or, "
    "where the curvature hardly changes, from the tangents at its ends"
)
"""Method of a sampler's chord error."""


class PartsResult(Result):
    """The result of a design of which parts are made.

    The output of its designs has ``chord_tolerance``, ``kerf``, ``dxf_curves`` and ``dxf_version``.

    Parameters
    ----------
    design : Design
        The design to build.
    tolerances : Tolerances
        Accuracy of the internal computations.
    """

    for_users = ("parts", "solids")

    drafted: bool = False
    """Whether it is only looked at."""
    before_output: ClassVar[Sequence[str]] = ()
    """The stages that do not depend on the table ``[output]`` of a design."""

    def with_chords(self, tolerance: float) -> Self:
        """Return the result with another chord tolerance, mm; it keeps what does not depend on it.

        For the program's own use: the tolerance is not examined, as `Design.with_` does. Raises
        `InfeasibleError` if a stage that it keeps cannot be made.
        """
        known = {name: getattr(self, name) for name in self.before_output}
        output = replace(self.design.output, chord_tolerance=tolerance)
        result = type(self)(replace(self.design, output=output, examined=True), self.tolerances)
        vars(result).update(known)
        return result

    def coarse(self) -> Self:
        """Return the result with outlines for the eye, without limits of tools (see `Staged`)."""
        made = self.with_chords(COARSE)
        made.tolerances = replace(self.tolerances, oversampling=_DRAFTED)
        made.drafted = True
        return made

    @cached_property
    @abstractmethod
    def parts(self) -> tuple[Part, ...]:
        """The parts to be made, with bores, hubs and openings."""

    @cached_property
    @abstractmethod
    def plates(self) -> tuple[Drawing, ...]:
        """A drawing of each plate that is cut, in its own frame."""

    @property
    def printed(self) -> tuple[Drawing, ...]:
        """The plates with their pitch curves."""
        return self.plates

    @cached_property
    @abstractmethod
    def drawing(self) -> Drawing:
        """The parts assembled."""

    @property
    @abstractmethod
    def profile_tolerance(self) -> float:
        """Chord tolerance of the outlines, mm."""

    @property
    @abstractmethod
    def chord_error(self) -> float:
        """Largest chord error of the outlines, mm."""

    @cached_property
    @abstractmethod
    def error_rows(self) -> Estimates:
        """Error estimates and their methods by name, without those of chords and files."""

    @abstractmethod
    def rows_of(self, number: int) -> Sequence[str]:
        """Return the names of the facts in the table of a part's drawing, by its `number`."""

    @property
    def assembly(self) -> str:
        """Stem of the files of the assembled parts; empty for a single part."""
        return ""

    @property
    def poses(self) -> tuple[Pose, ...]:
        """Where each part is in the assembly."""
        from gearcam.numeric.pose import UNMOVED

        return (UNMOVED,) * len(self.parts)

    @cached_property
    def to_cut(self) -> tuple[Drawing, ...]:
        """Cutting paths of the plates, in mm: outlines, or paths offset by half the kerf."""
        from gearcam.pictures.drawings import cut_drawing

        return tuple(cut_drawing(one, self.design.output.kerf) for one in self.plates)

    @property
    def references(self) -> tuple[Drawing, ...]:
        """Drawings beside the cutting paths in the format ``dxf``."""
        return ()

    @cached_property
    def sheets(self) -> tuple[Sheet, ...]:
        """The workshop drawings."""
        from gearcam.sheets.part import part_sheet
        from gearcam.sheets.wheel import check_runout

        check_runout(self.design.drawing, self.parts)
        with files_in(self.design.files_in):
            return tuple(
                part_sheet(
                    part,
                    self.data(number),
                    self.heading(number),
                    turning=self.turning(number),
                    teeth=self.teeth(number),
                    values=self.values(number),
                    notes=self.notes(number),
                )
                for number, part in enumerate(self.parts)
            )

    def data(self, number: int) -> dict[str, str]:
        """Return the table of data on the drawing of the part of a `number` from 0."""
        from gearcam.sheets.paper import sheet_rows

        return sheet_rows(self.facts, self.rows_of(number))

    def notes(self, number: int) -> list[str]:
        """Return notes on the drawing of the part of a `number` from 0: the file of its outline."""
        from gearcam.base.inches import file_unit
        from gearcam.sheets.sheet import fine

        unit = file_unit().name
        part, output = self.parts[number], self.design.output
        steps = len(part.contours)
        file = f"{part.name}.dxf"
        if steps > 1:
            file = f"{part.name}_step1.dxf to {part.name}_step{steps}.dxf"
        if "dxf" not in output.files:
            file += " (not written with this drawing)"
        elif output.kerf:
            file += f", moved by half the kerf of {fine(output.kerf)} {unit}"
        return [f"Outline: {file}, chord tolerance {fine(part.tolerance)} {unit}."]

    def teeth(self, number: int) -> Teeth | None:  # noqa: ARG002
        """Return the teeth of the part of a `number` from 0, if it has some."""
        return None

    def turning(self, number: int) -> Sense | None:  # noqa: ARG002
        """Return how the part of a `number` from 0 turns, if its drawing shows it."""
        return None

    def values(self, number: int) -> Values:  # noqa: ARG002
        """Return the table of values on the drawing of the part of a `number` from 0."""
        from gearcam.sheets.paper import NO_VALUES

        return NO_VALUES

    def heading(self, number: int | None) -> Heading:
        """Return what the title block says of the part of a `number` from 0, or of all together."""
        from gearcam.sheets.paper import Heading

        design, count = self.design, len(self.parts)
        return Heading(title=design.name, notes=design.drawing, number=number, of=count)

    @cached_property
    def solids(self) -> dict[str, Trimesh]:
        """The parts as closed `trimesh.Trimesh` objects by name, mm, each in its own frame.

        They extend from z = 0 to the width, hubs beyond it; `InfeasibleError` if impossible.

        Examples
        --------
        >>> import gearcam as gc
        >>> result = gc.build(gc.load("profiles/ellipse.toml"))
        >>> solid = result.solids["gear1"]
        >>> solid.is_watertight
        True
        """
        from gearcam.export.mesh import trimeshes

        return trimeshes(self.meshes)

    @cached_property
    def meshes(self) -> dict[str, Mesh]:
        """The parts as closed meshes of plain arrays by name, mm, as used for files."""
        from gearcam.parts.solids import solid

        return {part.name: solid(part) for part in self.parts}

    def standing(self, chords: float = 0.0) -> dict[str, tuple[Mesh, SpacePose]]:
        """Return the meshes and their places in the assembly (see `Result`)."""
        if (self.design.output.chord_tolerance or 0.0) < chords:
            return self.with_chords(chords).standing()
        places = zip(self.meshes.items(), self.poses, strict=True)
        return {name: (mesh, pose.in_space) for (name, mesh), pose in places}

    @property
    def dxf_style(self) -> DxfStyle:
        """The options of DXF."""
        from gearcam.export.dxf import DxfStyle

        output = self.design.output
        version = output.dxf_version or ("R12" if output.dxf_curves == "lines" else "R2010")
        tolerance = self.profile_tolerance
        return DxfStyle(tolerance=tolerance, curves=output.dxf_curves, version=version)

    def errors_of_parts(self) -> Iterator[tuple[str, Sequence[str]]]:
        """Yield the `main_errors` of area and volume, if they are estimated for a mass."""
        rows = self.error_rows
        areas = [name for name in rows if name.endswith("area_mm2")]
        if "volume_mm3" in rows:
            yield from [("area", areas)] if areas else []
            yield "volume (mass in the same proportion)", ["volume_mm3"]

    @cached_property
    def accuracy(self) -> Tree:
        """The estimated errors as facts (see `Staged`)."""
        rows = {**self.error_rows, "chord_mm": (self.chord_error, _CHORD_HOW)}
        how = {name: words for name, (_, words) in rows.items()}
        return {**{name: float(value) for name, (value, _) in rows.items()}, "how": how}


def part_files(texts: Mapping[str, str]) -> dict[str, Callable[..., Files]]:
    """Return what makes the files of parts, for the ``files`` of a kind.

    Parameters
    ----------
    texts : mapping of str to str
        By format, two paragraphs for the reference: ``Files: ...`` with the names of the files, and
        what they hold.

    Returns
    -------
    dict of str to FileMaker
        By format, each with the text in its docstring.
    """
    makers = {}
    for name, text in texts.items():
        makers[name] = partial(_MAKERS[name])
        makers[name].__doc__ = f"Return the files {name}.\n{text}"
    return makers


def dxf_files(result: PartsResult, drawings: Sequence[Drawing], measured: Measured) -> Files:
    """Return drawings as DXF files, each read back and measured.

    Parameters
    ----------
    result : PartsResult
        The result with the options of DXF.
    drawings : sequence of Drawing
        Each becomes a file of its name.
    measured : dict
        Receives the measured errors.

    Returns
    -------
    dict of str to bytes
        Contents by file name.
    """
    from gearcam.export.dxf import dxf_bytes
    from gearcam.export.dxf_read import Known, measure_dxf

    style = result.dxf_style
    curve = (
        "the edge, or its parallel at half the kerf" if result.design.output.kerf else "the curve"
    )
    how = f"files read back ({style.curves}), against {curve}, both ways"
    accuracy = measured.setdefault("accuracy", {"dxf_mm": {}, "how": {"dxf_mm": how}})
    files: Files = {}
    outlines: Known = {}
    for drawing in drawings:
        name = f"{drawing.name}.dxf"
        files[name] = dxf_bytes(drawing, style)
        if drawing.contours:
            accuracy["dxf_mm"][name] = measure_dxf(files[name], drawing.contours, outlines)
    return files


def _dxf(result: PartsResult, measured: Measured) -> Files:
    """Return the cutting paths and their references as DXF."""
    return dxf_files(result, [*result.to_cut, *result.references], measured)


def _cut_svg(result: PartsResult, _: Measured) -> Files:
    """Return files for a laser: one for each plate, and a sheet with all of them, labelled."""
    from gearcam.export.cut_svg import cut_svg
    from gearcam.export.laser_sheet import labelled, nested

    title, kerf = result.design.name, result.design.output.kerf
    files = {
        f"{one.name}_cut.svg": cut_svg([one], f"{title}, {one.name}", kerf) for one in result.to_cut
    }
    sheet = nested([labelled(one) for one in result.to_cut])
    return files | {"cut.svg": cut_svg(sheet, title, kerf)}


def _svg(result: PartsResult, _: Measured) -> Files:
    """Return the picture of the assembled parts."""
    from gearcam.export.svg import svg_bytes

    notes, drawing = result.facts.headline, result.drawing
    return {f"{drawing.name}.svg": svg_bytes(drawing, title=result.design.name, notes=notes)}


def _mesh(kind: str, result: PartsResult, measured: Measured) -> Files:
    """Return the meshes of the parts, and of the assembly, in a format."""
    from gearcam.export.mesh import mesh_bytes
    from gearcam.parts.solids import volume_error

    meshes = result.meshes
    measured["solids"] = {
        part.name: {
            "volume_mm3": meshes[part.name].volume,
            "volume_error_mm3": volume_error(part),
            "triangles": len(meshes[part.name].triangles),
        }
        for part in result.parts
    }
    scenes = {name: {name: mesh} for name, mesh in meshes.items()}
    if result.assembly:
        scenes[result.assembly] = result.assembled()
    return {f"{stem}.{kind}": mesh_bytes(kind, scene, stem) for stem, scene in scenes.items()}


def _step(result: PartsResult, _: Measured) -> Files:
    """Return the parts, and their assembly, as STEP files."""
    from gearcam.export.step import Item, step_bytes
    from gearcam.numeric.pose import UNMOVED

    parts, assembly, close = result.parts, result.assembly, _STEP_PART * result.profile_tolerance
    shapes: dict[Item, Any] = {}
    files = {
        f"{part.name}.step": step_bytes([(part, UNMOVED)], part.name, close, shapes)
        for part in parts
    }
    if assembly:
        placed = list(zip(parts, result.poses, strict=True))
        files[f"{assembly}.step"] = step_bytes(placed, assembly, close, shapes)
    return files


def sheet_files(kind: str, sheets: Sequence[Sheet], title: str, style: DxfStyle) -> Files:
    """Return workshop drawings as files.

    Parameters
    ----------
    kind : {"dxf", "svg", "pdf"}
        Their format.
    sheets : sequence of Sheet
        The drawings.
    title : str
        Title of a PDF.
    style : DxfStyle
        How outlines are written in DXF.
    """
    from gearcam.export.sheet_dxf import sheet_dxf
    from gearcam.export.sheet_pdf import sheet_pdf
    from gearcam.export.sheet_svg import sheet_svg

    write: dict[str, Callable[[Sheet], bytes]] = {
        "dxf": lambda one: sheet_dxf(one, style),
        "svg": sheet_svg,
        "pdf": lambda one: sheet_pdf([one], title),
    }
    return {f"{one.name}_drawing.{kind}": write[kind](one) for one in sheets}


def _sheets(kind: str, result: PartsResult, _: Measured) -> Files:
    """Return the workshop drawings in a format."""
    return sheet_files(kind, result.sheets, result.design.name, result.dxf_style)


def _print_pdf(result: PartsResult, _: Measured) -> Files:
    """Return the plates at full size, on pages to be glued together."""
    from gearcam.export.sheet_pdf import sheet_pdf
    from gearcam.sheets.tiles import WINDOW, tiles

    name = result.design.name
    return {
        f"{one.name}_print.pdf": sheet_pdf(tiles(one, name), name, WINDOW) for one in result.printed
    }


_MAKERS: Final[Mapping[str, Callable[..., Files]]] = {
    "dxf": _dxf,
    "cut-svg": _cut_svg,
    "svg": _svg,
    **{kind: partial(_mesh, kind) for kind in MESHES},
    "step": _step,
    **{name: partial(_sheets, name.removeprefix("drawing-")) for name in DRAWINGS},
    "print-pdf": _print_pdf,
}
"""What makes each format of files of parts."""
