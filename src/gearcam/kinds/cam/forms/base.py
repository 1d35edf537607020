"""Forms of cams: the keys that a form takes, the cam it makes, its parts, drawings and facts.

A *form* is an entry of `FORMS`, loaded when a design names it. It defines only what is special to
it; all other code uses the walls, motions and parts of the cam that it has made, in their order,
and never asks for the name of a form. The disc cam (`disc`) has what fits every cam whose walls are
the outlines of plates.

Refused when a design is read: keys of other forms, and missing ones.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any, ClassVar, Final, Protocol

from gearcam.base.facts import Fact
from gearcam.base.registry import Registry
from gearcam.designs.faults import Fault, quoted, show
from gearcam.designs.slips import nearest
from gearcam.designs.table import Table, table_of
from gearcam.laws.program import Program, make_program

if TYPE_CHECKING:
    from gearcam.base.tolerances import Tolerances
    from gearcam.cams.cam import Cam
    from gearcam.kinds.cam.build import CamResult
    from gearcam.kinds.cam.design import CamDesign
    from gearcam.numeric.contour import Contour
    from gearcam.parts.body import Part
    from gearcam.pictures.drawings import Drawing, Path

Keys = Mapping[str, tuple[str, ...]]
"""Fields of parameters by the titles of their tables."""

PLATE: Final[Keys] = {
    "follower": (
        "type", "motion", "roller_radius", "dome_radius", "offset", "arm", "pivot_distance",
        "face_offset",
    ),
    "cam": ("form", "prime_radius", "base_radius", "thickness", "rotation"),
    "blank": (
        "bore_diameter", "keyway_width", "keyway_depth", "keyway_angle", "bore_flat", "bolts",
        "bolt_circle", "bolt_diameter", "bolt_angle", "hub_diameter", "hub_front", "hub_back",
        "lightening_holes", "rim", "web", "density", "clearance", "clearance_bores",
    ),
    "output": ("pose", "motion_step"),
}  # fmt: skip
"""Keys of a plate that turns."""

SLIDING: Final = ("translating",)
"""Names of the forms that slide, known without loading them."""

OWN_OUTPUT: Final = ("pose", "place", "motion_step", "travel_step")
"""Keys of ``[output]`` that only some forms have."""


def plate_keys(cam: tuple[str, ...] = (), follower: tuple[str, ...] = ()) -> Keys:
    """Return the keys of a plate that turns, and more of its `cam` and its `follower`."""
    return PLATE | {"follower": (*PLATE["follower"], *follower), "cam": (*PLATE["cam"], *cam)}


class Form(Protocol):
    """A form of cams: its name, and what is special to it."""

    name: str
    """As in a design file."""

    doc: str
    """One line for people."""

    takes: ClassVar[Keys] = PLATE
    """Keys that it takes."""

    needs: ClassVar[Keys] = {}
    """Keys that it needs, besides those that every cam needs."""

    half_turns: ClassVar[bool] = False
    """Whether phases may fill half a turn; the other half is then its opposite."""

    assembly: ClassVar[str] = ""
    """Stem of the files of the assembly; empty for forms with one part."""

    @property
    def slides(self) -> bool:
        """Whether it slides: its motion is given over a travel, not over a turn."""
        return self.name in SLIDING

    rows: ClassVar[tuple[str, ...]] = ()
    """Facts of its own in the tables of its drawings."""

    def __repr__(self) -> str:
        return f"{type(self).__name__}()"

    def faults(self, parts: Mapping[str, Any]) -> Iterator[Fault]:  # noqa: ARG002
        """Yield contradictions between the `parts` of a design, which are given by their titles."""
        yield from ()

    def program(self, design: CamDesign, tolerances: Tolerances) -> Program:
        """Return the lift that a `design` asks for, to `tolerances`."""
        motion, swings = design.motion, design.follower.oscillating
        make = partial(make_program, motion) if isinstance(motion, Sequence) else motion.program
        return make(tolerances, oscillating=swings)

    @abstractmethod
    def make(self, design: CamDesign, program: Program) -> Cam:
        """Return the cam of a `design` and the lift that it asks for."""

    @abstractmethod
    def parts(self, result: CamResult) -> tuple[Part, ...]:
        """Return what is made, each with all that is ordered."""

    @abstractmethod
    def made(self, result: CamResult) -> tuple[Contour, ...]:
        """Return the walls on the finished parts, in the order of the walls."""

    @abstractmethod
    def drawings(self, result: CamResult) -> tuple[Drawing, ...]:
        """Return a drawing of each part in its own frame, for cutting."""

    @abstractmethod
    def picture(self, result: CamResult) -> Drawing:
        """Return the cam assembled with its follower, at the angle of the design."""

    @abstractmethod
    def paths(self, result: CamResult, radius: float | None) -> Mapping[str, Contour | Path]:
        """Return paths of the centre of a cutter of a `radius`, mm, by the stems of their files."""

    def rows_of(self, number: int, rows: tuple[str, ...]) -> tuple[str, ...]:  # noqa: ARG002
        """Return the facts in the table of a part's drawing: `rows` of all forms, and its own."""
        return (*rows, *self.rows)

    def heights(self, result: CamResult) -> tuple[float, ...]:
        """Return the height of each part in the assembly, mm."""
        return (0.0,) * len(result.parts)

    def leading(self, result: CamResult) -> str:
        """Return the name of the size for the headline, one of its `sizes`."""
        return "prime_radius_mm" if result.follower.has_centre else "base_radius_mm"

    def sizes(self, result: CamResult) -> dict[str, Any]:
        """Return its sizes, as facts."""
        follower = result.follower
        return {
            "rotation": Fact(result.design.cam.rotation, "cam turns"),
            "prime_radius_mm": follower.prime_radius,
            "base_radius_mm": follower.prime_radius - follower.radius,
        }

    @abstractmethod
    def facts(self, result: CamResult) -> dict[str, Any]:
        """Return the facts of the cam beyond follower, size and pressure angles."""


