"""The kind ``gear-pair``: its design, its tables, and the rules between them."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import Any, Final, TypeGuard

from gearcam.design.examine import home_of
from gearcam.design.kinds import KINDS, Examined, Kind, made_of
from gearcam.design.models import faults_of
from gearcam.design.outputs import PAIR_FORMATS, OutputSpec, output_faults
from gearcam.design.spec import DesignLike, settle
from gearcam.design.tables import Table, table_of
from gearcam.design.wording import Fault, did_you_mean, quoted, show
from gearcam.errors import DesignError, Problem
from gearcam.gears.spec import HelixSpec, PairSpec, Rack
from gearcam.laws.ratio.base import LAWS
from gearcam.meshing.settings import KIND as MESHING_KIND
from gearcam.meshing.settings import MeshingSpec
from gearcam.parts.blank import KIND as PARTS_KIND
from gearcam.parts.blank import Blank

NAME: Final = "gear-pair"
"""As in a file, and the kind of the checks of teeth."""

_COARSEST: Final = 50
"""A chord tolerance coarser than module/50 no longer draws a tooth."""


@dataclass(frozen=True, eq=False, kw_only=True)
class GearPairDesign:
    """A pair of non-circular gears as it is asked for.

    Parameters
    ----------
    name : str
        Name of the design and of its folder: letters, digits, ``_ - .``
    source : str
        The file it came from, empty for a design made in Python.
    law_type : str
        Name of the law in the registry.
    law : object
        The law's parameters, an instance of ``LAWS[law_type].parameters``.
    pair : PairSpec
        Centre distance or module, tooth counts, width.
    rack : Rack
        The basic rack.
    blank : Blank
        Bores, hubs, holes, marks, edges, density.
    helix : HelixSpec
        Steps of stepped wheels.
    limits : mapping of str to float
        Limits of checks by name, in mm and rad; the others keep their defaults.
    output : OutputSpec
        Files and their tolerance.
    meshing : MeshingSpec
        Phases and mounting of a meshing study.

    Raises
    ------
    DesignError
        If a value is not what a design file may hold, all problems at once.
    """

    name: str
    source: str = ""
    law_type: str
    law: Any
    pair: PairSpec
    rack: Rack = field(default_factory=Rack)
    blank: Blank = field(default_factory=Blank)
    helix: HelixSpec = field(default_factory=HelixSpec)
    limits: Mapping[str, float] = field(default_factory=dict)
    output: OutputSpec = field(default_factory=OutputSpec)
    meshing: MeshingSpec = field(default_factory=MeshingSpec)

    def __post_init__(self) -> None:
        object.__setattr__(self, "limits", dict(self.limits))
        law = LAWS.get(self.law_type)
        settle(self, [("law", self.law, (law.parameters,))] if law else [])

    @property
    def kind(self) -> str:
        """The kind of design, as in a file."""
        return NAME


def with_meshing(design: DesignLike, given: Mapping[str, Any]) -> GearPairDesign:
    """Return a design with other settings of its meshing study.

    Parameters
    ----------
    design : DesignLike
        The design of a gear pair.
    given : mapping of str to value
        Keys of the table ``[meshing]`` and values, in the units of a file.

    Returns
    -------
    GearPairDesign

    Raises
    ------
    DesignError
        If nothing meshes in such a design, or a value is not what the file may hold.
    """
    if not isinstance(design, GearPairDesign):
        message = f"{show(design.kind)}: nothing meshes in it"
        raise DesignError(
            [Problem(message, file=design.source, key="kind", allowed=quoted([NAME]))]
        )
    values = KINDS[NAME].table("meshing").inward(given)
    return dataclasses.replace(design, meshing=dataclasses.replace(design.meshing, **values))


def law_table(law_type: str) -> Table:
    """Return the table of a law's parameters, without the key ``type``."""
    return table_of("law", LAWS[law_type].parameters)


def _examine_law(document: Mapping[str, Any], found: Examined) -> None:
    raw = document.get("law")
    names = quoted(LAWS)
    if not isinstance(raw, Mapping):
        if "law" in document:
            rule = f"a table [law] with type = {names}"
            found.faults.append(Fault(("law",), f"{show(raw)} is not a table", raw, rule))
        else:
            missing = Fault(("law",), "the table [law] is missing", allowed=f"type = {names}")
            found.faults.append(missing)
        return
    law_type = raw.get("type")
    if "type" not in raw:
        found.faults.append(Fault(("law", "type"), "is missing", allowed=names))
        return
    if not isinstance(law_type, str) or law_type not in LAWS:
        message = f"{show(law_type)} is not a law"
        hint = did_you_mean(law_type, LAWS)
        found.faults.append(Fault(("law", "type"), message, law_type, names, hint))
        return
    known = law_table(law_type)
    rest = {key: value for key, value in raw.items() if key != "type"}
    faults = list(faults_of(known, rest, home=partial(home_of, KINDS[NAME])))
    law, problems = made_of(known, LAWS[law_type].parameters, rest, faults, ("law",))
    found.faults += [*faults, *problems]
    if law is not None and not faults and not problems:
        found.parts |= {"law_type": law_type, "law": law}


def _law_of(design: GearPairDesign) -> dict[str, Any]:
    law: dict[str, Any] = {"type": design.law_type}
    known = design.law_type in LAWS
    return law | table_of("law", type(design.law)).document(design.law) if known else law


