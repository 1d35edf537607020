"""Forms of cams: the classes of their tables, and what is special to their cams.

A *form* is a class in `FORMS`, loaded when a design names it; an instance has a design, and takes
the cam that it has made and its parts. It defines only what is special to it; all other code uses
the walls, motions and parts of the cam, in their order, and never asks for the name of a form. The
disc cam (`disc`) has what fits every cam whose walls are the outlines of plates.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any, ClassVar, Final, Generic, TypeVar

from gearcam.base.facts import Fact
from gearcam.base.registry import Registry
from gearcam.cams.cam import Cam
from gearcam.cams.spec import CamSpec, FollowerSpec, size_problems
from gearcam.cams.wall import CHORD_TOLERANCE
from gearcam.designs.faults import Fault
from gearcam.designs.kind import Variants
from gearcam.designs.table import table_of
from gearcam.designs.validate import placed_faults
from gearcam.kinds.cam.tables import CamBlank, CamOutputSpec
from gearcam.laws.program import Program, make_program
from gearcam.mechanics.drive import CamDriveSpec
from gearcam.mechanics.load import LoadSpec

if TYPE_CHECKING:
    from gearcam.base.tolerances import Tolerances
    from gearcam.numeric.contour import Contour
    from gearcam.parts.body import Part
    from gearcam.pictures.drawings import Drawing, Path

    Parts = Sequence[Part]

ROWS: Final = (
    "cam.follower",
    "cam.roller_radius_mm",
    "cam.dome_radius_mm",
    "cam.pivot_distance_mm",
    "cam.arm_mm",
    "cam.face_offset_mm",
    "cam.offset_mm",
    "motion.total_lift",
    "cam.prime_radius_mm",
    "cam.base_radius_mm",
    "cam.rotation",
    "cam.pressure_angle_deg.rise_max",
    "cam.pressure_angle_deg.return_max",
    "cam.profile.clearance_mm",
    "part.density_kg_m3",
    "part.mass.mass_kg",
    "part.mass.centroid_mm",
    "part.mass.unbalance_g_mm",
)
"""Facts in the tables of all drawings."""

C = TypeVar("C", bound=Cam)
S = TypeVar("S", bound=CamSpec)
F = TypeVar("F", bound=FollowerSpec)


def lift_program(design: Any, tolerances: Tolerances) -> Program:
    """Return the lift of a `design` over a turn, which does not depend on sizes.

    That of a polydyne cam is corrected for its elastic follower; that on a measured profile depends
    on the follower.

    Parameters
    ----------
    design : Design
        With the fields ``motion`` and ``follower``.
    tolerances : Tolerances
        Internal accuracy.
    """
    motion = design.motion
    if getattr(motion, "of_radii", False):
        from gearcam.kinds.cam.measured import measured_lift

        return measured_lift(design, tolerances)
    make = partial(make_program, motion) if isinstance(motion, Sequence) else motion.program
    program = make(tolerances, oscillating=design.follower.oscillating)
    if not getattr(design.drive, "polydyne", False):
        return program
    from gearcam.kinds.cam.polydyne import corrected

    return corrected(design, program)


class Form(ABC, Generic[C, S, F]):
    """A form of cams.

    Parameters
    ----------
    design : CamDesign
        A design of this form, with all its sizes.
    """

    name: ClassVar[str]
    """As in a design file."""

    doc: ClassVar[str]
    """One line for people."""

    tables: ClassVar[dict[str, type]] = {
        "follower": FollowerSpec,
        "cam": CamSpec,
        "drive": CamDriveSpec,
        "load": LoadSpec,
        "blank": CamBlank,
        "output": CamOutputSpec,
    }
    """Classes of the tables of its designs, by title; they derive from those of a disc."""

    moves: ClassVar[str] = "turning"
    """What the cam does, a circumstance of `gearcam.base.quantities`: units depend on it."""

    solvable: ClassVar[bool] = False
    """Whether its sizes can be solved for."""

    half_turns: ClassVar[bool] = False
    """Whether phases may fill half a turn; the other half is then its opposite."""

    rows: ClassVar[tuple[str, ...]] = ()
    """Facts of its own in the tables of its drawings."""

    def __init__(self, design: Any) -> None:
        self.design = design
        self.given: S = design.cam
        self.follower: F = design.follower
        self.blank: Any = design.blank
        self.output: Any = design.output

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self.design!r})"

    @property
    def chord_tolerance(self) -> float:
        """Chord tolerance of the profile, mm."""
        return self.output.chord_tolerance or CHORD_TOLERANCE

    @property
    def step(self) -> tuple[str, float]:
        """Key and value of the step of tables of the motion, rad or mm."""
        return "output.motion_step_deg", self.output.motion_step

    def contact_width(self, cam: C) -> float:  # noqa: ARG002
        """Return the width of the contact between `cam` and follower, mm."""
        return self.given.thickness

    @classmethod
    def faults(cls, parts: Mapping[str, Any], document: Mapping[str, Any]) -> Iterator[Fault]:
        """Yield contradictions between the tables of a design.

        Parameters
        ----------
        parts : mapping
            What could be read of them, by title; at least follower and cam.
        document : mapping
            The tables as in the file.
        """
        problems = size_problems(parts["follower"], parts["cam"])
        known = table_of("cam", cls.tables["cam"])
        yield from placed_faults(problems, known, document["cam"], ("cam",))

    def program(self, tolerances: Tolerances) -> Program:
        """Return the lift that the design asks for."""
        return lift_program(self.design, tolerances)

    @abstractmethod
    def make(self, program: Program) -> C:
        """Return the cam with the lift of a `program`."""

    @abstractmethod
    def parts(self, cam: C) -> tuple[Part, ...]:
        """Return what is made of a `cam`, each with all that is ordered."""

    @abstractmethod
    def finished(self, cam: C, parts: Parts) -> tuple[Contour, ...]:
        """Return the walls on the finished `parts` of a `cam`, in the order of its walls."""

    @abstractmethod
    def drawings(self, cam: C, parts: Parts) -> tuple[Drawing, ...]:
        """Return a drawing of each of the `parts` of a `cam` in its own frame, for cutting."""

    @abstractmethod
    def picture(self, cam: C, parts: Parts) -> Drawing:
        """Return the `parts` of a `cam` assembled with its follower, at the angle of the design."""

    @abstractmethod
    def paths(self, cam: C, parts: Parts) -> Mapping[str, Contour | Path]:
        """Return paths of a cutter's centre along a `cam` or its `parts`, by the stems of files."""

    def rows_of(self, number: int) -> Sequence[str]:  # noqa: ARG002
        """Return the names of the facts in the table of a part's drawing, by its `number`."""
        _, other = self.follower.size_keys
        return [name for name in (*ROWS, *self.rows) if not name.endswith(other)]

    def heights(self) -> tuple[float, ...]:
        """Return the height of each part in the assembly, mm."""
        return (0.0,)

    @property
    def leading(self) -> str:
        """The name of the size for the headline, one of its `sizes`."""
        return self.follower.size_keys[0]

    def sizes(self, cam: C) -> dict[str, Any]:
        """Return the sizes of a `cam`, as facts."""
        follower = cam.motions[0].follower
        return {
            **self.follower.placement,
            "rotation": Fact(self.given.rotation, "cam turns"),
            "prime_radius_mm": follower.prime_radius,
            "base_radius_mm": follower.prime_radius - follower.radius,
        }

    @abstractmethod
    def facts(self, cam: C, made: Sequence[Contour]) -> dict[str, Any]:
        """Return the facts of a `cam` beyond follower, size and pressure angles.

        Parameters
        ----------
        cam : Cam
            The cam.
        made : sequence of Contour
            Its walls as they are made, with clearance.
        """


FORMS: Registry[type[Form[Any, Any, Any]]] = Registry(
    "a form of cams",
    "gearcam.kinds.cam.forms",
    {name: (name,) for name in ("disc", "groove", "conjugate", "yoke", "translating")},
)
"""The forms by name, each loaded when it is asked for."""


VARIANTS: Final = Variants(
    title="cam",
    key="form",
    default="disc",
    entries=FORMS,
    called="a {} cam",
    elsewhere={"cylinder": "spatial-cam", "globoidal": "globoidal-cam"},
)
"""The tables that depend on the form."""
