"""Random output settings and limits of a design, and its tables as CSV files."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, Final

from gearcam.designs.outputs import DRAWINGS
from random_designs.documented import known_keys, schema
from random_designs.draw import Draw, short

_CHEAP: Final = ("svg", "inspection")
"""Kinds of files that are cheap for any number of vertices."""

_COLUMNS: Final = (
    *("phi1_deg", "ratio", "phi2_deg", "r1", "x", "y"), "theta_deg", "lift_mm", "lift_deg",
    "angle_deg", "radius_mm",
)  # fmt: skip
"""Keys that can be columns of a CSV file."""


def asked(d: Draw, shares: Mapping[str, float], rarer: float = 1.0) -> dict[str, Any]:
    """Return a random table ``[output]``.

    Parameters
    ----------
    d : Draw
        Random numbers of this design.
    shares : mapping of str to float
        Share of designs with each kind of file.
    rarer : float
        Factor on these shares for designs whose files cost more than usual.
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


def drawn(d: Draw, design: dict[str, Any], *more: str) -> None:
    """Ask for a workshop drawing, and say more on it, in a few designs.

    Parameters
    ----------
    d : Draw
        Random numbers of this design.
    design : dict
        The design, which is changed.
    more : str
        Kinds of files beside those of drawings that may be asked for.
    """
    if not d.chance(0.1):
        return
    two = ["C45E", "POM"] if "pair" in design and d.chance(0.5) else "16MnCr5"
    all_of = {
        "part_number": "G-1024", "material": two, "heat_treatment": "hardened, 58 HRC",
        "surface": "Ra 1.6", "general_tolerances": "ISO 2768-mK", "revision": "B",
        "author": "A. Maker", "approved_by": "B. Checker", "owner": "Example Works",
        "date": "2030-01-31", "profile_tolerance_mm": short(d.log(0.005, 0.1)),
    }  # fmt: skip
    if design.get("blank", {}).get("bore_diameter_mm"):
        all_of["runout_mm"] = short(d.log(0.005, 0.1))
    design["drawing"] = {key: value for key, value in all_of.items() if d.chance(0.5)}
    kind = d.pick([*DRAWINGS, *more])
    design["output"]["files"] = list(dict.fromkeys([*design["output"]["files"], kind]))


def studies(d: Draw, design: dict[str, Any], stage: str, name: str = "accuracy") -> None:
    """Ask for a study in a few designs, and set that of accuracy to its cheapest.

    Parameters
    ----------
    d : Draw
        Random numbers of this design.
    design : dict
        The design, which is changed.
    stage : str
        The stage of which the accuracy is measured.
    name : str
        The study that some ask for.
    """
    if d.chance(0.05):
        design["output"]["studies"] = [name]
    if d.chance(0.05):
        design["accuracy"] = {"stage": [stage], "repeat": 1}
        if d.chance(0.2):
            design["output"]["studies"] = ["accuracy"]


def drive(d: Draw, design: dict[str, Any], key: str = "speed_rpm") -> None:
    """Give a speed to a few designs.

    Parameters
    ----------
    d : Draw
        Random numbers of this design.
    design : dict
        The design, which is changed.
    key : str
        The key of the speed.
    """
    if d.chance(0.1):
        design["drive"] = {key: short(d.log(0.1, 1e4))}


def forces(d: Draw, design: dict[str, Any], swings: bool) -> None:
    """Give loads, springs, masses and friction to a few cams, and ask for their forces.

    Parameters
    ----------
    d : Draw
        Random numbers of this design.
    design : dict
        The design, which is changed.
    swings : bool
        Whether the follower swings.
    """
    if not d.chance(0.25):
        return
    slides = design["cam"].get("form") == "translating"
    design["drive"] = {"speed_mm_s" if slides else "speed_rpm": short(d.log(1, 1e3))}
    design["load"] = [_load(d, swings, slides)]
    stiffness, preload = ("stiffness_nm_rad", "preload_nm") if swings else (
        "stiffness_n_mm", "preload_n"
    )  # fmt: skip
    spring: dict[str, Any] = {stiffness: short(d.log(0.1, 100)), preload: short(d.log(1, 1000))}
    if d.chance(0.4):
        spring[d.pick([stiffness, preload])] = "solve"
    design["spring"] = [{"on": "follower", **spring}]
    mass: dict[str, Any] = {"of": "follower", "mass_kg": short(d.log(0.01, 10))}
    if swings:
        mass |= {"inertia_kg_m2": short(d.log(1e-5, 1e-2)), "center_mm": short(d.even(-20, 60))}
    design["mass"] = [mass]
    if d.chance(0.5):
        design["gravity"] = {"direction_deg": d.even(-180, 180), "g_m_s2": 9.81}
    if d.chance(0.7):
        design["friction"] = {
            **{name: short(d.even(0, 0.3)) for name in ("joint", "guide", "roller", "flank")},
            "journal_radius_mm": [short(d.log(1, 20)), short(d.log(0.5, 5))],
            "guide_length_mm": short(d.log(10, 100)),
        }
        if d.chance(0.5):
            design["friction"]["guide_at_mm"] = short(d.even(40, 200))
    if d.chance(0.5):
        design["material"] = {
            "name": [d.pick(["steel", "bronze", "pom"])],
            "young_modulus_mpa": short(d.log(1e3, 3e5)),
            "poisson": [0.3, short(d.even(0.2, 0.4))],
            "yield_mpa": short(d.log(20, 1000)),
            "density_kg_m3": 7850,
        }
    design["forces"] = {"steps": d.whole(12, 100)}
    if d.chance(0.7):
        design["output"]["studies"] = ["forces"]


