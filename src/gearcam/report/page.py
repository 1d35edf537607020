"""The page: blocks from facts and findings, data for the script, all in one file.

A *document* is the content of a page, ready for JSON: ``title``, ``kind``; ``blocks``, HTML by the
id of its section; ``scene`` and ``charts`` (see `gearcam.report.data`). A page contains one
document; the live view sends others to it.
"""

from __future__ import annotations

import base64
import json
import math
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Final

from gearcam.base.inches import told
from gearcam.base.numerals import formatted, size_of
from gearcam.report.data import chart_data, scene_data
from gearcam.results.advice import Remedies, remedies

if TYPE_CHECKING:
    from jinja2 import Environment

    from gearcam.base.facts import Facts
    from gearcam.base.findings import Finding
    from gearcam.pictures.charts import Chart
    from gearcam.pictures.scenes import Scene
    from gearcam.results.result import Result

PAGE: Final = "report.html"
"""File name."""

BLOCKS: Final = (
    "verdict",
    "remedies",
    "main",
    "findings",
    "pictures",
    "files",
    "facts",
    "accuracy",
)
"""Sections of the page that are written from facts, each by a template."""

DRAFTED: Final = ("verdict", "remedies", "main", "findings", "facts")
"""Blocks that are updated while a slider is dragged."""

LEADING: Final = 3
"""Number of charts that are updated then: those in sight."""

DRAFT_PLACES: Final = 120
"""Steps of the driver in the scene of a draft: 3 degrees of a turn, interpolated linearly."""

_CHARTS: Final = (
    "uPlot/uPlot.iife.min.js",
    "numbers.js",
    "parts.js",
    "saves.js",
    "chart_saves.js",
    "chart_hand.js",
    "charts.js",
    "chart_set.js",
)
"""Parts of the script that draw charts, each after those that it needs."""

SCRIPTS: Final = (
    "scene.js",
    *_CHARTS,
    "blocks.js",
    "places.js",
    "measure.js",
    "page.js",
    "address.js",
)
"""Parts of the script of a page with moving parts."""

STILL: Final = (*_CHARTS, "blocks.js", "charts_page.js")
"""Parts of the script of a page without moving parts."""

SOLIDS: Final = ("solids_cut.js", "solids_measure.js", "solids.js")
"""Parts of the script before those, where solids are shown."""

NO_SOLIDS: Final = ("no_solids.js",)
"""The same elsewhere."""

_HOME: Final = Path(__file__).parent

_USES: Final = {
    "dxf": "outlines to cut",
    "svg": "a drawing",
    "pdf": "a drawing",
    "stl": "solids to print",
    "3mf": "solids to print",
    "step": "solids for CAD",
    "glb": "solids to look at",
    "csv": "a table",
    "nc": "a program for a milling machine",
    "ngc": "a program for a milling machine",
    "json": "all numbers",
}
"""What files are for, by the end of their names."""

_VERDICTS: Final = {
    "error": "Do not cut this yet",
    "warning": "Look before you cut",
    "note": "Ready to cut",
}
"""Verdict by the severity of the worst finding."""

_OF_MOTIONS: Final = {
    "error": "Do not build this yet",
    "warning": "Look before you build",
    "note": "Nothing is wrong with the motion",
}
"""Those of kinds without parts to cut."""


def page(
    document: Mapping[str, Any],
    *,
    live: Mapping[str, Any] | None = None,
    solids: Mapping[str, str] | None = None,
) -> bytes:
    """Return a page.

    Parameters
    ----------
    document : mapping
        Its content (see `document`).
    live : mapping, optional
        Data of the live view for its script; without them the page stands alone.
    solids : mapping, optional
        A view of the solids (see `gearcam.report.file`); the live view asks for it itself.

    Returns
    -------
    bytes
        HTML, UTF-8, including scripts, styles and data.
    """
    held = bool((solids or {}).get("view") or (live and document.get("solids")))
    scripts = (*(SOLIDS if held else NO_SOLIDS), *(SCRIPTS if document["scene"] else STILL))
    styles = ("uPlot/uPlot.min.css", "page.css", *(("solids.css",) if held else ()))
    values = {
        "document": document,
        "data": _embedded(document),
        "live": _embedded(live) if live else "",
        "solids": solids or {},
        "view": _embedded((solids or {}).get("view", "")),
        "style": _contents(*styles),
        "script": _contents(*scripts),
        "live_style": _contents("live.css") if live else "",
        "live_script": _contents("handles.js", "live.js") if live else "",
        "licence": _contents("uPlot/LICENSE"),
    }
    return rendered("page.html", values).encode()


