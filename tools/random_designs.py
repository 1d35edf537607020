"""Random designs of every kind, as the texts of their files: most of them can be built.

    python tools/random_designs.py FOLDER --kind cam --count 20 --seed 3

A design is told by its kind, the seed and its number, and does not depend on how many others are
drawn. Laws, rises and followers take turns; a few designs have some value anywhere in its
documented range, which is refused as often as not.
"""

from __future__ import annotations

import argparse
import math
from pathlib import Path
from typing import Any, Final

from random_cams import cam
from random_draw import Draw, known_keys, places, schema, short, toml
from random_pairs import gear_pair

KINDS: Final = {"gear-pair": gear_pair, "cam": cam}
"""What draws a design of each kind."""

ANYWHERE: Final = 0.06
"""Share of designs with a value anywhere in its documented range."""

_SHARES: Final = {
    "gear-pair": {
        "svg": 0.7, "dxf": 0.1, "inspection": 0.15, "cut-svg": 0.06, "drawing-svg": 0.08,
        "drawing-dxf": 0.02, "stl": 0.05, "3mf": 0.02, "glb": 0.03, "step": 0.01, "report": 0.04,
    },
    "cam": {
        "svg": 0.8, "dxf": 0.3, "inspection": 0.3, "cut-svg": 0.2, "drawing-svg": 0.2,
        "drawing-dxf": 0.05, "stl": 0.1, "3mf": 0.05, "glb": 0.05, "step": 0.01,
        "tool-path": 0.2, "curvature": 0.3, "report": 0.06,
    },
}  # fmt: skip
"""Share of designs that have each file beside their tables, by what it costs."""

_CHEAP: Final = ("svg", "inspection")
"""Files that cost little for any number of vertices."""

_AFFORDABLE: Final = 1200.0
"""Vertices of a pair above which the other files are drawn less often."""


def design(kind: str, seed: int, index: int) -> dict[str, str]:
    """Return the files of a design by name: the design file first, then its tables.

    Parameters
    ----------
    kind : str
        One of `KINDS`.
    seed, index : int
        Which one.
    """
    d = Draw(f"{kind} {seed} {index}")
    name = f"{kind}-{seed}-{index}"
    document = {"kind": kind, "name": name, **KINDS[kind](d, index, blank)}
    document["output"] |= _output(d, document)
    if d.chance(0.15):
        document["limits"] = _limits(d, document)
    tables = _tables_as_files(d, document, name)
    if d.chance(ANYWHERE):
        table, key, node = d.pick([*places(document)])
        table[key] = d.value(key, node)
    return {f"{name}.toml": toml(document), **tables}


def blank(d: Draw, radius: float, unit: float, both: bool) -> dict[str, Any]:
    """Return a blank for a wheel or cam.

    Parameters
    ----------
    d : Draw
        Draws of this design.
    radius : float, mm
        What its openings keep within.
    unit : float, mm
        The size of its edges' details: the module.
    both : bool
        Whether it is for two wheels, which may differ.
    """
    made: dict[str, Any] = {}
    bore = short(radius * d.log(0.2, 0.9)) if d.chance(0.8) else 0.0
    reach = bore
    if bore:
        made["bore_diameter_mm"] = bore
        reach = _bore(d, bore, made)
        if both and d.chance(0.3):
            made["bore_diameter_mm"] = [bore, short(bore * d.even(1, 1.05))]
    if d.chance(0.3):
        made["hub_diameter_mm"] = short(1.1 * reach + radius * d.even(0.05, 0.3))
        reach = made["hub_diameter_mm"]
        made[d.pick(["hub_front_mm", "hub_back_mm"])] = short(unit * d.log(0.5, 10))
    if d.chance(0.25):
        bolt = short(radius * d.log(0.02, 0.1))
        count = d.whole(1, 8)
        circle = short(1.2 * max(reach + bolt, bolt * count / 2))
        made |= {"bolts": count, "bolt_diameter_mm": bolt, "bolt_circle_mm": circle}
        made["bolt_angle_deg"] = d.even(-180, 180)
    if d.chance(0.25):
        made["lightening_holes"] = d.whole(1, 8)
        made |= {key: short(unit * d.even(1, 3)) for key in ("rim_mm", "web_mm") if d.chance(0.4)}
    if d.chance(0.5):
        made["density_kg_m3"] = d.log(100, 20000)
    if d.chance(0.2):
        made |= {"clearance_mm": short(unit * d.log(1e-3, 0.05)), "clearance_bores": d.chance(0.5)}
    if both:
        _edges(d, unit, made)
    return made


def _bore(d: Draw, bore: float, made: dict[str, Any]) -> float:
    """Give a bore a keyway or a flat, and return the diameter that it takes."""
    if d.chance(0.3):
        width, depth = short(bore * d.even(0.1, 0.4)), short(bore * d.even(0.05, 0.2))
        angle = d.even(-180, 180)
        made |= {"keyway_width_mm": width, "keyway_depth_mm": depth, "keyway_angle_deg": angle}
        return 2.0 * math.hypot(0.5 * bore + depth, 0.5 * width)
    if d.chance(0.2):
        made["bore_flat_mm"] = short(bore * d.even(0.6, 0.95))
    return bore


