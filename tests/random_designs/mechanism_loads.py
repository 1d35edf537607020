"""Loads, masses and springs of random mechanisms."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from random_designs.draw import short
from random_designs.motors import moved

if TYPE_CHECKING:
    from random_designs.mechanism import Machine


def loaded(m: Machine, made: dict[str, Any]) -> None:
    """Give loads, masses and springs to some mechanisms, and ask for their moments.

    Parameters
    ----------
    m : Machine
        The mechanism, whose tables are changed.
    made : dict
        Its other tables.
    """
    d = m.d
    if not d.chance(0.35):
        return
    m.tables["drive"][0]["speed_rpm"] = short(d.log(1, 300))
    for _ in range(d.whole(1, 2)):
        _load(m)
    _masses_and_springs(m)
    if d.chance(0.5):
        made["gravity"] = {"direction_deg": d.even(-180, 180), "g_m_s2": 9.81}
    if d.chance(0.7):
        made["torque"] = {"steps": d.whole(12, 100)}
    if d.chance(0.7):
        made["output"]["studies"] = ["torque"]
    _rubbed(m, made)
    _studied(m, made)
    if d.chance(0.2):
        master = m.tables["drive"][0]
        torque = short(m.size * d.log(0.01, 3))
        moved(d, made, torque, master["speed_rpm"], m.opened or "range_deg" in master)


def _changes(m: Machine) -> bool:
    """Whether a dyad may pass a place where its forces and deviations are not determined."""
    return any("change" in row for row in m.tables.get("dyad", ()))


def _rubbed(m: Machine, made: dict[str, Any]) -> None:
    """Give friction to some, and ask for the forces in joints."""
    d = m.d
    if d.chance(0.5) and not _changes(m):
        made["forces"] = {"steps": d.whole(12, 60)}
        made["output"]["studies"] = [*made["output"].get("studies", ()), "forces"]
    if d.chance(0.5):
        made["friction"] = {
            "joint": d.even(0.01, 0.2),
            "journal_radius_mm": short(d.log(1, 15)),
            "guide": d.even(0.01, 0.2),
            "guide_length_mm": short(d.log(10, 200)),
        }
        cranks = [row["joint"] for row in m.tables.get("crank", ())]
        if cranks and d.chance(0.2):
            m.add("bearing", on=d.pick(cranks), coefficient=d.even(0, 0.3), radius_mm=5.0)


def _studied(m: Machine, made: dict[str, Any]) -> None:
    """Give tolerances and counterweights to some."""
    d, cranks = m.d, m.tables.get("crank", ())
    if d.chance(0.3) and not _changes(m):
        made["precision"] = {
            "length_tolerance_mm": short(d.log(1e-3, 0.2)),
            "angle_tolerance_deg": short(d.log(1e-3, 0.2)),
            "clearance_mm": short(d.log(1e-3, 0.1)),
            "trials": d.whole(0, 5),
            "seed": d.whole(0, 9),
            "steps": d.whole(12, 60),
        }
        if cranks and d.chance(0.3):
            m.add("tolerance", of=f"{d.pick([*cranks])['name']}.length", tolerance_mm=0.01)
        made["output"]["studies"] = [*made["output"].get("studies", ()), "precision"]
    if d.chance(0.3) and any("mass_kg" in row for row in m.tables.get("mass", ())):
        made["balance"] = {"harmonics": d.whole(1, 8), "steps": d.whole(12, 60)}
        fixed = [row["name"] for row in cranks if "at" not in row]
        if fixed and d.chance(0.6):
            made["balance"] |= {"counterweights": [d.pick(fixed)], "radius_mm": 40.0}
            if d.chance(0.5):
                made["balance"]["direction_deg"] = d.even(-90, 90)
        made["output"]["studies"] = [*made["output"].get("studies", ()), "balance"]
        _rotor(m, {row["name"]: row["on"] for row in cranks if "at" not in row})


def _rotor(m: Machine, shafts: dict[str, str]) -> None:
    """Balance some cranks that have masses and share a shaft, which stands still."""
    d, masses = m.d, m.tables["mass"]
    elsewhere = {row["of"] for row in masses if "center" in row}
    heavy = {row["of"] for row in masses if "mass_kg" in row and row["of"] in shafts} - elsewhere
    if not heavy or d.chance(0.3):
        return
    shaft = shafts[d.pick(sorted(heavy))]
    parts = [one for one in sorted(heavy) if shafts[one] == shaft]
    planes = [short(d.even(-100, 0)), short(d.even(1, 100))]
    m.add(
        "rotor",
        name="rotor1",
        parts=parts,
        places_mm=[short(d.even(-200, 200)) for _ in parts],
        planes_mm=planes if d.chance(0.5) else planes[::-1],
        radius_mm=short(d.log(1, 200)),
    )


def _masses_and_springs(m: Machine) -> None:
    d = m.d
    for on in dict.fromkeys(d.pick([*m.members]) for _ in range(2)):
        if d.chance(0.7):
            _mass(m, on)
    if m.shafts and d.chance(0.1):
        shaft = d.pick([*m.shafts])
        m.add("mass", of=shaft, inertia_kg_m2=short(d.log(1e-4, 1)))
    for _ in range(2):
        if d.chance(0.4):
            _spring(m)


def _load(m: Machine) -> None:
    d, row = m.d, m.add("load")
    size, sort = short(d.sign() * d.log(0.1, 500)), d.pick(["slide", "point", "member", "shaft"])
    if sort == "slide" and m.slides:
        _slide_load(m, row, size)
    elif sort == "point":
        row["on"] = d.pick([one for one in m.joints if one not in m.slides])
        if d.chance(0.5):
            row |= {"force_n": size, "direction_deg": d.even(-180, 180)}
        else:
            row["force_n"] = [size, short(size * d.even(-1, 1))]
    else:
        row["on"] = d.pick([*((sort == "shaft" and m.shafts) or m.members)])
        if d.chance(0.5):
            row["torque_nm"] = size
        else:
            row["formula"] = d.pick(["3 + 2*sin(q)", "0.5*x", "-0.1*v"])
    if "travel_mm" not in row and d.chance(0.3):
        start = d.even(0, 200)
        row |= {"from_deg": start, "to_deg": short(start + d.even(20, 200))}
    if not isinstance(row.get("force_n"), list) and "formula" not in row and d.chance(0.3):
        row["against"] = True


def _slide_load(m: Machine, row: dict[str, Any], size: float) -> None:
    d = m.d
    row["on"] = on = d.pick([*m.slides])
    far, how = max(m.slides[on], 0.1), d.pick(["constant", "formula", "angles", "places"])
    if how == "constant":
        row["force_n"] = size
        if d.chance(0.5):
            row |= {"travel_mm": short(far * d.even(0.05, 0.5))}
            row["before"] = d.pick(["inner", "outer"])
    elif how == "formula":
        row["formula"] = d.pick(["-2 - 0.3*x", "5*cos(q)", "-0.01*v"])
    elif how == "angles":
        row |= {"table": [0.0, size, 0.0], "at_deg": [0, d.even(90, 200), 360]}
    else:
        row |= {"table": [0.0, size, size], "at_mm": [short(-far), 0.0, short(far)]}


def _mass(m: Machine, on: str) -> None:
    d, row = m.d, m.add("mass", of=on)
    row["mass_kg"] = short(d.log(0.01, 50))
    points = [*m.joints]
    if d.chance(0.3):
        row["center"] = d.pick(points)
    else:
        at = m.place(0.0, 0.5)
        row["at_mm"] = [at.real, at.imag]
    if d.chance(0.5):
        row["inertia_kg_m2"] = short(d.log(1e-5, 1))


def _spring(m: Machine) -> None:
    d, row = m.d, m.add("spring")
    sort = d.pick(["slide", "joints", "member"])
    turning = [row["name"] for row in m.tables.get("crank", ())] or [*m.shafts]
    if not turning or (sort == "slide" and m.slides):
        row["on"] = d.pick([*m.slides])
    elif sort == "joints" and len(m.joints) > 1:
        one = d.pick([*m.joints])
        row["between"] = [one, d.pick([name for name in m.joints if name != one])]
    else:
        row["on"] = d.pick(turning)
        row["stiffness_nm_rad"] = short(d.log(0.01, 100))
        if d.chance(0.5):
            row["preload_nm"] = short(d.sign() * d.log(0.01, 10))
        if d.chance(0.3):
            row["damping_nm_s_rad"] = short(d.log(1e-3, 1))
        return
    row["stiffness_n_mm"] = short(d.log(0.01, 100))
    if d.chance(0.5):
        row["preload_n"] = short(d.sign() * d.log(0.1, 100))
    if d.chance(0.4):
        row["free_length_mm"] = m.length(0.1, 2.0)
    if d.chance(0.3):
        row["damping_n_s_mm"] = short(d.log(1e-3, 1))