def charts_page(title: str, charts: Sequence[Chart], text: str) -> bytes:
    """Return a page of charts.

    Parameters
    ----------
    title : str
        Its title.
    charts : sequence of Chart
        With different titles; all are in sight.
    text : str
        Lines below the charts, in letters of one width.

    Returns
    -------
    bytes
        HTML, UTF-8, including scripts, styles and data.
    """
    data = [chart_data(chart.title, chart, "") for chart in charts]
    values = {
        "title": title,
        "text": text,
        "data": _embedded({"title": title, "charts": data}),
        "style": _contents("uPlot/uPlot.min.css", "page.css"),
        "script": _contents(*NO_SOLIDS, *STILL),
        "licence": _contents("uPlot/LICENSE"),
    }
    return rendered("charts.html", values).encode()


def sweep_page(title: str, words: Mapping[str, Any], content: Mapping[str, Any]) -> bytes:
    """Return the page of a sweep.

    Parameters
    ----------
    title : str
        Its title.
    words : mapping
        ``lines`` at the top, ``reasons`` of refusals with their numbers, ``constant`` facts, and
        whether goals are ``sought``: then the best come before all charts but one.
    content : mapping
        Data for the script (see `gearcam.sweeps.page`).

    Returns
    -------
    bytes
        HTML, UTF-8, including script, style and data.
    """
    values = {
        "title": title,
        "data": _embedded(content),
        "style": _contents("page.css", "sweep.css"),
        "script": _contents("numbers.js", "sweep.js", "sweep_best.js", "sweep_page.js"),
    }
    return rendered("sweep.html", values | dict(words)).encode()


def document(
    result: Result, measured: Mapping[str, Any] = MappingProxyType({}), *, seek: bool = True
) -> dict[str, Any]:
    """Return the content of the page of a result.

    Parameters
    ----------
    result : Result
        Of any kind of design.
    measured : mapping
        Facts measured on its files, by group.
    seek : bool
        Whether to search for remedies of errors, which takes some seconds.

    Returns
    -------
    dict
        ``title``, ``kind``, ``blocks``, ``scene`` (None without moving parts), ``charts``,
        ``solids`` (``"first"``, ``"after"`` or nothing, see `Result.place_of_solids`).

    Raises
    ------
    InfeasibleError
        If the design cannot be made.
    """
    scene = result.scene()
    driver = scene.driver if scene else ""
    return {
        "title": result.design.name,
        "kind": result.design.kind,
        "solids": result.place_of_solids,
        "scene": _shown(result, scene) if scene else None,
        "charts": [
            chart_data(name, result.chart(name), driver, result.design.files_in)
            for name in result.charts
        ],
        "blocks": blocks(result, measured, seek=seek),
    }


def _shown(result: Result, scene: Scene) -> dict[str, Any]:
    """Return the data of a scene with the speed of its driver, rpm; None where it has none."""
    drive = getattr(result.design, "drive", None)
    speed = getattr(drive[0] if isinstance(drive, tuple) and drive else drive, "speed", None)
    turns = scene.driver.endswith(", deg")
    rpm = None if speed is None or not turns else speed * 30.0 / math.pi
    return scene_data(scene) | {"rpm": rpm}


def draft(result: Result) -> dict[str, Any]:
    """Return the part of a document that follows a slider.

    Parameters
    ----------
    result : Result
        Of any kind of design.

    Returns
    -------
    dict
        As `document` does, with ``leading``, the first charts, instead of ``charts``; without
        studies, remedies, estimated errors and values that help.
    """
    result = result.plain
    scene = result.scene(DRAFT_PLACES)
    driver = scene.driver if scene else ""
    return {
        "title": result.design.name,
        "kind": result.design.kind,
        "scene": _shown(result, scene) if scene else None,
        "leading": [
            chart_data(name, one, driver, result.design.files_in)
            for name, one in result.leading(LEADING)
        ],
        "blocks": _rendered(
            DRAFTED,
            result,
            result.facts_without_accuracy,
            result.findings_without_hints,
            remedies=Remedies(),
        ),
    }