def _edges(d: Draw, unit: float, made: dict[str, Any]) -> None:
    if d.chance(0.2):
        radius = short(unit * d.log(0.01, 0.15))
        made["tip_rounding_mm"] = d.pick([radius, [radius, 0], [0, radius]])
    if d.chance(0.2):
        made["timing_marks"] = d.chance(0.3)
    if d.chance(0.2):
        made["mark_diameter_mm"] = short(unit * d.even(0.2, 0.6))


def _vertices(document: dict[str, Any]) -> float:
    """Return about how many vertices the outlines of a pair have; time goes with them."""
    pair, steps = document["pair"], document.get("steps", {}).get("count", 1)
    module = pair.get("module_mm") or 2.0 * pair["center_distance_mm"] / sum(pair["teeth"])
    tolerance = document["output"].get("chord_tolerance_mm", min(1e-3, 1e-3 * module))
    return 1.7 * sum(pair["teeth"]) * steps * math.sqrt(module / tolerance)


def _output(d: Draw, document: dict[str, Any]) -> dict[str, Any]:
    kind = document["kind"]
    rarer = min(1.0, _AFFORDABLE / _vertices(document)) if kind == "gear-pair" else 1.0
    shares = {key: one * (1.0 if key in _CHEAP else rarer) for key, one in _SHARES[kind].items()}
    asked = [file for file, share in shares.items() if d.chance(share)]
    output: dict[str, Any] = {"files": ["csv", *asked]}
    if d.chance(0.3):
        output["dxf_curves"] = d.pick(["arcs", "lines", "lines", "splines"])
    elif d.chance(0.2):
        output["dxf_version"] = d.pick(["R2010", "R12"])
    if d.chance(0.15):
        output["kerf_mm"] = d.log(0.01, 0.3)
    if d.chance(0.3):
        output["inspection_points"] = d.whole(8, 40)
    return output


def _limits(d: Draw, document: dict[str, Any]) -> dict[str, Any]:
    """Return a limit or two about their defaults."""
    known = known_keys(known_keys(schema(), document)["limits"], {})
    limits = {}
    for key in {d.pick([*known]): None, d.pick([*known]): None}:
        node = known[key]
        usual = node.get("default", 0.5 * node.get("exclusiveMaximum", 1.0)) or 0.1
        drawn, most = short(usual * d.log(0.3, 3)), node.get("exclusiveMaximum", math.inf)
        drawn = usual if drawn >= most else drawn
        limits[key] = min(max(drawn, node.get("minimum", 0.0)), node.get("maximum", drawn))
    return limits


_COLUMNS: Final = (
    *("phi1_deg", "ratio", "phi2_deg", "r1", "x", "y"), "theta_deg", "lift_mm", "lift_deg"
)  # fmt: skip
"""Keys that may be columns of a file."""


def _tables_as_files(d: Draw, document: dict[str, Any], name: str) -> dict[str, str]:
    """Put the columns of a table into a file of their own, in half of the designs that have one."""
    files = {}
    tables = [document[title] for title in ("law", "motion") if title in document]
    rows = [row for table in tables for row in (table if isinstance(table, list) else [table])]
    for number, table in enumerate(rows):
        columns = [key for key in _COLUMNS if isinstance(table.get(key), list)]
        given = [table[key] for key in columns]
        is_table = "table" in (table.get("type"), table.get("law")) or "theta_deg" in columns
        if is_table and d.chance(0.5):
            file = f"{name}-{number}.csv"
            table |= {"file": file}
            for key in columns:
                del table[key]
            lines = [",".join(columns), *(",".join(map(repr, row)) for row in zip(*given))]  # noqa: B905
            files[file] = "\n".join(lines) + "\n"
    return files


def write(folder: Path, kind: str, seed: int, index: int) -> Path:
    """Write a design into a folder and return its file (see `design`): `kind`, `seed`, `index`."""
    folder.mkdir(parents=True, exist_ok=True)
    files = design(kind, seed, index)
    for name, text in files.items():
        (folder / name).write_text(text, encoding="utf-8")
    return folder / next(iter(files))


def main() -> None:
    """Write designs as the command line asks for."""
    parser = argparse.ArgumentParser(description="Write random designs.")
    parser.add_argument("folder", type=Path)
    parser.add_argument("--kind", choices=KINDS, action="append", help="all kinds if left out")
    parser.add_argument("--count", type=int, default=10, help="designs of each kind")
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    for kind in given.kind or KINDS:
        for index in range(given.count):
            write(given.folder, kind, given.seed, index)


if __name__ == "__main__":
    main()
