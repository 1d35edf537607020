"""What the command line says: tables that line up, sizes, progress on a terminal.

Results go to stdout, what went wrong to stderr; piped output is plain text.
"""

from __future__ import annotations

import contextlib
import json
import logging
import os
import sys
import textwrap
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, TextIO

from gearcam.numerals import decimal, shown

if TYPE_CHECKING:
    from gearcam.design.listing import Listed
    from gearcam.errors import InfeasibleError
    from gearcam.findings import Finding
    from gearcam.jobs import Written
    from gearcam.jobs.remedies import Remedies

DEBUG: Final = "GEARCAM_DEBUG"
"""The variable that asks for tracebacks."""

_WIDTH: Final = 96

_ROUNDING: Final = 1e-9
"""What is smaller, mm, is rounding of a study."""


def pair_lines(summary: Mapping[str, Any]) -> Iterator[str]:
    """Yield the line on the pair of a summary."""
    pair = summary.get("pair", {})
    teeth = " : ".join(str(count) for count in pair.get("teeth", ()))
    distance, module = pair.get("center_distance_mm"), pair.get("module_mm")
    if distance is not None and module is not None:
        yield f"centre distance {shown(distance)} mm, module {shown(module)} mm, teeth {teeth}"
    elif module is not None:
        way = pair["way_per_turn_mm"]
        yield f"wheel and rack, {shown(way)} mm a turn, module {shown(module)} mm, teeth {teeth}"
    rack = pair.get("rack", {})
    yielded = [
        f"{name} {shown(rack[name])} for the default {shown(default)}"
        for name, default in rack.get("yielded", {}).items()
    ]
    if yielded:
        yield f"of the rack gave way to given values: {', '.join(yielded)}"


def cam_lines(summary: Mapping[str, Any]) -> Iterator[str]:
    """Yield the lines on the cam of a summary, and on a profile that was followed."""
    cam, motion = summary.get("cam"), summary.get("motion", {})
    if cam is None:
        return
    lift = motion["lift"]["max"] - motion["lift"]["min"]
    radius = "base" if cam["follower"].endswith("flat") else "prime"
    follower = f"{'an' if cam['follower'][0] == 'o' else 'a'} {cam['follower']} follower"
    yield (
        f"{cam['form']} cam for {follower}, lift {shown(lift)} {motion['unit']}, "
        f"{radius} radius {shown(cam[f'{radius}_radius_mm'])} mm"
    )
    angles = cam["pressure_angle_deg"]
    told = [
        f"{shown(angles[f'{kind}_max'])} deg on the {kind}"
        for kind in ("rise", "return")
        if angles.get(f"{kind}_max", 0.0) > 0.0
    ]
    pressure = f"pressure angle up to {' and '.join(told)}; " if told else ""
    yield f"{pressure}motion C{motion['continuity']}"
    found = summary.get("followed")
    if found is not None:
        yield (
            f"the profile's lift differs from the program by up to "
            f"{shown(found['largest_difference'], 4)} {found['unit']} "
            f"(at {shown(found['at_deg'])} deg), error of its chords {shown(found['error'], 2)} "
            f"{found['unit']}"
        )


def meshing_lines(summary: Mapping[str, Any]) -> Iterator[str]:
    """Yield the table of the numbers of a meshing study, if the summary has one."""
    found = summary.get("meshing")
    if found is None:
        return
    ahead = "ahead" if found["advance_deg"] > 0 else "back"
    phases = (
        f"{found['steps_done']} phases"
        if found["complete"]
        else (f"{found['steps_done']} of {found['steps']} phases")
    )
    distance = found.get("center_distance_mm")
    mounted = "" if distance is None else f" at centre distance {shown(distance)} mm"
    yield f"{phases}{mounted}, driver turned {ahead} by {shown(abs(found['advance_deg']))} deg"
    rows = [
        ("contact ratio", found["contact_ratio"], ""),
        ("pairs in contact", found.get("pairs_in_contact"), ""),
        ("phases with interference", found.get("interference_steps"), ""),
        ("backlash along the pitch curve", found.get("backlash_mm"), "mm"),
        ("lag of the driven wheel, taken up", found.get("lag_mm"), "mm"),
        *_error_rows(found.get("transmission_error")),
        ("penetration of flanks", found["penetration_mm"], "mm"),
        ("chord error of outlines", found["chord_error_mm"], "mm"),
    ]
    for words, value, unit in rows:
        if value is not None:
            yield f"  {words:<33}  {_span(value)} {unit}".rstrip()


