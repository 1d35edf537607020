"""Forms of cams: the classes of their tables, and what is special to their cams.

A *form* is a class in `FORMS`, loaded when a design names it; an instance looks at a result. It
defines only what is special to it; all other code uses the walls, motions and parts of the cam that
it has made, in their order, and never asks for the name of a form. The disc cam (`disc`) has what
fits every cam whose walls are the outlines of plates.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any, ClassVar, Final, Generic, TypeVar, cast

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
from gearcam.mechanics.drive import DriveSpec
from gearcam.mechanics.load import LoadSpec

if TYPE_CHECKING:
    from gearcam.base.tolerances import Tolerances
    from gearcam.kinds.cam.result import CamResult
    from gearcam.numeric.contour import Contour
    from gearcam.parts.body import Part
    from gearcam.pictures.drawings import Drawing, Path

ROWS: Final = (
    "cam.follower", "cam.roller_radius_mm", "cam.dome_radius_mm", "cam.pivot_distance_mm",
    "cam.arm_mm", "cam.face_offset_mm", "cam.offset_mm", "motion.total_lift",
    "cam.prime_radius_mm", "cam.base_radius_mm", "cam.rotation", "cam.pressure_angle_deg.rise_max",
    "cam.pressure_angle_deg.return_max", "cam.profile.clearance_mm", "part.density_kg_m3",
    "part.mass.mass_kg", "part.mass.centroid_mm", "part.mass.unbalance_g_mm",
)  # fmt: skip
"""Facts in the tables of all drawings."""

C = TypeVar("C", bound=Cam)
S = TypeVar("S", bound=CamSpec)
F = TypeVar("F", bound=FollowerSpec)


def lift_program(design: Any, tolerances: Tolerances) -> Program:
    """Return the lift of a `design` over a turn, which does not depend on sizes.

    Parameters
    ----------
    design : Design
        With the fields ``motion`` and ``follower``.
    tolerances : Tolerances
        Internal accuracy.
    """
    motion = design.motion
    make = partial(make_program, motion) if isinstance(motion, Sequence) else motion.program
    return make(tolerances, oscillating=design.follower.oscillating)


class Form(ABC, Generic[C, S, F]):
    """A form of cams.

    Parameters
    ----------
    result : CamResult
        The result of a design of this form.
    """

    name: ClassVar[str]
    """As in a design file."""

    doc: ClassVar[str]
    """One line for people."""

    tables: ClassVar[dict[str, type]] = {
        "follower": FollowerSpec,
        "cam": CamSpec,
        "drive": DriveSpec,
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

    def __init__(self, result: CamResult) -> None:
        self.result = result
        self.design = result.solved

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self.result!r})"

    @property
    def cam(self) -> C:
        """The cam that it has made."""
        return cast("C", self.result.cam)

    @property
    def given(self) -> S:
        """The sizes of the cam in the design."""
        return cast("S", self.design.cam)

    @property
    def follower(self) -> F:
        """The follower in the design."""
        return cast("F", self.design.follower)

    @property
    def blank(self) -> Any:
        """The blank in the design, of the class in `tables`."""
        return self.design.blank

    @property
    def output(self) -> Any:
        """What the design says of its output, of the class in `tables`."""
        return self.design.output

    @property
    def chord_tolerance(self) -> float:
        """Chord tolerance of the profile, mm."""
        return self.output.chord_tolerance or CHORD_TOLERANCE

    @property
    def step(self) -> tuple[str, float]:
        """Key and value of the step of tables of the motion, rad or mm."""
        return "output.motion_step_deg", self.output.motion_step

    @property
    def contact_width(self) -> float:
        """Width of the contact between cam and follower, mm."""
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

    def program(self) -> Program:
        """Return the lift that the design asks for."""
        return lift_program(self.design, self.result.tolerances)

    @abstractmethod
    def make(self, program: Program) -> C:
        """Return the cam with the lift of a `program`."""

    @abstractmethod
    def parts(self) -> tuple[Part, ...]:
        """Return what is made, each with all that is ordered."""

    @abstractmethod
    def finished(self) -> tuple[Contour, ...]:
        """Return the walls on the finished parts, in the order of the walls."""

    @abstractmethod
    def drawings(self) -> tuple[Drawing, ...]:
        """Return a drawing of each part in its own frame, for cutting."""

    @abstractmethod
    def picture(self) -> Drawing:
        """Return the cam assembled with its follower, at the angle of the design."""

    @abstractmethod
    def paths(self, radius: float | None) -> Mapping[str, Contour | Path]:
        """Return paths of the centre of a cutter of a `radius`, mm, by the stems of their files."""

    def rows_of(self, number: int) -> Sequence[str]:  # noqa: ARG002
        """Return the names of the facts in the table of a part's drawing, by its `number`."""
        _, other = self.follower.size_keys
        return [name for name in (*ROWS, *self.rows) if not name.endswith(other)]

    def heights(self) -> tuple[float, ...]:
        """Return the height of each part in the assembly, mm."""
        return (0.0,) * len(self.result.parts)

    @property
    def leading(self) -> str:
        """The name of the size for the headline, one of its `sizes`."""
        return self.follower.size_keys[0]

    def sizes(self) -> dict[str, Any]:
        """Return its sizes, as facts."""
        follower = self.result.follower
        return {
            **self.follower.placement,
            "rotation": Fact(self.given.rotation, "cam turns"),
            "prime_radius_mm": follower.prime_radius,
            "base_radius_mm": follower.prime_radius - follower.radius,
        }

    @abstractmethod
    def facts(self) -> dict[str, Any]:
        """Return the facts of the cam beyond follower, size and pressure angles."""


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
