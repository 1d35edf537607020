"""Quantities: units of parameters, and their conversion to mm and rad.

Parameters of laws, racks and blanks are frozen dataclasses whose fields are made by `param`.
Inside the program their values are in mm and rad; a design file has them in the unit of the
quantity under the key ``name + suffix`` (``knots`` becomes ``knots_deg``). The keys of the file,
their ranges, the schema and messages all follow from these fields.
"""

from __future__ import annotations

import dataclasses
import inspect
import math
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, Literal

if TYPE_CHECKING:
    from collections.abc import Collection, Sequence

    from numpy.typing import NDArray

Solve = Literal["solve"]
"""A value that is found from the condition of closure."""

if TYPE_CHECKING:
    Row = Sequence[float] | NDArray[Any]
    RowOfSome = Sequence[float | Solve]
else:
    Row = tuple[float, ...]
    RowOfSome = tuple[float | Solve, ...]
"""Numbers as a list, a tuple or an array, kept as a tuple; in the second some may be solved for."""


def size_pattern(letters: str = "[A-Za-z]{1,2}") -> str:
    """Return the pattern of a size with a class, such as 25 H7, of some `letters`.

    Its groups are the size, the class with blanks, the letters and the grade.
    """
    return rf"(\d+(?:\.\d*)?|\.\d+)(\s*({letters})\s*(\d{{1,2}}))"


REQUIRED: Final = dataclasses.MISSING
"""Default of required parameters."""

OPPOSITES: Final = {
    "translating": "oscillating",
    "oscillating": "translating",
    "turning": "sliding",
    "sliding": "turning",
}
"""Circumstances on which units depend: the motion of a cam's follower, and that of the cam."""


@dataclass(frozen=True)
class Quantity:
    """A quantity: its suffix in files, its factor to mm or rad, the name of its unit.

    Values that must be positive are at least `least`, in the unit of the file: nobody makes less.
    """

    suffix: str
    factor: float
    unit: str
    least: float = 0.0


FILE_KEYS: Final = frozenset({"file", "outline1", "outline2"})
"""Keys that name a file, relative to that of the design."""

ANGLE: Final = Quantity("_deg", math.pi / 180.0, "deg", least=1e-6)
ARCSEC: Final = Quantity("_arcsec", math.pi / 648000.0, "arcsec")
LENGTH: Final = Quantity("_mm", 1.0, "mm", least=1e-3)
NUMBER: Final = Quantity("", 1.0, "")
COUNT: Final = Quantity("", 1.0, "")
TEXT: Final = Quantity("", 1.0, "")
RPM: Final = Quantity("_rpm", math.pi / 30.0, "rpm", least=1e-6)
SPEED: Final = Quantity("_mm_s", 1.0, "mm/s", least=1e-6)
SPEED_PER_MINUTE: Final = Quantity("_mm_min", 1.0 / 60.0, "mm/min", least=1e-6)
FORCE: Final = Quantity("_n", 1.0, "N")
TORQUE: Final = Quantity("_nm", 1e3, "N m")
STIFFNESS: Final = Quantity("_n_mm", 1.0, "N/mm", least=1e-9)
STIFFNESS_PER_RAD: Final = Quantity("_nm_rad", 1e3, "N m/rad", least=1e-9)
DAMPING: Final = Quantity("_n_s_mm", 1.0, "N s/mm")
DAMPING_PER_RAD: Final = Quantity("_nm_s_rad", 1e3, "N m s/rad")
MASS: Final = Quantity("_kg", 1.0, "kg", least=1e-9)
INERTIA: Final = Quantity("_kg_m2", 1.0, "kg m2", least=1e-15)
MPA: Final = Quantity("_mpa", 1.0, "MPa", least=1e-6)
ACCELERATION: Final = Quantity("_m_s2", 1.0, "m/s2")
DENSITY: Final = Quantity("_kg_m3", 1.0, "kg/m3")
LENGTH_PER_RAD: Final = Quantity("_mm_per_rad", 1.0, "mm/rad")
LENGTH_PER_RAD2: Final = Quantity("_mm_per_rad2", 1.0, "mm/rad2")
ANGLE_PER_RAD: Final = Quantity("_deg_per_rad", math.pi / 180.0, "deg/rad")
ANGLE_PER_RAD2: Final = Quantity("_deg_per_rad2", math.pi / 180.0, "deg/rad2")

