"""A design: everything that one build is asked for, in mm and rad."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from gearcam.design.examine import examine
from gearcam.design.tables import KIND, TABLES, OutputSpec, limits_table, table, table_of
from gearcam.design.wording import MISSING, dotted
from gearcam.errors import DesignError, Problem
from gearcam.gears.spec import HelixSpec, PairSpec, Rack
from gearcam.laws.base import LAWS
from gearcam.meshing.settings import MeshingSpec
from gearcam.parts.blank import Blank


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
        _demand_types(self)
        faults = examine(document_of(self)).faults
        if faults:
            raise DesignError(
                Problem(
                    message=fault.message,
                    file=self.source,
                    key=dotted(fault.path),
                    value=None if fault.value is MISSING else fault.value,
                    allowed=fault.allowed,
                    hint=fault.hint,
                )
                for fault in faults
            )

    @property
    def kind(self) -> str:
        """The kind of design, as in a file."""
        return KIND


def _demand_types(design: GearPairDesign) -> None:
    wanted = dict(TABLES)
    if design.law_type in LAWS:
        wanted["law"] = LAWS[design.law_type].parameters
    problems = [
        Problem(
            f"is a {type(getattr(design, key)).__name__}",
            file=design.source,
            key=key,
            allowed=f"an instance of {owner.__name__}",
        )
        for key, owner in wanted.items()
        if not isinstance(getattr(design, key), owner)
    ]
    if problems:
        raise DesignError(problems)


def document_of(design: GearPairDesign) -> dict[str, Any]:
    """Return what a design file with this design would hold.

    Parameters
    ----------
    design : GearPairDesign
        The design.

    Returns
    -------
    dict
        Nested dictionaries with the keys and units of a file.
    """
    law: dict[str, Any] = {"type": design.law_type}
    if design.law_type in LAWS:
        law |= table_of("law", type(design.law)).outward(_values(design.law))
    document: dict[str, Any] = {"kind": design.kind, "name": design.name, "law": law}
    for title in TABLES:
        document[title] = table(title).outward(_values(getattr(design, title)))
    if design.limits:
        known = limits_table().entries.values()
        keys = {entry.name: entry for entry in known}
        document["limits"] = {
            keys[name].key if name in keys else name: keys[name].outward(value)
            if name in keys
            else value
            for name, value in design.limits.items()
        }
    return document


def with_meshing(design: GearPairDesign, given: Mapping[str, Any]) -> GearPairDesign:
    """Return a design with other settings of its meshing study.

    Parameters
    ----------
    design : GearPairDesign
        The design.
    given : mapping of str to value
        Keys of the table ``[meshing]`` and values, in the units of a file.

    Returns
    -------
    GearPairDesign

    Raises
    ------
    DesignError
        If a value is not what the file may hold.
    """
    values = _values(design.meshing) | table("meshing").inward(given)
    return dataclasses.replace(design, meshing=MeshingSpec(**values))


def _values(owner: Any) -> dict[str, Any]:
    return {entry.name: getattr(owner, entry.name) for entry in dataclasses.fields(owner)}