def _error_rows(error: Mapping[str, Any] | None) -> Iterator[tuple[str, Any, str]]:
    """Yield the rows on the transmission error of a study, if anything touched in it."""
    if error is None:
        return
    unit = error["unit"]
    yield "transmission error, peak to peak", error["peak_to_peak"], unit
    if "no_harmonics" in error:
        yield "its harmonics", f"not told: {error['no_harmonics']}", ""
    else:
        largest = max(error["harmonics"], key=lambda one: one["amplitude"])
        yield f"its largest harmonic, {largest['order']} a turn", largest["amplitude"], unit


def _span(value: Any) -> str:
    """Write a number, or the smallest and largest of some."""
    if isinstance(value, str):
        return value
    if not isinstance(value, Mapping):
        return shown(value, 4)
    low, high = (_small(value[end]) for end in ("min", "max"))
    return low if low == high else f"{low} to {high}"


def _small(value: float) -> str:
    """Write a number; what is rounding of millimetres is 0."""
    return shown(0.0 if abs(value) < _ROUNDING else value, 4)


def law_lines(law: Listed) -> Iterator[str]:
    """Yield what is told of a `law`: its name, its meaning, a line of facts, its keys."""
    yield f"{law.name}\n{wrapped(law.doc)}\n    {law.line}"
    width = 2 + max(len(key) for key, _ in law.rows)
    for key, words in law.rows:
        yield wrapped(words, first=f"    {key:<{width}}", rest=" " * (4 + width))
    yield ""


def finding_lines(findings: Sequence[Finding]) -> Iterator[str]:
    """Lay out findings as a table, each with its message below."""
    if not findings:
        yield "findings: none"
        return
    yield "findings"
    rows = []
    for finding in findings:
        limit = f"limit {_number(finding.limit, finding.unit)}" if finding.limit is not None else ""
        value = _number(finding.value, finding.unit)
        rows.append((finding.severity, finding.code, finding.where, value, limit))
    widths = [max(len(row[k]) for row in rows) for k in range(5)]
    for row, finding in zip(rows, findings, strict=True):
        cells = (f"{cell:<{width}}" for cell, width in zip(row, widths, strict=True) if width)
        yield "  " + "  ".join(cells).rstrip()
        yield wrapped(finding.message, first="      ", rest="      ")


def all_lines(written: Written) -> Iterator[str]:
    """Yield all that is said of what was `written`: sizes, study, findings, files."""
    yield from pair_lines(written.summary)
    yield from cam_lines(written.summary)
    yield from meshing_lines(written.summary)
    yield from finding_lines(written.findings)
    yield from written_lines(written)


def written_lines(written: Written) -> Iterator[str]:
    """Yield the files that were written, with their sizes, and those that were removed."""
    folder = written.directory
    yield f"written to {folder}"
    width = max(map(len, (*written.files, *written.removed)), default=0)
    for name in written.files:
        yield f"  {name:<{width}}  {_size(folder / name):>9}"
    for name in written.removed:
        yield f"  {name:<{width}}  removed: this build does not write it"
    yield from _stale_lines(written.summary.get("stale", {}))


def _stale_lines(stale: Mapping[str, str | None]) -> Iterator[str]:
    """Yield what is in the folder and does not belong to the design as it is."""
    known = [name for name, made in stale.items() if made is not None]
    unknown = [name for name in stale if name not in known]
    way = "build again: that makes them anew or removes them"
    if known:
        told = f"{', '.join(known)}: made from another state of the design; {way}"
        yield wrapped(f"stale: {told}", first="")
    if unknown:
        told = f"{', '.join(unknown)}: written by an earlier gearcam, from a design not recorded"
        yield wrapped(f"stale: {told}; {way}", first="")