def dynamics(d: Draw, design: dict[str, Any], swings: bool) -> None:
    """Give an elastic train to a few cams with loads, and ask for their dynamics.

    Parameters
    ----------
    d : Draw
        Random numbers of this design.
    design : dict
        The design, which is changed.
    swings : bool
        Whether the follower swings.
    """
    if "mass" not in design or not d.chance(0.3):
        return
    unit, spring = "nm_rad" if swings else "n_mm", design["spring"][0]
    made: dict[str, Any] = {f"stiffness_{unit}": short(d.log(100, 1e5))}
    if d.chance(0.5):
        blunt = design["follower"]["type"] not in ("roller", "domed")
        made["contact_stiffness_n_mm"] = short(d.log(1e3, 1e6)) if blunt else "hertz"
        if d.chance(0.5):
            design["mass"].append({**design["mass"][0], "of": "train"})
    if d.chance(0.5):
        made["damping_ratio"] = [short(d.even(0.03, 0.2)), short(d.even(0.03, 0.2))]
    if d.chance(0.3):
        made |= {"method": d.pick(["radau", "bdf", "lsoda"]), "tolerance": 1e-5}
    if d.chance(0.3):
        spring["damping_nm_s_rad" if swings else "damping_n_s_mm"] = short(d.log(1e-4, 0.1))
    design["dynamics"] = made | {"turns": d.whole(1, 3)}
    if design["cam"].get("form") != "translating":
        design["output"]["studies"] = ["dynamics"]
        if len(design["mass"]) == 1 and "contact_stiffness_n_mm" not in made and d.chance(0.3):
            design["drive"]["polydyne"] = True
            design["load"] = []


def forces_in_space(d: Draw, design: dict[str, Any], swings: bool) -> None:
    """Give a few cylinder cams loads, as `forces` does; their guide stands beside the cam."""
    before = design["output"].get("studies", [])
    forces(d, design, swings)
    design["output"] |= {"studies": [*before, "forces"]} if design.get("load") else {}
    if "friction" in design:
        size = design["friction"]["guide_length_mm"]
        design["friction"]["guide_distance_mm"] = short(size * d.even(0.2, 2))
    if design["cam"].get("walls") == "upper":
        design.pop("spring", None)


def turret_forces(d: Draw, design: dict[str, Any]) -> None:
    """Give a few globoidal cams what loads their turret."""
    forces(d, design, True)
    design.pop("spring", None)
    for one in design.get("load", []):
        one["on"] = "turret"
    for one in design.get("mass", []):
        one |= {"of": "turret"}
        del one["center_mm"]
    for key in [key for key in design.get("friction", {}) if key.startswith("guide")]:
        del design["friction"][key]


def _load(d: Draw, swings: bool, slides: bool) -> dict[str, Any]:
    unit, load = "mm" if slides else "deg", {"on": "follower", "against": d.chance(0.3)}
    how = d.pick(["constant", "formula", "table"])
    if how == "constant":
        load["torque_nm" if swings else "force_n"] = short(d.log(0.1, 500))
    elif how == "formula":
        load["formula"] = d.pick(["3 + 2*s", "5 + cos(u)" if slides else "5 + cos(theta)"])
    else:
        load |= {"table": [1.0, short(d.log(0.1, 500)), 1.0], f"at_{unit}": [0, 90, 360]}
    if d.chance(0.3):
        load |= {f"from_{unit}": 20, f"to_{unit}": short(d.even(30, 300))}
    return load


def limits(d: Draw, document: Mapping[str, Any]) -> dict[str, Any]:
    """Return one or two limits of checks of a `document`, drawn by `d` near their defaults."""
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
    """Move the columns of tables into CSV files, in half of the designs with tables.

    Parameters
    ----------
    d : Draw
        Random numbers of this design.
    document : mapping
        The design; its tables are changed in place.
    name : str
        Stem of the file names.

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
        measured = "radius_mm" in columns  # which a design itself cannot have
        if measured or (columns and is_table and d.chance(0.5)):
            file = f"{name}-{number}.csv"
            table["file"] = file
            for key in columns:
                del table[key]
            lines = [",".join(columns), *(",".join(map(repr, row)) for row in zip(*given))]  # noqa: B905
            files[file] = "\n".join(lines) + "\n"
    return files
