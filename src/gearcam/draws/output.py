"""Random files of a design, limits of its checks, and tables in files of their own."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, Final

from gearcam.draws.documented import known_keys, schema
from gearcam.draws.draw import Draw, short

_CHEAP: Final = ("svg", "inspection")
"""Files that cost little for any number of vertices."""

_COLUMNS: Final = (
    *("phi1_deg", "ratio", "phi2_deg", "r1", "x", "y"), "theta_deg", "lift_mm", "lift_deg"
)  # fmt: skip
"""Keys that may be columns of a file."""


def asked(d: Draw, shares: Mapping[str, float], rarer: float = 1.0) -> dict[str, Any]:
    """Return which files a design has beside its tables, and how they are written.

    Parameters
    ----------
    d : Draw
        Draws of this design.
    shares : mapping of str to float
        Share of designs that have each kind of file.
    rarer : float
        Part of these shares where files cost more than usual.
    """
    often = {key: one * (1.0 if key in _CHEAP else rarer) for key, one in shares.items()}
    output: dict[str, Any] = {"files": ["csv", *(key for key in often if d.chance(often[key]))]}
    if d.chance(0.3):
        output["dxf_curves"] = d.pick(["arcs", "lines", "lines", "splines"])
    elif d.chance(0.2):
        output["dxf_version"] = d.pick(["R2010", "R12"])
    if d.chance(0.15):
        output["kerf_mm"] = d.log(0.01, 0.3)
    if d.chance(0.3):
        output["inspection_points"] = d.whole(8, 40)
    return output


def limits(d: Draw, document: Mapping[str, Any]) -> dict[str, Any]:
    """Return a limit or two of the checks of a `document`, about their defaults, by draws `d`."""
    known = known_keys(known_keys(schema(), document)["limits"], {})
    made = {}
    for key in {d.pick([*known]): None, d.pick([*known]): None}:
        node = known[key]
        usual = node.get("default", 0.5 * node.get("exclusiveMaximum", 1.0)) or 0.1
        drawn, most = short(usual * d.log(0.3, 3)), node.get("exclusiveMaximum", math.inf)
        drawn = usual if drawn >= most else drawn
        made[key] = min(max(drawn, node.get("minimum", 0.0)), node.get("maximum", drawn))
    return made


def tables_as_files(d: Draw, document: Mapping[str, Any], name: str) -> dict[str, str]:
    """Put the columns of a table into a file of their own, in half of the designs that have one.

    Parameters
    ----------
    d : Draw
        Draws of this design.
    document : mapping
        The design; its tables are changed.
    name : str
        Stem of the files.

    Returns
    -------
    dict of str to str
        Texts by file name.
    """
    files = {}
    tables = [one for one in document.values() if isinstance(one, list | dict)]
    rows = [row for table in tables for row in (table if isinstance(table, list) else [table])]
    for number, table in enumerate(rows):
        columns = [key for key in _COLUMNS if isinstance(table.get(key), list)]
        given = [table[key] for key in columns]
        is_table = "table" in (table.get("type"), table.get("law")) or "theta_deg" in columns
        if is_table and d.chance(0.5):
            file = f"{name}-{number}.csv"
            table["file"] = file
            for key in columns:
                del table[key]
            lines = [",".join(columns), *(",".join(map(repr, row)) for row in zip(*given))]  # noqa: B905
            files[file] = "\n".join(lines) + "\n"
    return files