_SUFFIXES: Final = {
    one.suffix: one.unit for one in [*globals().values()] if isinstance(one, Quantity)
} | {
    one.suffix.replace("_mm", "_in"): one.unit.replace("mm", "in")
    for one in (LENGTH, SPEED, SPEED_PER_MINUTE, LENGTH_PER_RAD, LENGTH_PER_RAD2)
}


def unit_of(key: str) -> str:
    """Return the unit with which a key of a file ends; empty without one."""
    return _SUFFIXES[max((one for one in _SUFFIXES if key.endswith(one)), key=len)]


WHEELS: Final = "wheel 1 and wheel 2"
"""The `order` of values of both wheels: the driver is wheel 1."""

LONGEST: Final = 1e5
"""Largest length of a design, mm."""

LEAST_ALLOWANCE: Final = 1e-6
"""Least amount that is taken off, as clearance or kerf, mm: it may be far below any size."""

NONE: Final = "none"
"""The word for what there is none of, where words may be given."""

FINEST: Final = 1e-9
"""Least tolerance of a design, mm."""

NARROWEST_DEG: Final = 0.01
NARROWEST: Final = NARROWEST_DEG * ANGLE.factor
"""Least width of a phase, degrees and rad: a narrower one is a jump."""


@dataclass(frozen=True)
class Param:
    """Unit, bounds and meaning of a parameter; bounds are in the unit of the file.

    Parameters
    ----------
    quantity : Quantity
        Unit and suffix.
    gt, ge, lt, le : float or None
        Bounds of each value, in the unit of files.
    zero_is_none : bool
        Whether 0, or the word `NONE`, means that there is none; other values are then at least
        `least`.
    finest : float
        Least value beside 0 where it is not that of the quantity, which is for sizes.
    choices : collection of str or None
        The allowed words, for text.
    min_length : int or None
        Least length, for lists.
    doc : str
        One line for schema, template and messages.
    example : object
        A value for the template, in the unit of files; required where there is no fixed default.
    word : str
        The word of the key if a field cannot have this name, such as ``from``.
    both : bool
        Whether a single value may be given for two, such as both wheels.
    order : str
        Which of two values comes first: what both are called, such as ``x, y``.
    alone : bool
        Whether a single value may be given for a list of one.
    function : bool
        Whether Python functions may be given instead of a text.
    nested : tuple of str
        Kinds of design, if the value is a design: that of a file, or given in its place.
    when : tuple of str
        Circumstances in which the parameter has this key, of `OPPOSITES`; always if empty.
    other : Param or None
        The parameter in the opposite of the first circumstance: it has another unit and key.
    constant_at : float, "mean" or None
        Value at which the ratio of a law is constant: the search for remedies moves towards it;
        "mean" is the mean ratio.
    at_zero : str
        What to tell of the value 0 where it is not allowed.
    solvable : bool
        Whether "solve" may be given in the place of a value, which the program then finds.
    fit : bool
        Whether the diameter or the width of a hole may have a tolerance class: ``25 H7``.
    """

    quantity: Quantity = NUMBER
    gt: float | None = None
    ge: float | None = None
    lt: float | None = None
    le: float | None = None
    zero_is_none: bool = False
    finest: float = 0.0
    choices: Collection[str] | None = None
    min_length: int | None = None
    doc: str = ""
    example: Any = None
    word: str = ""
    both: bool = False
    order: str = ""
    alone: bool = False
    function: bool = False
    nested: tuple[str, ...] = ()
    when: tuple[str, ...] = ()
    other: Param | None = None
    constant_at: float | Literal["mean"] | None = None
    at_zero: str = ""
    solvable: bool = False
    fit: bool = False

    def __post_init__(self) -> None:
        if self.gt == 0.0 and self.quantity.least:
            object.__setattr__(self, "gt", None)
            object.__setattr__(self, "ge", self.quantity.least)

    @property
    def called(self) -> tuple[str, ...]:
        """What the two values of a list are called; empty if nothing is known of them."""
        order = self.order or (WHEELS if self.both else "")
        return tuple(re.split(", | and ", order)) if order else ()

    @property
    def least(self) -> float:
        """Least value beside 0, in the unit of the file; 0 if there is no such limit."""
        return (self.finest or self.quantity.least) if self.zero_is_none else 0.0

    def key(self, name: str) -> str:
        """Return the key in a design file, such as ``module_mm``."""
        return (self.word or name) + self.quantity.suffix


