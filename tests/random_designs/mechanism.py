"""Random mechanisms: pairs, cams and even shafts that drive linkages of all types of dyads.

Lengths are drawn in sizes of the machine, so that this is arbitrary. Each dyad gets lengths that
suit the places of what it begins at, so that most mechanisms close.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any, Final

from random_designs.draw import Draw, short
from random_designs.goals import seek
from random_designs.law_draw import LawDraw
from random_designs.laws import random_law
from random_designs.mechanism_cams import (
    IN_SPACE,
    driven_by_plate,
    driven_in_space,
    drum_design,
    globoid_design,
    plate_design,
)
from random_designs.mechanism_loads import loaded
from random_designs.mechanism_parts import (
    ALONG,
    NOTHING,
    TURN,
    Joint,
    Line,
    crossing,
    distances,
    off,
    solved,
)
from random_designs.output import studies

_EACH: Final = 24
"""Positions looked at in a turn of the master."""

_MASTERS: Final = ("even", "pair", "swinging cam", "even", "lifting cam", "open pair", "range",
                   "pair", "rack", "parallelogram", *IN_SPACE)  # fmt: skip
"""What drives, which take turns."""

_LAWS: Final = ("fourier", "limacon", "lobed", "phases", "multispeed", "formula", "bspline",
                "constant", "log-spiral")  # fmt: skip
"""Laws of pairs, which are small and fast."""

_TYPES: Final = ("RRR", "RRT", "RTR1", "RTT", "TRT", "TRR", "RTR2", "TTR", "RTRR")

_MOST_TEETH: Final = 20

_SPARE: Final = (0.05, 0.6)
"""By how much rods are longer than they must be."""

_TOO_SHORT: Final = 0.04
"""Share of dyads that need not close."""

_COMPARED: Final = ("pair", "open pair", "swinging cam", "lifting cam")
"""Masters that are compared with others, beside cams in space."""

_SHARES: Final = {"svg": 0.3, "dxf": 0.2, "report": 0.06}
"""Share of mechanisms with each kind of file, by its cost."""


@dataclass
class Machine:
    """A mechanism while it is drawn.

    Parameters
    ----------
    d : Draw
        Random numbers of this design.
    size : float, mm
        Of the machine.
    count : int
        Number of positions looked at.
    tables : dict of str to list of dict
        Its tables by title.
    """

    d: Draw
    size: float
    count: int = _EACH
    tables: dict[str, list[dict[str, Any]]] = field(default_factory=dict)
    joints: dict[str, Joint] = field(default_factory=dict)
    members: dict[str, Line] = field(default_factory=dict)
    guides: dict[str, Line] = field(default_factory=dict)
    shafts: dict[str, tuple[list[float], complex, str]] = field(default_factory=dict)
    """Turns, where they stand, and what moves them."""
    ways: dict[str, tuple[list[float], complex, complex]] = field(default_factory=dict)
    """Places, where their zero is, and their directions."""
    slides: dict[str, float] = field(default_factory=dict)
    """Outputs that are lengths, and how far they get, mm."""
    arms: dict[str, float] = field(default_factory=dict)
    """Directions of the arms of oscillating followers, rad."""
    standing: list[str] = field(default_factory=list)
    opened: bool = False
    """Whether the master is an open pair."""
    drawn: bool = False
    """Whether the path of a point is asked for."""
    last: list[str] = field(default_factory=list)
    """The newest joints, at which the next dyad begins."""

    def add(self, title: str, **row: Any) -> dict[str, Any]:
        """Add a row to a table."""
        self.tables.setdefault(title, []).append(row)
        return row

    def named(self, stem: str) -> str:
        """Return a new name."""
        rows = sum(len(rows) for rows in self.tables.values())
        return f"{stem}_{rows}"

    def length(self, low: float, high: float) -> float:
        """Return a length in sizes of the machine, mm."""
        return short(self.size * self.d.even(low, high))

    def place(self, low: float, high: float, about: complex = 0j) -> complex:
        """Return a place so many sizes from another one."""
        far = self.size * self.d.even(low, high)
        found = about + cmath.rect(far, TURN * self.d.random.random())
        return complex(short(found.real), short(found.imag))

    def still(self, at: complex) -> Joint:
        """Return a joint that does not move."""
        return Joint([at] * self.count)

    def fixed(self, at: complex) -> str:
        """Add a joint that stands still."""
        name = self.named("fixed")
        self.add("joint", name=name, at_mm=_pair(at))
        self.joints[name] = self.still(at)
        self.standing.append(name)
        return name


def _pair(at: complex) -> list[float]:
    return [at.real, at.imag]


def _degrees(angle: float) -> float:
    return short(math.degrees(angle))


# --- what drives --------------------------------------------------------------------------------


def _pair_design(d: Draw, distance: float, *, opened: bool, rack: bool) -> dict[str, Any]:
    """Return a small pair, by its tables."""
    draw = LawDraw(str(d.random.random()), _MOST_TEETH)
    name = "rack" if rack else d.pick(("phases", "log-spiral", "motion") if opened else _LAWS)
    law, z = random_law(draw, name)
    while not rack and ("driven_travel_deg" in law) != opened:
        law, z = random_law(draw, name)
    pair: dict[str, Any] = {"teeth": list(z)}
    if rack:
        pair["module_mm"] = short(2.0 * distance / z[0])
    else:
        pair["center_distance_mm"] = distance
        if d.chance(0.15) and z[1] > z[0] and not opened:
            pair["type"] = "internal"
    return {"kind": "gear-pair", "name": "wheels", "law": law, "pair": pair}


def _cam_design(d: Draw, size: float, *, swings: bool) -> dict[str, Any]:
    """Return a disc cam with a roller or a knife edge, by its tables."""
    unit, lift = ("deg", d.even(5, 25)) if swings else ("mm", short(size * d.even(0.1, 0.4)))
    laws = ("cycloidal", "3-4-5", "modified-sine", "modified-trapezoid")
    up, down = d.even(60, 150), d.even(60, 150)
    motion = [
        {"type": "rise", "law": d.pick(laws), "angle_deg": up, f"lift_{unit}": lift},
        {"type": "dwell", "angle_deg": d.even(10, 50)},
        {"type": "return", "law": d.pick(laws), "angle_deg": down},
        {"type": "dwell", "angle_deg": "rest"},
    ]
    follower: dict[str, Any] = {"type": "knife-edge"}
    if d.chance(0.7):
        follower = {"type": "roller", "roller_radius_mm": short(0.15 * size)}
    if swings:
        pivot = short(size * d.even(1.4, 2.0))
        follower |= {"motion": "oscillating", "pivot_distance_mm": pivot}
        follower["arm_mm"] = short(pivot * d.even(0.75, 0.95))
    elif d.chance(0.3):
        follower["offset_mm"] = short(size * d.even(-0.2, 0.2))
    cam: dict[str, Any] = {"prime_radius_mm": size, "thickness_mm": short(0.2 * size)}
    if d.chance(0.3):
        cam["rotation"] = d.pick(["cw", "ccw"])
    return {
        "kind": "cam", "name": "disc", "motion": motion, "follower": follower, "cam": cam
    }  # fmt: skip


@dataclass(frozen=True)
class Placed:
    """Where a drive stands."""

    at: complex = 0j
    turn: float = 0.0
    mirror: bool = False

    def machine(self, point: complex) -> complex:
        return self.at + self.vector(point)

    def vector(self, way: complex) -> complex:
        return (way.conjugate() if self.mirror else way) * cmath.exp(1j * self.turn)

    @property
    def side(self) -> float:
        return -1.0 if self.mirror else 1.0


def _stands(m: Machine, drive: dict[str, Any], about: complex | None) -> Placed:
    """Place a drive somewhere, its frame turned and reflected in some designs."""
    d, at = m.d, 0j
    if about is not None:
        at = m.place(2.0, 4.0, about)
    elif d.chance(0.3):
        at = m.place(0.0, 1.0)
    turn = d.even(-180, 180) if d.chance(0.3) else 0.0
    mirror = d.chance(0.2)
    if at:
        drive["at_mm"] = _pair(at)
    if turn:
        drive["turn_deg"] = turn
    if mirror:
        drive["mirror"] = True
    return Placed(at, math.radians(turn), mirror)


def _frame(drive: dict[str, Any]) -> Placed:
    """Return where a drive stands, by its table."""
    return Placed(
        complex(*drive.get("at_mm", (0, 0))),
        math.radians(drive.get("turn_deg", 0)),
        drive.get("mirror", False),
    )


def _driven_by_pair(m: Machine, q: list[float], drive: dict[str, Any], on: Placed) -> None:
    name, pair = drive["name"], drive["pair"]["pair"]
    z, law = pair["teeth"], drive["pair"]["law"]
    if law["type"] == "rack":
        distance = 0.5 * z[0] * pair["module_mm"]
        pitch = distance * TURN / _EACH
        m.shafts[f"{name}.wheel1"] = [-on.side * one for one in q], on.at, name
        places = [-pitch * k for k in range(len(q))]
        m.ways[f"{name}.rack"] = places, on.at, on.vector(1j)
        return
    inside = pair.get("type") == "internal"
    center, side = pair["center_distance_mm"] * (-1 if inside else 1), -1 if inside else 1
    travel = math.radians(law.get("driven_travel_deg", 0.0))
    ratio = travel / q[-1] if travel else z[0] / z[1]
    m.shafts[f"{name}.wheel1"] = [-on.side * one for one in q], on.machine(0j), name
    turns = [on.side * side * ratio * one for one in q]
    m.shafts[f"{name}.wheel2"] = turns, on.machine(center), name


def _driven_by_cam(m: Machine, q: list[float], drive: dict[str, Any], on: Placed) -> None:
    name, cam = drive["name"], drive["cam"]
    follower, prime = cam["follower"], cam["cam"]["prime_radius_mm"]
    side = -1.0 if cam["cam"].get("rotation") == "cw" else 1.0
    share = [0.5 - 0.5 * math.cos(one) for one in q]
    m.shafts[f"{name}.shaft"] = [side * on.side * one for one in q], on.at, name
    if "motion" not in follower:
        offset = follower.get("offset_mm", 0.0)
        end = complex(side * offset, math.sqrt(prime**2 - offset**2))
        lift = cam["motion"][0]["lift_mm"]
        m.ways[f"{name}.follower"] = [lift * s for s in share], on.machine(end), on.vector(1j)
        return
    pivot, arm = follower["pivot_distance_mm"], follower["arm_mm"]
    cosine = (pivot**2 + arm**2 - prime**2) / (2.0 * pivot * arm)
    direction = math.pi - side * math.acos(max(-1.0, min(1.0, cosine)))
    lift = math.radians(cam["motion"][0]["lift_deg"])
    turns = [-side * on.side * lift * s for s in share]
    m.shafts[f"{name}.follower"] = turns, on.machine(pivot), name
    m.arms[f"{name}.follower"] = cmath.phase(on.vector(cmath.exp(1j * direction)))


_CAMS: Final[dict[str, Callable[[Draw, float], dict[str, Any]]]] = {
    "swinging cam": partial(_cam_design, swings=True),
    "lifting cam": partial(_cam_design, swings=False),
    "swinging drum": partial(drum_design, swings=True),
    "lifting drum": partial(drum_design, swings=False),
    "globoid": globoid_design,
    "swinging plate": partial(plate_design, swings=True),
    "lifting plate": partial(plate_design, swings=False),
}
"""What returns the cam of a drive."""


def _designed(m: Machine, how: str) -> dict[str, Any]:
    """Return what a drive is, but for a slide, by its key."""
    if how in ("pair", "open pair", "rack"):
        distance = m.length(1.5, 3.0)
        opened, rack = how == "open pair", how == "rack"
        return {"pair": _pair_design(m.d, distance, opened=opened, rack=rack)}
    return {"cam": _CAMS[how](m.d, m.size)} if how in _CAMS else {"even": True}


def _driven(m: Machine, how: str, number: int, about: complex | None) -> None:
    """Add a drive: the master is number 0."""
    d, drive = m.d, m.add("drive", name=("motor", "second", "third")[number])
    q = [TURN * k / _EACH for k in range(m.count)]
    if how == "range":
        low, high = d.even(-90, 20), d.even(60, 300)
        drive["range_deg"] = [low, high]
        q = [math.radians(low + (high - low) * k / (m.count - 1)) for k in range(m.count)]
    if how == "slide":
        _driven_by_formula(m, q, drive, about)
        return
    drive |= _designed(m, how)
    if number and not how.endswith("plate"):
        ratio = drive["ratio"] = d.pick([1, 1, 2, -1, 3, -2])
        phase = drive["phase_deg"] = d.even(-180, 180)
        q = [ratio * one + math.radians(phase) for one in q]
    on = Placed() if how == "parallelogram" else _stands(m, drive, about)
    if "pair" in drive:
        _driven_by_pair(m, q, drive, on)
    elif how.endswith("plate"):
        driven_by_plate(m, q, drive, on)
    elif how in IN_SPACE:
        driven_in_space(m, q, drive, on)
    elif "cam" in drive:
        _driven_by_cam(m, q, drive, on)
    else:
        for name in (drive["name"], f"{drive['name']}.shaft"):
            m.shafts[name] = [on.side * one for one in q], on.at, drive["name"]


def _driven_by_formula(
    m: Machine, q: list[float], drive: dict[str, Any], about: complex | None
) -> None:
    stroke, own = m.length(0.1, 0.3), m.d.whole(1, 2)
    first = m.length(0.0, 1.0)
    drive["slide"] = f"{first} + {stroke}*(1 - cos({own}*q))"
    on = _stands(m, drive, about)
    places = [first + stroke * (1 - math.cos(own * one)) for one in q]
    for name in (drive["name"], f"{drive['name']}.slide"):
        m.ways[name] = places, on.at, on.vector(ALONG)


def _drives(m: Machine, how: str) -> None:
    """Add the master and in some designs further drives, which turn all the way."""
    d = m.d
    m.opened = how == "open pair"
    _driven(m, how, 0, None)
    if how in ("pair", "rack"):
        z = m.tables["drive"][0]["pair"]["pair"]["teeth"]
        m.count = _EACH * min(4, z[1] // math.gcd(*z))
        if how == "rack":
            m.count = math.ceil(_EACH * z[1] / z[0]) + 1
        m.shafts.clear()
        m.ways.clear()
        q = [TURN * k / _EACH for k in range(m.count)]
        drive = m.tables["drive"][0]
        _driven_by_pair(m, q, drive, _frame(drive))
    if how == "globoid":
        m.count = _EACH * m.tables["drive"][0]["cam"]["turret"]["stops"]
        q = [TURN * k / _EACH for k in range(m.count)]
        driven_in_space(m, q, m.tables["drive"][0], _frame(m.tables["drive"][0]))
    more = ("slide", "even", "slide", "swinging cam", "lifting cam", "slide", "lifting plate",
            "swinging plate", "lifting drum", "swinging drum")  # fmt: skip
    for number in (1, 2):
        if how != "parallelogram" and d.chance((0.0, 0.35, 0.2)[number]):
            _driven(m, d.pick(more), number, 0j)
    if d.chance(0.3) or how == "pair":
        m.tables["drive"][0]["speed_rpm"] = short(d.log(1, 1000))
    if how in (*_COMPARED, *IN_SPACE) and d.chance(0.3):
        _compared(m, how)


def _compared(m: Machine, how: str) -> None:
    """Compare the master with another one of its sort, or a pair with an even shaft."""
    d, master = m.d, m.tables["drive"][0]
    if "cam" in master:
        m.add("compare", name="other", cam=_cam_like(d, master["cam"]))
    elif how == "pair" and d.chance(0.5):
        m.add("compare", name="other", pair=_pair_like(d, master["pair"]))
    else:
        m.add("compare", name="other", even=True)


def _pair_like(d: Draw, pair: dict[str, Any]) -> dict[str, Any]:
    """Return a pair of the same size that turns evenly."""
    return {
        "kind": "gear-pair", "name": "other",
        "law": {"type": d.pick(["constant"])}, "pair": pair["pair"],
    }  # fmt: skip


def _cam_like(d: Draw, cam: dict[str, Any]) -> dict[str, Any]:
    """Return a cam of the same size with other laws."""
    law = d.pick(["cycloidal", "3-4-5"])
    if "index" in cam:
        return cam | {"name": "other", "index": cam["index"] | {"law": law}}
    motion = [one | {"law": law} if "law" in one else one for one in cam["motion"]]
    return cam | {"name": "other", "motion": motion}


# --- members that drives move -------------------------------------------------------------------


def _crank(m: Machine, shaft: str) -> None:
    d, (turns, center, root) = m.d, m.shafts[shaft]
    row = m.add("crank", name=m.named("crank"), on=shaft, joint=m.named("pin"))
    row["length_mm"] = length = m.length(0.2, 0.5)
    start, roots = 0.0, frozenset({root})
    if shaft in m.arms and d.chance(0.7):
        row["arm_angle_deg"] = angle = d.even(-120, 120)
        mirrored = next(one for one in m.tables["drive"] if one["name"] == root).get("mirror")
        start = m.arms[shaft] + math.radians(-angle if mirrored else angle)
    elif d.chance(0.6):
        row["angle_deg"] = angle = d.even(-180, 180)
        start = math.radians(angle)
    if d.chance(0.1):
        center = m.place(0.3, 1.0, center)
        row["at"] = m.fixed(center)
    along = [cmath.exp(1j * (turn + start)) for turn in turns]
    m.members[row["name"]] = Line([center] * m.count, along, roots)
    m.joints[row["joint"]] = m.members[row["name"]].point(complex(length))
    m.last.append(row["joint"])


def _pushed(m: Machine, way: str) -> None:
    d, (places, zero, along) = m.d, m.ways[way]
    row = m.add("slide", name=m.named("slide"), on=way, joint=m.named("end"))
    line = Line(
        [zero + along * one for one in places], [along] * m.count, frozenset({way.split(".")[0]})
    )
    at = 0j
    if d.chance(0.4):
        at = m.place(0.1, 0.6)
        row["at_mm"] = _pair(at)
    m.members[row["name"]] = line
    m.joints[row["joint"]] = line.point(at)
    m.slides[row["name"]] = max(places) - min(places)
    m.last.append(row["joint"])


def _limited(m: Machine, shaft: str) -> float:
    turns, _, _ = m.shafts[shaft]
    return max(turns) - min(turns)


def _chained(m: Machine, shaft: str) -> None:
    """Add a chain that swings a lever, on a shaft that turns by little."""
    d, center = m.d, m.place(1.0, 2.0)
    span = max(_limited(m, shaft), 0.1)
    row = m.add("chain", on=shaft, at_mm=_pair(center), joint=m.named("hook"))
    row["lever"] = m.named("lever")
    row["radius_mm"] = short(min(0.5, 0.6 / span) * m.size * d.even(0.3, 0.8))
    row["length_mm"] = m.length(1.5, 2.5)
    row["start_deg"] = start = d.even(-180, 180)
    row["range_deg"] = [short(start - 80), short(start + 80)]
    # the hinge so that the lever's end is off the wheel, and the chain across the lever there
    away = cmath.rect(1.0, math.radians(start)) * 1j * d.sign()
    hinge = center + away * m.length(2.5, 4.0) - cmath.rect(row["length_mm"], math.radians(start))
    row["hinge_mm"] = [short(hinge.real), short(hinge.imag)]
    if d.chance(0.5):
        row["wind"] = d.pick(["ccw", "cw"])


def _lifted(m: Machine, shaft: str) -> None:
    d = m.d
    row = m.add("hoist", name=m.named("load"), on=shaft, joint=m.named("hook"))
    row["radius_mm"] = m.length(0.1, 0.3)
    row["at_mm"] = _pair(m.place(1.0, 3.0))
    if d.chance(0.5):
        row["wind"] = d.pick(["ccw", "cw"])
    if d.chance(0.5):
        row["direction_deg"] = d.even(-180, 180)
    m.slides[row["name"]] = row["radius_mm"] * _limited(m, shaft)


def _indexed(m: Machine, shaft: str) -> None:
    d = m.d
    row = m.add("geneva", name=m.named("wheel"), on=shaft, slots=d.whole(3, 12))
    row["length_mm"] = m.length(0.3, 1.0)
    if d.chance(0.5):
        row["angle_deg"] = d.even(-180, 180)
    if d.chance(0.5):
        row["direction_deg"] = d.even(-180, 180)
    if d.chance(0.3):
        row["internal"] = True
    if d.chance(0.2):
        row["at"] = m.fixed(m.place(0.5, 2.0))
    if d.chance(0.3):
        m.add("point", name=m.named("tooth"), on=row["name"], at_mm=_pair(m.place(0.2, 0.5)))


def _moved(m: Machine) -> None:
    """Add a crank on the shafts, a slide on the ways of drives, chains, hoists, Geneva wheels."""
    d = m.d
    shafts = [one for one in m.shafts if "." in one or d.chance(0.5)]
    driven = [one for one in shafts if not one.endswith(("wheel1", ".shaft"))]
    for shaft in driven or shafts[:1]:
        _crank(m, shaft)
    for shaft in shafts:
        if shaft not in driven and d.chance(0.3):
            _crank(m, shaft)
    for way in m.ways:
        if d.chance(0.7) and (way.count(".") or d.chance(0.7)):
            _pushed(m, way)
    swung = [one for one in m.shafts if _limited(m, one) < 0.9 * TURN]
    if swung and d.chance(0.25):
        _chained(m, d.pick(swung))
    if swung and d.chance(0.25):
        _lifted(m, d.pick(swung))
    full = [one for one in m.tables["drive"] if one.get("even") and "range_deg" not in one]
    if full and d.chance(0.12):
        _indexed(m, d.pick(full)["name"])
    if not m.last:
        first = next(iter(m.shafts or m.ways))
        (_crank if m.shafts else _pushed)(m, first)


# --- dyads --------------------------------------------------------------------------------------


def _moving(m: Machine) -> str:
    """Return a joint that moves, mostly one of the newest."""
    moving = [one for one, is_ in m.joints.items() if is_.roots]
    return m.d.pick(m.last if m.d.chance(0.75) else moving)


def _other_joint(m: Machine, first: str) -> str:
    """Return another joint: one that moves, that stands still, or a new one."""
    d, joint = m.d, m.joints[first]
    if d.chance(0.15):
        others = [one for one, is_ in m.joints.items() if distances(joint, is_)[0] > 0.3 * m.size]
        if others:
            return d.pick(others)
    low = 1.2 * joint.reach / m.size + 0.3
    return m.fixed(m.place(low, low + 1.0, joint.middle))


def _guide(m: Machine, joint: Joint | None, direction: float | None = None) -> str:
    """Add a guide on the ground, near a joint if one is given."""
    d = m.d
    row = m.add("guide", name=m.named("guide"))
    still = [one for one in m.shafts if "." in one] + m.standing
    angle = d.even(-180, 180) if direction is None else short(math.degrees(direction))
    through = 0j
    if d.chance(0.25) and still and direction is None:
        row["through"] = name = d.pick(still)
        through = m.joints[name].at[0] if name in m.joints else m.shafts[name][1]
    at = m.place(0.0, 0.5, joint.middle - through if joint else 0j)
    if not ("through" in row and d.chance(0.5)):
        row["at_mm"] = _pair(at)
        through += at
    if angle and d.chance(0.9):
        row["direction_deg"] = angle
    along = cmath.exp(1j * math.radians(row.get("direction_deg", 0.0)))
    m.guides[row["name"]] = Line([through] * m.count, [along] * m.count)
    return row["name"]


def _carried(m: Machine) -> None:
    """Add a guide on a member."""
    d, on = m.d, m.d.pick([*m.members])
    row = m.add("guide", name=m.named("slot"), on=on)
    at, angle = m.place(0.0, 0.4), d.even(-180, 180)
    row |= {"at_mm": _pair(at), "direction_deg": angle}
    m.guides[row["name"]] = m.members[on].turned(at, math.radians(angle))


def _some_guide(m: Machine, joint: Joint) -> str:
    """Return a guide on the ground, or one on a member that hardly turns."""
    known = [one for one, line in m.guides.items() if line.still]
    return m.d.pick(known) if known and m.d.chance(0.25) else _guide(m, joint)


def _spared(m: Machine) -> float:
    """Return a factor on what a rod must reach."""
    return 0.9 if m.d.chance(_TOO_SHORT) else 1.0 + m.d.even(*_SPARE)


def _rods(m: Machine, first: Joint, last: Joint) -> tuple[float, float]:
    low, high = distances(first, last)
    whole, apart = high * _spared(m), 0.9 * low * m.d.even(-1, 1)
    return short(0.5 * (whole + apart)), short(0.5 * (whole - apart))


def _ends(m: Machine, kind: str) -> tuple[str, str] | None:
    """Return what the members of a dyad begin at."""
    first = _moving(m)
    if kind in ("RRR", "RTR1", "RTR2"):
        other = _other_joint(m, first)
        return (first, other) if m.d.chance(0.7) else (other, first)
    if kind == "RTRR":
        return m.fixed(m.place(1.5, 2.5)), ""
    if kind != "TRT":
        guide = _some_guide(m, m.joints[first])
        return (guide, first) if kind[0] == "T" else (first, guide)
    moving = [one for one, line in m.guides.items() if line.roots and line.swing < 0.5 * math.pi]
    if not moving:
        return None
    one = m.d.pick(moving)
    across = cmath.phase(sum(m.guides[one].along)) + m.d.sign() * m.d.even(0.8, 1.57)
    other = m.d.pick([*moving, ""])
    if not other or crossing(m.guides[one], m.guides[other]) < 0.1:
        other = _guide(m, None, across)
    return (one, other) if m.d.chance(0.5) else (other, one)


def _end_of(m: Machine, name: str) -> Any:
    return m.joints[name] if name in m.joints else m.guides[name]


def _offsets(m: Machine) -> list[float]:
    return [m.length(0.0, 0.5) if m.d.chance(0.4) else 0.0 for _ in "12"]


def _angle(m: Machine) -> float:
    """Return an angle that is neither 0 nor half a turn, rad."""
    return math.radians(m.d.sign() * m.d.even(40, 140))


def _sized_rrr(m: Machine, first: Any, last: Any) -> dict[str, Any]:
    return {"lengths": list(_rods(m, first, last))}


def _sized_rrt(m: Machine, first: Any, last: Any) -> dict[str, Any]:
    arm, gamma = _offsets(m)[0], _angle(m)
    rod = off(first, last, arm * cmath.exp(1j * gamma)) * _spared(m) + 0.2 * m.size
    return {"lengths": [short(rod), arm], "gammas": [0.0, gamma]}


def _sized_rtr(m: Machine, first: Any, last: Any) -> dict[str, Any]:
    arm, beta = 0.0, 0.0
    if m.d.chance(0.5):
        beta = _angle(m)
        arm = short(distances(first, last)[0] * m.d.even(0.05, 0.9))
    return {"lengths": [0.0, arm], "beta": beta}


def _sized_trt(m: Machine, first: Any, last: Any) -> dict[str, Any]:
    del first, last
    return {"lengths": _offsets(m), "gammas": [_angle(m), _angle(m)]}


def _sized_rtt(m: Machine, first: Any, last: Any) -> dict[str, Any]:
    del first, last
    sizes = {"lengths": [_offsets(m)[0], 0.0], "gammas": [0.0, _angle(m)]}
    return sizes | {"beta": _angle(m) if m.d.chance(0.5) else 0.0}


def _turned(sized: Callable[[Machine, Any, Any], dict[str, Any]]) -> Any:
    def other(m: Machine, first: Any, last: Any) -> dict[str, Any]:
        sizes = sized(m, last, first)
        for key in ("lengths", "gammas"):
            if key in sizes:
                sizes[key] = sizes[key][::-1]
        return sizes

    return other


_SIZED: Final = {
    "RRR": _sized_rrr,
    "RRT": _sized_rrt,
    "TRR": _turned(_sized_rrt),
    "RTR1": _sized_rtr,
    "RTR2": _turned(_sized_rtr),
    "TRT": _sized_trt,
    "RTT": _sized_rtt,
    "TTR": _turned(_sized_rtt),
}

_SLIDING: Final = {"RRT": 1, "TRR": 0, "RTT": 1, "TTR": 0}
"""The guide on which the joint of a dyad has a place."""

_BRANCHES: Final = {
    **dict.fromkeys(("RRR", "RTRR"), ("left", "right")),
    **dict.fromkeys(("RRT", "TRR", "RTR1", "RTR2"), ("ahead", "behind")),
}
"""Positions of dyads that have two."""


def _dyad(m: Machine, kind: str) -> None:
    """Add a dyad of a type, if there is something that it can begin at."""
    if kind == "RTRR":
        if m.ways:
            _cylinder(m)
        return
    names = _ends(m, kind)
    if names is None:
        return
    ends = [_end_of(m, name) for name in names]
    sizes = _SIZED[kind](m, *ends)
    _added(m, kind, (names[0], names[1]), sizes)


def _cylinder(m: Machine) -> None:
    """Add a cylinder between two joints, one of which moves in some designs."""
    d, way = m.d, m.d.pick([*m.ways])
    places = m.ways[way][0]
    foot = m.fixed(m.place(1.5, 3.0))
    last = m.fixed(m.place(0.0, 0.5)) if d.chance(0.7) else _moving(m)
    low, high = distances(m.joints[foot], m.joints[last])
    least = max(0.7 * high, max(places) + 0.02 * m.size)
    first = short(least - min(places))
    longest = first + max(places)
    rod = short(0.5 * (max(high - least, longest - low, 0.0) + low + least) * d.even(0.9, 1.1))
    _added(m, "RTRR", (foot, last), {"lengths": [first, rod]}, way)


def _added(
    m: Machine, kind: str, names: tuple[str, str], sizes: dict[str, Any], driven: str = ""
) -> None:
    """Add the table of a dyad, and what it moves."""
    d, first, last = m.d, _end_of(m, names[0]), _end_of(m, names[1])
    row = m.add("dyad", type=kind.rstrip("12"))
    row |= {"from": names[0], "to": names[1], "joint": m.named("joint")}
    row["members"] = [m.named("rod"), m.named("arm")]
    sizes = {"gammas": [0.0, 0.0], "beta": 0.0, "sign": 1.0} | sizes
    row |= _written(kind, sizes)
    branches = _BRANCHES.get(kind, ())
    if branches and d.chance(0.7):
        row["branch"] = d.pick(branches)
        sizes["sign"] = 1.0 if row["branch"] == branches[0] else -1.0
    if driven:
        row["driven"] = driven
    if branches and d.chance(0.15):
        row["change"] = d.pick(["branch", "motion"])
    joint, *members = solved(kind, first, last, sizes, m.ways[driven][0] if driven else ())
    roots = joint.roots | ({driven.split(".")[0]} if driven else NOTHING)
    m.joints[row["joint"]] = replace(joint, roots=roots)
    for name, line in zip(row["members"], members, strict=True):
        m.members[name] = replace(line, roots=roots)
    if "branch" in row and d.chance(0.2):
        row["near_mm"] = _pair(m.place(0.0, 0.05, joint.at[0]))
        del row["branch"]
    if kind in _SLIDING:
        own = _SLIDING[kind]
        m.slides[row["joint"]] = _travel((first, last)[own], members[own])
    m.last = [row["joint"]]
    if d.chance(0.4):
        _point(m, d.pick(row["members"]))


def _written(kind: str, sizes: dict[str, Any]) -> dict[str, Any]:
    """Return the keys of the sizes of a dyad that are not 0."""
    keys: dict[str, Any] = {}
    if any(sizes["lengths"]):
        keys["lengths_mm"] = list(sizes["lengths"])
    if any(sizes["gammas"]):
        keys["gammas_deg"] = [*map(_degrees, sizes["gammas"])]
    if sizes["beta"]:
        keys["beta_deg"] = _degrees(sizes["beta"])
    if kind == "RTR2":
        keys["slide_on"] = 2
    return keys


def _travel(guide: Line, slide: Line) -> float:
    """Return how far a slide gets along its guide, mm."""
    along = [
        ((foot - at) / way).real
        for foot, at, way in zip(slide.at, guide.at, guide.along, strict=True)
    ]
    return max(along) - min(along)


def _point(m: Machine, on: str) -> None:
    name, at = m.named("P"), m.place(0.1, 0.8)
    m.add("point", name=name, on=on, at_mm=_pair(at))
    m.joints[name] = m.members[on].point(at)
    m.last.append(name)


def _parallelogram(m: Machine) -> None:
    """Add a parallelogram, whose positions meet twice a turn."""
    crank = m.tables["crank"][0]
    base, length = m.length(1.5, 3.0), crank["length_mm"]
    for key in ("at", "angle_deg"):
        crank.pop(key, None)
    center = m.shafts["motor"][1]
    along = [cmath.exp(1j * turn) for turn in m.shafts["motor"][0]]
    line = m.members[crank["name"]] = Line([center] * m.count, along, frozenset({"motor"}))
    m.joints[crank["joint"]] = line.point(complex(length))
    pivot = m.fixed(complex(base))
    _added(m, "RRR", (crank["joint"], pivot), {"lengths": [base, length]})
    m.tables["dyad"][-1]["change"] = m.d.pick(["branch", "motion"])


# --- what is asked for --------------------------------------------------------------------------


def _turning(m: Machine) -> dict[str, float]:
    """Return the members that swing, and by how much, rad."""
    made = [name for row in m.tables.get("dyad", ()) for name in row["members"]]
    made += [row["name"] for row in m.tables.get("crank", ())]
    return {f"{name}.angle": m.members[name].swing for name in made}


def _asked(m: Machine) -> None:
    """Add intervals, dwells and stretches."""
    d = m.d
    amounts = [(name, "mm", far) for name, far in m.slides.items()]
    amounts += [(n, "deg", math.degrees(far)) for n, far in _turning(m).items() if far < 0.9 * TURN]
    amounts = [one for one in amounts if one[2] > 1e-3]
    for title, word in (("interval", "travel"), ("dwell", "within")):
        for _ in range(2):
            if amounts and d.chance(0.15):
                name, unit, far = d.pick(amounts)
                row = m.add(title, on=name)
                row[f"{word}_{unit}"] = short(far * d.log(0.002, 0.3))
                if title == "interval" and d.chance(0.6):
                    row["before"] = d.pick(["inner", "outer"])
                elif title == "dwell" and d.chance(0.6):
                    row["least_deg"] = d.even(1, 60)


def _output(m: Machine) -> dict[str, Any]:
    d = m.d
    output: dict[str, Any] = {"files": ["csv", *(one for one, p in _SHARES.items() if d.chance(p))]}
    points = [one for one, is_ in m.joints.items() if is_.roots and one not in _ends_of_slides(m)]
    drawn = [one for one in points if one not in m.slides]
    known = [*drawn, *m.slides, *_turning(m)]
    if d.chance(0.7):
        picked = dict.fromkeys(d.pick(known) for _ in range(d.whole(1, 4)))
        if d.chance(0.3):
            picked |= dict.fromkeys([d.pick([*m.shafts, *m.ways])])
        output["outputs"] = [one for one in picked if "." in one or one in known]
    shown = [one for one in output.get("outputs", ()) if one in drawn]
    if shown and d.chance(0.4):
        low, high = m.tables["drive"][0].get("range_deg", (0, 40 if m.opened else 250))
        start, share = low + 0.3 * d.even(0, 1) * (high - low), d.even(0.1, 0.7)
        end = short(start + share * (high - low))
        shape = d.pick(["line", "circle"])
        m.add("stretch", on=d.pick(shown), from_deg=short(start), to_deg=end, shape=shape)
    if d.chance(0.5):
        output["step_deg"] = short(d.log(0.5, 20))
    if d.chance(0.3):
        output["q_deg"] = d.even(-400, 400)
    if d.chance(0.3):
        output["chord_tolerance_mm"] = short(m.size * d.log(1e-5, 1e-3))
    m.drawn = bool(shown) or "outputs" not in output
    return output


def _ends_of_slides(m: Machine) -> list[str]:
    """Return the joints of pushed and lifted members, which are asked for by the member's name."""
    titles = ("slide", "hoist")
    return [row["joint"] for title in titles for row in m.tables.get(title, ())]


def design(d: Draw, index: int) -> dict[str, Any]:
    """Return a random mechanism; masters and dyads take turns.

    Parameters
    ----------
    d : Draw
        Random numbers of this design.
    index : int
        Number of the design.
    """
    how = _MASTERS[index % len(_MASTERS)]
    m = Machine(d, short(d.log(20, 300)))
    _drives(m, how)
    _moved(m)
    if how == "parallelogram":
        _parallelogram(m)
    if d.chance(0.3):
        _point(m, d.pick([*m.members]))
    for number in range(d.pick([1, 1, 2, 2, 3])):
        if d.chance(0.4):
            _carried(m)
        _dyad(m, _TYPES[(index + 4 * number) % len(_TYPES)])
    _asked(m)
    made: dict[str, Any] = {"output": _output(m)}
    loaded(m, made)
    made = m.tables | made
    if m.drawn:
        studies(d, made, "path")
    seek(made, index, "accuracy.lengths_mm")
    return made
