"""Tables of laws and phases, for tests that look at their keys."""

from __future__ import annotations

from gearcam.designs.table import Table, table_of
from gearcam.kinds.cam.motion import PHASE, by_formula, by_rows
from gearcam.kinds.gear_pair.design import LAW
from gearcam.kinds.globoidal_cam.design import INDEX
from gearcam.laws.motion import MOTION_LAWS
from gearcam.laws.phases_of_lift import PHASES

WITH_LAW = tuple(PHASE.below)
"""Phases that have a law."""


def law_table(name: str) -> Table:
    """Return the keys of a ratio law, by its `name`."""
    return table_of(LAW.title, LAW.class_of(name))


def rise_table(name: str) -> Table:
    """Return the keys of a motion law, by its `name`."""
    return table_of(PHASE.title, MOTION_LAWS[name].parameters)


def phase_table(name: str) -> Table:
    """Return the keys of a phase but for those of its law, by its `name`."""
    return table_of(PHASE.title, PHASES[name])


def index_table(law: str) -> Table:
    """Return the keys of an index with a `law`."""
    own = table_of(INDEX.title, MOTION_LAWS[law].parameters)
    assert INDEX.own is not None
    return Table(INDEX.title, None, {**INDEX.own.entries, **own.entries})


def turn_tables() -> tuple[Table, ...]:
    """Return the keys of motions of the whole turn: by rows, and by a formula."""
    return by_rows().table, by_formula().table