def with_draft(whole: Mapping[str, Any], part: Mapping[str, Any]) -> dict[str, Any]:
    """Return a document with what a draft has anew.

    Parameters
    ----------
    whole : mapping
        See `document`.
    part : mapping
        See `draft`.

    Returns
    -------
    dict
        A document.
    """
    anew = {one["name"]: one for one in part["leading"]}
    others = {key: value for key, value in part.items() if key != "leading"}
    charts = [anew.get(one["name"], one) for one in whole["charts"]]
    return {**whole, **others, "charts": charts, "blocks": {**whole["blocks"], **part["blocks"]}}


def blocks(
    result: Result,
    measured: Mapping[str, Any] = MappingProxyType({}),
    *,
    seek: bool = True,
) -> dict[str, str]:
    """Return blocks of HTML by name.

    Parameters
    ----------
    result : Result
        Of any kind of design.
    measured : mapping
        Facts measured on its files, by group.
    seek : bool
        Whether to search for remedies of errors, which takes some seconds.

    Returns
    -------
    dict of str to str
    """
    facts = result.facts.with_groups(measured)
    return _rendered(
        BLOCKS,
        result,
        facts,
        result.findings,
        remedies=remedies(result) if seek else Remedies(),
        files={name: size_of(size) for name, size in result.sizes.items()},
        uses={name: _USES.get(name.rpartition(".")[2], "") for name in result.sizes},
        errors=[*_errors(result, facts)],
        pictures=[*_pictures(result)],
    )


def _rendered(
    names: Sequence[str], result: Result, facts: Facts, findings: Sequence[Finding], **more: Any
) -> dict[str, str]:
    """Return blocks by name, of some facts and findings of a result."""
    design = result.design
    values = {
        "title": design.name,
        "facts": told(facts, design.files_in),
        "findings": told(tuple(findings), design.units),
        "verdict": verdict(result, findings),
        **more,
    }
    return {name: rendered(f"{name}.html", values) for name in names}


def rendered(name: str, values: Mapping[str, Any]) -> str:
    """Return the HTML of a template in this folder, by `name`, filled with `values`."""
    return _templates().get_template(name).render(values)


def verdict(result: Result, findings: Sequence[Finding]) -> tuple[str, str]:
    """Return the worst severity of a result's `findings`, note without any, and the verdict."""
    severities = {one.severity for one in findings}
    worst = next((one for one in _VERDICTS if one in severities), "note")
    return worst, (_VERDICTS if result.kind.cut else _OF_MOTIONS)[worst]


def _errors(result: Result, facts: Facts) -> Iterator[tuple[str, str]]:
    """Yield label and value of each error that users act on: the largest of all parts."""
    for label, names in result.main_errors:
        rows = (facts.quantity(f"accuracy.{name}") for name in names)
        largest = max(rows, key=lambda one: one.value)
        yield label, told(largest.text, result.design.files_in)


def _pictures(result: Result) -> Iterator[tuple[str, str]]:
    """Yield name and content of the pictures of studies, for the source of an image."""
    for study in result.studies.values():
        for name, content in study.pages.items():
            if name.endswith(".svg"):
                yield name, base64.b64encode(content).decode()


@cache
def _templates() -> Environment:
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    templates = Environment(
        loader=FileSystemLoader(_HOME),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    templates.filters["shown"] = formatted
    return templates


@cache
def _contents(*names: str) -> str:
    """Return the contents of files of this folder, joined."""
    return "\n".join((_HOME / name).read_text(encoding="utf-8") for name in names)


def _embedded(data: Any) -> str:
    """Return data as JSON without ``<``, which could end the script element."""
    text = json.dumps(data, ensure_ascii=False, allow_nan=False, separators=(",", ":"))
    return text.replace("<", "\\u003c")
