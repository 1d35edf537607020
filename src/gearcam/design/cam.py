"""The kind ``cam``: its design, its tables, and the rules between them."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache, partial
from typing import Any, Final

from gearcam.cams.spec import KIND as NAME
from gearcam.cams.spec import CamSpec, FollowerSpec, size_problems
from gearcam.design.examine import home_of
from gearcam.design.kinds import KINDS, Examined, Kind, told_faults
from gearcam.design.motion import TITLE, examine_motion, homes, motion_of
from gearcam.design.outputs import CAM_FORMATS, CamOutputSpec, output_faults
from gearcam.design.spec import Wanted, settle
from gearcam.design.tables import Table, table_of
from gearcam.design.wording import Fault, show
from gearcam.errors import DesignError, Problem
from gearcam.laws.phases_of_lift import PHASES, Phase, RisePhase
from gearcam.laws.rises.base import RISES
from gearcam.parts.blank import CAM_KIND as PARTS_KIND
from gearcam.parts.blank import Blank, WheelBlank

LATER_FORMS: Final = ("groove", "conjugate", "cylinder", "translating")
"""Forms of cams that are planned."""

_OF_WHEELS: Final = ("stop_pin", "tip_rounding", "timing_marks", "mark_diameter")
"""What a blank has for wheels only."""

_BLANK_WORDS: Final = {
    "bore_diameter": "bore; none if left out",
    "keyway_angle": "its direction in the cam's frame",
    "bolt_angle": "direction of the first in the cam's frame",
    "rim": "rim that they keep below the profile",
}
"""Meanings that are told of wheels otherwise."""


@dataclass(frozen=True, eq=False, kw_only=True)
class CamDesign:
    """A cam with its follower as it is asked for.

    Parameters
    ----------
    name : str
        Name of the design and of its folder: letters, digits, ``_ - .``
    source : str
        The file it came from, empty for a design made in Python.
    phases : tuple of Phase
        The lift over a turn of the cam.
    follower : FollowerSpec
        What touches the cam, and how it is guided.
    cam : CamSpec
        Form, size, direction of turning.
    blank : WheelBlank
        Bore, hub, holes, density; a cam has no timing marks.
    limits : mapping of str to float
        Limits of checks by name, in mm and rad; the others keep their defaults.
    output : CamOutputSpec
        Files and their tolerance.

    Raises
    ------
    DesignError
        If a value is not what a design file may hold, all problems at once.
    """

    name: str
    source: str = ""
    phases: tuple[Phase, ...]
    follower: FollowerSpec
    cam: CamSpec
    blank: WheelBlank = field(default_factory=WheelBlank)
    limits: Mapping[str, float] = field(default_factory=dict)
    output: CamOutputSpec = field(default_factory=CamOutputSpec)

    def __post_init__(self) -> None:
        object.__setattr__(self, "limits", dict(self.limits))
        if isinstance(self.phases, Sequence):
            object.__setattr__(self, "phases", tuple(self.phases))
        if isinstance(self.blank, WheelBlank):
            object.__setattr__(self, "blank", _unmarked(self.blank, self.source))
        settle(self, _wanted(self.phases))

    @property
    def kind(self) -> str:
        """The kind of design, as in a file."""
        return NAME


def _unmarked(blank: WheelBlank, source: str) -> WheelBlank:
    """Take the timing marks off a blank, and refuse what else only wheels have."""
    plain = {item.name: item.default for item in dataclasses.fields(WheelBlank)}
    problems = [
        Problem("a cam has none", file=source, key=f"blank.{name}", value=getattr(blank, name))
        for name in _OF_WHEELS
        if name != "timing_marks" and getattr(blank, name) != plain[name]
    ]
    if problems:
        raise DesignError(problems)
    return dataclasses.replace(blank, timing_marks=False)


def _wanted(phases: Any) -> Iterator[Wanted]:
    if not isinstance(phases, tuple):
        yield "phases", phases, (tuple,)
        return
    for number, phase in enumerate(phases):
        yield f"motion[{number}]", phase, tuple(PHASES.values())
        if isinstance(phase, RisePhase) and phase.law in RISES:
            yield f"motion[{number}].shape", phase.shape, (RISES[phase.law].parameters,)


@lru_cache(maxsize=1)
def _blank_table() -> Table:
    """Return the table of a cam's blank: the keys of a pair's, with one value each."""
    entries = {}
    for key, entry in table_of("blank", Blank).entries.items():
        if entry.name not in _OF_WHEELS:
            words = _BLANK_WORDS.get(entry.name, entry.param.doc)
            entries[key] = dataclasses.replace(
                entry,
                param=dataclasses.replace(entry.param, both=False, doc=words),
                length=None,
                default=entry.default and entry.default[0],
            )
    return Table("blank", WheelBlank, entries)


def _examine_motion(document: Mapping[str, Any], found: Examined) -> None:
    examine_motion(document, found, partial(home_of, KINDS[NAME]))


def _later(document: Mapping[str, Any]) -> Fault | None:
    cam = document.get("cam")
    form = cam.get("form") if isinstance(cam, Mapping) else None
    if document.get("kind") != NAME or form not in LATER_FORMS:
        return None
    message = f"{show(form)}: {form} cams are not built by this version yet"
    return Fault(("cam", "form"), message, form, '"disc"')


def _rules(document: Mapping[str, Any], found: Examined) -> Iterator[Fault]:
    output, follower = document.get("output"), document.get("follower")
    yield from output_faults(output)
    yield from _tool_faults(output, follower)
    if "follower" in found.parts and "cam" in found.parts:
        told = size_problems(found.parts["follower"], found.parts["cam"])
        yield from told_faults(told, table_of("cam", CamSpec), document["cam"], ("cam",))


def _tool_faults(output: Any, follower: Any) -> Iterator[Fault]:
    if not isinstance(output, Mapping) or not isinstance(follower, Mapping):
        return
    files, kind = output.get("files"), follower.get("type")
    asked = isinstance(files, list) and "tool-path" in files
    if asked and kind in ("flat", "point") and "tool_radius_mm" not in output:
        message = f"is missing: a {kind} follower gives a tool path no radius"
        yield Fault(("output", "tool_radius_mm"), message, allowed="a radius above 0")


KINDS.register(
    Kind(
        name=NAME,
        doc="a disc cam with its follower",
        design=CamDesign,
        main=TITLE,
        examine_main=_examine_motion,
        main_of=lambda design: motion_of(design.phases),
        homes=homes,
        tables={
            "follower": partial(table_of, "follower", FollowerSpec),
            "cam": partial(table_of, "cam", CamSpec),
            "blank": _blank_table,
            "output": partial(table_of, "output", CamOutputSpec),
        },
        required=("follower", "cam"),
        one_of={"cam": ("prime_radius_mm", "base_radius_mm")},
        rules=_rules,
        later=_later,
        formats=CAM_FORMATS,
        rooms=("gearcam.cams.checks", "gearcam.parts.checks"),
        checks=(NAME, PARTS_KIND),
        example={
            "motion": [
                {"type": "rise", "angle_deg": 120, "law": "cycloidal", "lift_mm": 10},
                {"type": "dwell", "angle_deg": 60},
                {"type": "return", "angle_deg": 120, "law": "cycloidal"},
                {"type": "dwell", "angle_deg": 60},
            ],
            "follower": {"type": "roller", "motion": "translating", "roller_radius_mm": 8},
            "cam": {"prime_radius_mm": 40, "thickness_mm": 12},
            "blank": {"bore_diameter_mm": 16},
            "output": {"files": ["dxf", "csv"]},
        },
        notes={
            "motion": "The lift over a turn of the cam: 360 deg in all, from 0 back to 0.",
            "cam": "prime_radius_mm or base_radius_mm; a flat follower has base_radius_mm",
        },
    )
)
