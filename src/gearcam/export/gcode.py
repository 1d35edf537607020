"""Programs of milling machines with a rotary axis A about X, as G-code.

Only words that free controllers run alike (LinuxCNC; grbl with a fourth axis): G0, G1, G4, G17,
G20, G21, G40, G49, G53, G54, G61, G80, G90, G93, G94, M0, M3, M5, M30, one comment a line. Numbers
have no exponent.

The tool rises before anything else moves: to Z0 of the machine, which homing has put at its top.
There X, Y and A are brought to the start, the spindle is started, and then the tool comes down.

In inverse time (G93) each move has its own F, one over its duration in minutes: how fast a tool
moves along a path that turns cannot be said by a feed in mm/min alone. G61 has each point reached,
where controllers otherwise round corners.

On a wrapped axis a word of A is a place from 0 to below 360, and its sign the way there. So a word
for a place where A is already, even by rounding, may make a whole turn; it is left out.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from gearcam.base.display import ShortRepr
from gearcam.base.inches import file_unit
from gearcam.base.numerals import decimal, formatted
from gearcam.numeric.arrays import Array

_DIGITS: int = 5
"""Digits that count of an inverse time."""

_LONGEST: int = 70
"""Longest comment: a line of grbl has at most 80 characters."""

RUN_UP: int = 3
"""Time for the spindle to come to its speed, s."""

_COORDINATE = re.compile(r"(?<=\b[XYZ])-?\d+(?:\.\d+)?")
"""A place along an axis in a comment: in the unit of the program, which is not said there."""

_START = "G21 G17 G40 G49 G54 G80 G90 G94", "G61", "G53 G0 Z0"
_END = "G53 G0 Z0", "M5", "M30"


@dataclass(frozen=True, eq=False, kw_only=True)
class RotaryProgram(ShortRepr):
    """What a program says.

    Parameters
    ----------
    moves : (n, 4) array, mm and deg
        X, Y, Z, A at the end of each move; A never falls. The first one is rapid, to above the
        first point.
    per_minute : (n,) array, 1/min
        Inverse times; 0 of rapid moves.
    decimals : sequence of int
        Decimals of X, Y, Z and A.
    spindle : float, rpm, or None
        Speed of the spindle; None: the program stops until it has been started by hand.
    crosswise : bool
        Whether the machine has the axis Y.
    wrapped : bool
        Whether A is stated from 0 to below 360 deg, for a wrapped axis.
    notes : sequence of str
        Comments at its head; what is not ASCII and brackets are left out.
    """

    moves: Array
    per_minute: Array
    decimals: Sequence[int]
    spindle: float | None
    crosswise: bool
    wrapped: bool
    notes: Sequence[str]


def gcode_bytes(program: RotaryProgram) -> bytes:
    """Write a program in the unit of files (see `gearcam.base.inches`).

    Parameters
    ----------
    program : RotaryProgram
        What it says, in mm.

    Returns
    -------
    bytes
        ASCII.
    """
    unit = file_unit()
    notes, start = [unit.told(note) for note in program.notes], _START
    if unit.size != 1.0:
        *places, fine = program.decimals
        moves = program.moves / np.array([unit.size] * 3 + [1.0])
        decimals = [*(one + 2 for one in places), fine]
        program = replace(program, moves=moves, decimals=decimals)

        def coordinate(found: re.Match[str]) -> str:
            return formatted(round(float(found[0]) / unit.size, max(decimals)), 9)

        notes = [_COORDINATE.sub(coordinate, note) for note in notes]
        start = [words.replace("G21", "G20") for words in start]
    lines = [f"({line})" for note in notes for line in _wrapped(note)]
    lines += [*start, *_moved(program), *_END]
    return ("\n".join(lines) + "\n").encode("ascii")


def _moved(program: RotaryProgram) -> Iterator[str]:
    """Yield the moves, in inverse time where they cut, and the start of the spindle."""
    words = _words(program)
    first = next(words)
    down = next(word for word in first if word.startswith("Z"))
    yield f"G0 {' '.join(word for word in first if word != down)}"
    if program.spindle is None:
        yield "(MSG, Start the spindle by hand, clockwise from above. Then resume.)"
        yield "M0"
    else:
        yield f"S{decimal(program.spindle, 0)} M3"
        yield f"G4 P{RUN_UP}"
    yield f"G0 {down}"
    inverse = False
    for given, rate in zip(words, program.per_minute[1:].tolist(), strict=True):
        if inverse is not (rate > 0.0):
            inverse = not inverse
            yield "G93" if inverse else "G94"
        if inverse:
            feed = np.format_float_positional(rate, _DIGITS, fractional=False, trim="-")
            yield f"G1 {' '.join(given)} F{feed}"
        else:
            yield f"G0 {' '.join(given)}"
    if inverse:
        yield "G94"


def _words(program: RotaryProgram) -> Iterator[list[str]]:
    """Yield the words of each move; that of A only if it turns."""
    *places, fine = program.decimals
    step, last = 10**fine, None
    for *place, angle in program.moves.tolist():
        named = zip("XYZ", place, places, strict=True)
        words = [f"{axis}{_short(value, count)}" for axis, value, count in named]
        if not program.crosswise:
            del words[1]
        turned = round(angle * step)
        if turned != last:
            shown = turned % (360 * step) if program.wrapped else turned
            words.append(f"A{_short(shown / step, fine)}")
        last = turned
        yield words


def _short(value: float, places: int) -> str:
    """Return a number in so many decimals, without a minus before zero."""
    return f"{round(value, places) + 0.0:.{places}f}"


def _wrapped(note: str) -> Iterator[str]:
    """Yield a note in lines that a controller takes as comments."""
    plain = "".join(c for c in note if c.isascii() and c.isprintable() and c not in "();%")
    line = ""
    for word in plain.split():
        if line and len(line) + len(word) >= _LONGEST:
            yield line
            line = ""
        line = f"{line} {word[:_LONGEST]}".strip()
    yield line