def _homes() -> Mapping[str, str]:
    laws: dict[str, list[str]] = {}
    for law_type in LAWS:
        for key in law_table(law_type).entries:
            laws.setdefault(key, []).append(f'"{law_type}"')
    homes = {
        key: f"this key belongs under [law] of type {' or '.join(types)}"
        for key, types in laws.items()
    }
    return homes | {"type": "this key belongs under [law]"}


def _rules(document: Mapping[str, Any], _: Examined) -> Iterator[Fault]:
    pair, output = document.get("pair"), document.get("output")
    yield from _pair_faults(pair)
    yield from output_faults(output)
    yield from _tolerance_faults(output, pair)
    yield from _meshing_faults(document.get("meshing"), pair)
    yield from _step_faults(document.get("meshing"), document.get("helix"))


def _pair_faults(raw: Any) -> Iterator[Fault]:
    if not isinstance(raw, Mapping):
        return
    rule = "exactly one of center_distance_mm and module_mm; the other is solved"
    distance, module = raw.get("center_distance_mm"), raw.get("module_mm")
    if distance is not None and module is not None:
        message = (
            f"center_distance_mm = {show(distance)} and module_mm = {show(module)} are both given"
        )
        yield Fault(("pair", "module_mm"), message, module, rule)
    elif distance is None and module is None:
        yield Fault(("pair",), "neither center_distance_mm nor module_mm is given", allowed=rule)


def _tolerance_faults(raw: Any, pair: Any) -> Iterator[Fault]:
    module = pair.get("module_mm") if isinstance(pair, Mapping) else None
    tolerance = raw.get("chord_tolerance_mm") if isinstance(raw, Mapping) else None
    if _is_number(module) and _is_number(tolerance):
        coarsest = module / _COARSEST
        if tolerance > coarsest > 0:
            message = f"{show(tolerance)} is too coarse for a module of {show(module)} mm"
            rule = f"at most module/{_COARSEST} = {coarsest:g} mm"
            yield Fault(("output", "chord_tolerance_mm"), message, tolerance, rule)


def _meshing_faults(raw: Any, pair: Any) -> Iterator[Fault]:
    if not isinstance(raw, Mapping):
        return
    start, end = raw.get("from_deg", 0), raw.get("to_deg")
    if _is_number(start) and _is_number(end) and not end > start:
        message = f"{show(end)}: the study ends at {show(end)} deg before it begins"
        yield Fault(("meshing", "to_deg"), message, end, "to_deg above from_deg")
    if raw.get("advance_deg") == 0:
        message = "0: without an advance no flanks overlap, and nothing can be seen"
        yield Fault(("meshing", "advance_deg"), message, 0, "-1 to 1, but not 0; 0.005 is usual")
    given = raw.get("teeth")
    teeth = given if isinstance(given, list) else []
    counts = pair.get("teeth") if isinstance(pair, Mapping) else None
    known = counts[0] if isinstance(counts, list) and counts else None
    for index, tooth in enumerate(teeth):
        path = ("meshing", "teeth", index)
        if _is_number(known) and _is_number(tooth) and tooth > known:
            message = f"the driver has no tooth {show(tooth)}"
            yield Fault(path, message, tooth, f"1 to {show(known)}")
        if tooth in teeth[:index]:
            yield Fault(path, f"{show(tooth)} is listed twice", tooth, "each tooth once")


def _step_faults(meshing: Any, helix: Any) -> Iterator[Fault]:
    step = meshing.get("helix_step", 1) if isinstance(meshing, Mapping) else 1
    steps = helix.get("steps", 1) if isinstance(helix, Mapping) else 1
    if _is_number(step) and _is_number(steps) and step > steps:
        message = f"the wheels have no step {show(step)}"
        yield Fault(("meshing", "helix_step"), message, step, f"1 to {show(steps)} (helix.steps)")


def _is_number(value: Any) -> TypeGuard[float]:
    return isinstance(value, int | float) and not isinstance(value, bool)


KINDS.register(
    Kind(
        name=NAME,
        doc="a pair of non-circular gears",
        design=GearPairDesign,
        main="law",
        examine_main=_examine_law,
        main_of=_law_of,
        homes=_homes,
        tables={
            title: partial(table_of, title, owner)
            for title, owner in {
                "pair": PairSpec,
                "rack": Rack,
                "blank": Blank,
                "helix": HelixSpec,
                "output": OutputSpec,
                "meshing": MeshingSpec,
            }.items()
        },
        required=("pair",),
        one_of={"pair": ("center_distance_mm", "module_mm")},
        rules=_rules,
        formats=PAIR_FORMATS,
        rooms=("gearcam.gears.checks", "gearcam.meshing.checks", "gearcam.parts.checks"),
        checks=(NAME, MESHING_KIND, PARTS_KIND),
        example={
            "law": {
                "type": "phases",
                "shape": "cosine",
                "knots_deg": [0, 160, 360],
                "ratios": [1.25, 0.75, 1.25],
            },
            "pair": {"center_distance_mm": 120, "teeth": [48, 48], "face_width_mm": 10},
            "blank": {"bore_diameter_mm": [16, 16]},
            "output": {"files": ["dxf", "csv"]},
        },
        notes={
            "law": "the ratio i21 = dphi2/dphi1 over the driver's angle",
            "pair": "exactly one of center_distance_mm and module_mm; the other is solved",
        },
    )
)
