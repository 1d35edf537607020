"""What is asked of each load, mass and spring, which act on a mechanism.

Each is a table of the file and one class. Forces are positive in the direction in which the place
of a slide counts, torques counter-clockwise as seen in the machine.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, ClassVar, Final

from gearcam.base.findings import Remark, check
from gearcam.kinds.mechanism.asked import TABLES
from gearcam.kinds.mechanism.keys import Sort, WithNames

if TYPE_CHECKING:
    from gearcam.designs.faults import Fault
    from gearcam.kinds.mechanism.parts.acted import Acted, LoadedLinkage
    from gearcam.linkages.efforts import Effort
    from gearcam.linkages.elements import Element
    from gearcam.mechanics.gravity import GravitySpec

MOST: Final = 1e9
"""Largest force, N, torque, N m, and the like."""

MOVING: Final = f"{Sort.JOINT} or {Sort.MEMBER} or {Sort.SHAFT} or {Sort.WAY}"
"""What may be loaded."""


class MachineAction(WithNames):
    """What acts on a mechanism: a load, a mass or a spring; the table of its file is the thing."""

    moved: ClassVar[str] = ""
    """Its key with the name of what must move; empty without."""

    def unfit(self, acted: Acted) -> Iterator[Fault]:
        """Yield keys that do not suit what it acts on, with their places in its table."""
        raise NotImplementedError

    def points(self, acted: Acted, number: int) -> Iterator[Element]:
        """Yield the joints that it needs in the linkage.

        Parameters
        ----------
        acted : Acted
            What the names in the mechanism are.
        number : int
            Of its table, from 0.
        """
        return iter(())

    def efforts(self, on: LoadedLinkage, number: int) -> Iterator[Effort]:
        """Yield what acts on a linkage.

        Parameters
        ----------
        on : LoadedLinkage
            The linkage.
        number : int
            Of its table, from 0.

        Raises
        ------
        InfeasibleError
            If it does not suit the motion.
        """
        raise NotImplementedError

    def needs_speed(self, gravity: GravitySpec) -> str:
        """Return why it needs the master's speed; empty if it does not."""
        return ""

    @property
    def damped(self) -> bool:
        """Whether it takes energy from what it stores."""
        return False


@check("loads-unused", kind=TABLES, severity="note")
def loads_unused(result: Any, limit: float) -> Iterator[Remark]:  # noqa: ARG001
    """Note loads, masses, springs and friction that nothing uses.

    Looks at: whether a study that uses them is asked for.
    """
    several = {title: one for title, one in vars(result.design).items() if isinstance(one, tuple)}
    given = [title for title, one in several.items() if one and isinstance(one[0], MachineAction)]
    if given and not {"torque", "forces", "balance"} & {*result.design.output.studies}:
        yield Remark(
            "Only the studies torque, forces and balance use loads, masses and springs: "
            'gearcam torque FILE, or studies = ["torque"] in [output].',
            ", ".join(given),
        )
    if result.design.rotor and "balance" not in result.design.output.studies:
        yield Remark(
            "Only the study of balance has rotors: gearcam balance FILE, or "
            'studies = ["balance"] in [output].',
            "rotor",
        )
    rubs = result.design.bearing or result.design.friction != type(result.design.friction)()
    if rubs and "forces" not in result.design.output.studies:
        yield Remark(
            'Only the study of forces has friction: gearcam forces FILE, or studies = ["forces"].',
            "bearing" if result.design.bearing else "friction",
        )