def param(quantity: Quantity = NUMBER, *, default: Any = REQUIRED, **rest: Any) -> Any:
    """Return a dataclass field of a `quantity` with a `default`; `rest` goes to `Param`."""
    return dataclasses.field(default=default, metadata={"param": Param(quantity, **rest)})


def nested(*kinds: str, default: Any = REQUIRED, **rest: Any) -> Any:
    """Return a dataclass field that holds a design of one of some `kinds` (see `param`)."""
    return param(TEXT, default=default, nested=kinds, **rest)


def allowance(*, doc: str) -> Any:
    """Return a dataclass field of a length that is taken off: 0, or at least `LEAST_ALLOWANCE`.

    Parameters
    ----------
    doc : str
        Its meaning.
    """
    bounds = {"ge": 0, "le": 100, "zero_is_none": True, "finest": LEAST_ALLOWANCE}
    return param(LENGTH, default=0.0, doc=doc, **bounds)


def positive_length(
    *, example: float | None = None, default: Any = None, doc: str, solvable: bool = False
) -> Any:
    """Return a dataclass field of a length above 0, up to `LONGEST`.

    Parameters
    ----------
    example, default, doc, solvable
        See `param`; the default None means that it may be left out.
    """
    rest: dict[str, Any] = {"example": example, "doc": doc, "solvable": solvable}
    return param(LENGTH, default=default, gt=0, le=LONGEST, **rest)


def fixed(value: Any) -> Any:
    """Return a field of a subclass that has one `value` only: it is no parameter there."""
    return dataclasses.field(default=value, init=False)


def params_of(owner: type) -> dict[str, Param]:
    """Return the parameters of a dataclass by field name, in order."""
    return {
        field.name: field.metadata["param"]
        for field in dataclasses.fields(owner)
        if "param" in field.metadata
    }


_ALIASES: Final = {
    r" \| None$": "",
    r"^RowOfSome$": 'row of float or "solve"',
    r"^Row$": "row of float",
    r"float \| Solve": 'float or "solve"',
    r"float \| Hertz": 'float or "hertz"',
    r"float \| Flat": 'float or "flat"',
    r"^Given$": "str, function, or tuple of function and derivatives",
}
"""Names of types in docstrings."""


def described(owner: type, source: str = "") -> type:
    """Add the parameters of a dataclass to its docstring, and where it comes from.

    Parameters
    ----------
    owner : type
        A class; what its docstring has already is not added.
    source : str
        Lines of the section References; none by default.

    Returns
    -------
    type
        The same class.
    """
    doc = inspect.cleandoc(owner.__doc__ or "")
    documented = ", ".join(re.findall(r"^(\w[\w, ]*) : ", doc, re.MULTILINE)).split(", ")
    entries = [
        f"{field.name} : {_type_of(field)}\n    {_sentence(field.metadata['param'].doc)}"
        for field in (dataclasses.fields(owner) if dataclasses.is_dataclass(owner) else ())
        if "param" in field.metadata and field.name not in documented
    ]
    head, title, examples = doc.partition("\n\nExamples\n")
    head, section, attributes = head.partition("\n\nAttributes\n")
    if entries:
        start = "\n" if "\nParameters\n" in head else "\n\nParameters\n----------\n"
        head += start + "\n".join(entries)
    head += section + attributes
    if source and "\nReferences\n" not in head:
        head += f"\n\nReferences\n----------\n{source}"
    if title or head != doc:
        owner.__doc__ = head + title + examples
    return owner


def _type_of(field: dataclasses.Field[Any]) -> str:
    """Return type, unit and default of a parameter as text."""
    kind, parameter = field.type, field.metadata["param"]
    words = [kind.__name__ if isinstance(kind, type) else str(kind)]
    for alias, text in _ALIASES.items():
        words = [re.sub(alias, text, word) for word in words]
    quantities = (parameter.quantity, *((parameter.other.quantity,) if parameter.other else ()))
    words += [" or ".join(one.unit.replace("deg", "rad") for one in quantities if one.unit)]
    if field.default is not REQUIRED:
        words.append("optional" if field.default is None else f"default {field.default!r}")
    return ", ".join(word for word in words if word)


def _sentence(doc: str) -> str:
    """Return the meaning of a parameter as a sentence, without notes on keys of files."""
    text = re.sub(r" \(translating[^)]*\)", "", doc)
    plain = text.split()[0].rstrip(";").isalpha()  # no symbol
    return f"{text[0].upper() if plain else text[0]}{text[1:]}."