FORMS: Registry[Form] = Registry(
    "a form of cams",
    {
        "gearcam.kinds.cam.forms.disc": ("disc",),
        "gearcam.kinds.cam.forms.groove": ("groove",),
        "gearcam.kinds.cam.forms.conjugate": ("conjugate",),
        "gearcam.kinds.cam.forms.yoke": ("yoke",),
        "gearcam.kinds.cam.forms.translating": ("translating",),
    },
)
"""The forms by name, each loaded when it is asked for."""


def form_of(document: Mapping[str, Any]) -> Form:
    """Return the form that a `document` names or nearly names, else the disc."""
    cam = document.get("cam")
    name = cam.get("form") if isinstance(cam, Mapping) else None
    return FORMS[(nearest(name, FORMS) if isinstance(name, str) else "") or "disc"]


def form_keys(document: Mapping[str, Any], table: Table) -> list[str]:
    """Return the keys of a `table` that the form of a `document` may be given."""
    form = form_of(document)
    return [key for key, entry in table.entries.items() if _takes(form, table.title, entry.name)]


def _takes(form: Form, title: str, name: str) -> bool:
    """Whether a form may be given a field of a table."""
    if title == "output" and name not in OWN_OUTPUT:
        return True
    return title not in form.takes or name in form.takes[title]


def form_faults(name: str, parts: Mapping[str, Any], owners: Mapping[str, type]) -> Iterator[Fault]:
    """Yield what is wrong with the keys of a form, or else what the form itself finds wrong.

    Parameters
    ----------
    name : str
        Of the form.
    parts : mapping
        Parameters that could be read, by the titles of their tables.
    owners : mapping
        Their classes.

    Yields
    ------
    Fault
    """
    if not {"follower", "cam"} <= parts.keys():
        return
    form = FORMS[name]
    found = [
        fault
        for title, owner in owners.items()
        if title in parts
        for fault in _key_faults(form, title, table_of(title, owner), parts[title])
    ]
    yield from found or form.faults(parts)


def _key_faults(form: Form, title: str, known: Table, made: Any) -> Iterator[Fault]:
    needs = form.needs.get(title, ())
    for key, entry in known.entries.items():
        value = getattr(made, entry.name)
        if value is None and entry.name in needs:
            yield Fault((title, key), f"is missing for a {form.name} cam", allowed=entry.param.doc)
        elif value not in (None, entry.default) and not _takes(form, title, entry.name):
            value = entry.outward(value)
            owners = [one for one in FORMS if _takes(FORMS[one], title, entry.name)]
            rule = f"with cam.form = {quoted(owners)}"
            yield Fault(
                (title, key), f"{show(value)}: does not apply to a {form.name} cam", value, rule
            )


def form_schema(title: str, owner: type) -> dict[str, Any]:
    """Return the JSON schema's rules for the keys of a table that depend on the form.

    Parameters
    ----------
    title : str
        Of the table; it has the key ``form``.
    owner : type
        The class of its parameters.

    Returns
    -------
    dict
    """
    entries = table_of(title, owner).entries.items()
    default = next(entry.default for _, entry in entries if entry.name == "form")
    rules = []
    for name, form in FORMS.items():
        given: dict[str, Any] = {"properties": {"form": {"const": name}}}
        if name != default:  # the form that counts where none is given
            given["required"] = ["form"]
        takes, needs = form.takes[title], form.needs.get(title, ())
        required = [key for key, entry in entries if entry.name in needs]
        foreign = [{"required": [key]} for key, entry in entries if entry.name not in takes]
        then = {"required": required, **({"not": {"anyOf": foreign}} if foreign else {})}
        rules.append({"if": given, "then": then})
    sizes = [{"required": ["prime_radius_mm"]}, {"required": ["base_radius_mm"]}]
    slides = {"required": ["form"], "properties": {"form": {"enum": list(SLIDING)}}}
    return {"allOf": rules, "oneOf": [*sizes, slides]}
