"""The lift of a polydyne cam: its elastic follower makes the motion of the design."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from gearcam.designs.faults import Fault

if TYPE_CHECKING:
    from gearcam.designs.kind import Examined
    from gearcam.laws.program import Program


def polydyne_faults(found: Examined, document: Mapping[str, Any]) -> Iterator[Fault]:
    """Yield what a polydyne cam lacks, or does not go with.

    Parameters
    ----------
    found : Examined
        The valid tables.
    document : mapping
        All tables as in the file.
    """
    drive = document.get("drive")
    if not (isinstance(drive, Mapping) and drive.get("polydyne") is True):
        return
    parts, where = found.parts, ("drive", "polydyne")
    if not {"drive", "follower"} <= parts.keys():
        return
    dynamics = parts.get("dynamics")
    masses, springs, loads = (parts.get(title, ()) for title in ("mass", "spring", "load"))
    moving = [one for one in masses if one.of == "follower"]
    varying = any(one.knots or one.formula or one.against for one in loads)
    cases = (
        (parts["drive"].speed is None, "needs a speed", "with speed_rpm"),
        (dynamics is None or dynamics.train is None, "needs the stiffness of the follower's train",
         "with stiffness_n_mm, or stiffness_nm_rad, in [dynamics]"),
        (not moving, "needs the mass of the follower", 'with [[mass]] of = "follower"'),
        (len(moving) < len(masses), "is of one mass: a second would need six derivatives",
         'without [[mass]] of = "train"'),
        (dynamics is not None and dynamics.contact_stiffness is not None,
         "does not go with a stiffness of the contact, which depends on the cam's size",
         "its part in the stiffness of the train, without contact_stiffness_n_mm"),
        (any(one.rate == "solve" for one in springs), 'does not go with a stiffness "solve"',
         "a number"),
        (varying, "does not go with loads that vary, to which the train gives", "a constant load"),
    )  # fmt: skip
    for wrong, message, allowed in cases:
        if wrong:
            yield Fault(where, message, True, allowed)
            return


def corrected(design: Any, program: Program) -> Program:
    """Return the lift of a polydyne cam from the `program` that its follower is to make.

    Parameters
    ----------
    design : CamDesign
        With its masses, springs and train.
    program : Program
        The motion.

    Raises
    ------
    InfeasibleError
        If the jerk of the program jumps.
    """
    from gearcam.dynamics.follower import damping_of
    from gearcam.dynamics.polydyne import Train, polydyne

    dynamics = design.dynamics
    mass = sum(one.acting(oscillating=design.follower.oscillating) for one in design.mass)
    train = Train(
        mass=mass,
        stiffness=dynamics.train,
        damping=damping_of(dynamics.damping_ratio[0], dynamics.train, mass),
        spring=sum(one.rate for one in design.spring),
        damper=sum(one.drag for one in design.spring),
        speed=design.drive.speed,
    )
    return polydyne(program, train)