def _number(value: float | None, unit: str) -> str:
    return "" if value is None else f"{shown(value)} {unit}".rstrip()


def _size(path: Path) -> str:
    try:
        count = path.stat().st_size
    except OSError:
        return ""
    if count < 1000:
        return f"{count} B"
    return f"{decimal(count / 1e3, 1)} kB" if count < 1e6 else f"{decimal(count / 1e6, 1)} MB"


def fault_text(error: Exception, file: str) -> str:
    """Return that the program is at fault, not the design in `file`, with the `error`."""
    place = f"{file}: " if file else ""
    return (
        f"{place}this is a fault of gearcam, not of your design: {type(error).__name__}: {error}\n"
        f"  please report it with the design file; {DEBUG}=1 or --debug shows where it happened"
    )


def infeasible_text(error: InfeasibleError) -> str:
    """Return why a design cannot be made, with its numbers and the way out, indented."""
    lines = [f"{error.what}, at {error.where}" if error.where else error.what]
    numbers = (("value", error.value), ("limit", error.limit))
    shown = [
        f"{name} {_number(number, error.unit)}" for name, number in numbers if number is not None
    ]
    lines += [", ".join(shown)] if shown else []
    lines += error.nearest.split("; ") if error.nearest else []
    return "\n".join(wrapped(line, first="  ", rest="      ") for line in lines)


def remedy_lines(found: Remedies) -> Iterator[str]:
    """Yield what a search for remedies found, and how far it came."""
    if found.found:
        yield "built without errors with one of these:"
    for remedy in found.found:
        less = f"  (not yet with {_changes(remedy.less)})" if remedy.less else ""
        yield f"  {_changes(remedy.changes)}{less}"
    keys = ", ".join(found.tried)
    if found.gave_up:
        sought = "more" if found.found else "a remedy"
        yield f"the search for {sought} was given up after {shown(found.seconds)} s"
    elif keys and not found.found:
        yield wrapped(f"no remedy was found by changing {keys}", first="", rest="  ")


def _changes(changes: Mapping[str, object]) -> str:
    return " and ".join(f"{key} = {_value(value)}" for key, value in changes.items())


def _value(value: object) -> str:
    """Write a value as a design file holds it."""
    if isinstance(value, list):
        return f"[{', '.join(map(_value, value))}]"
    if isinstance(value, float):
        return shown(value, 10)
    return json.dumps(value)


def wrapped(text: str, *, first: str = "    ", rest: str = "    ") -> str:
    """Return `text` folded to the width of a page, `first` and `rest` before its lines."""
    return textwrap.fill(
        text,
        _WIDTH,
        initial_indent=first,
        subsequent_indent=rest,
        break_long_words=False,
        break_on_hyphens=False,
    )


@contextlib.contextmanager
def progress_bar(file: str) -> Iterator[Callable[[str, int, int], None] | None]:
    """Draw a bar while long work runs, on a terminal; elsewhere there is nothing to call."""
    if not sys.stderr.isatty():
        yield None
        return
    from rich.console import Console
    from rich.progress import Progress

    with Progress(console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(file, total=None)

        def advance(stage: str, done: int, total: int) -> None:
            bar.update(task, description=f"{file}: {stage}", completed=done, total=total)

        yield advance


def quieten() -> None:
    """Keep back what libraries warn programmers of; errors are told all the same."""
    warnings.simplefilter("ignore")
    logging.getLogger().addHandler(logging.NullHandler())


def say(text: str) -> None:
    """Print to stdout."""
    _write(text, sys.stdout)


def complain(text: str) -> None:
    """Print to stderr."""
    _write(text, sys.stderr)


def _write(text: str, stream: TextIO) -> None:
    """Print; a reader that has gone (such as ``head``) is no reason to stop building."""
    try:
        print(text, file=stream, flush=True)
    except BrokenPipeError:
        # what is still buffered goes nowhere, and the flush at the end finds nothing broken
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
