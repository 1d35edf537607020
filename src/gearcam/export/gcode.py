"""Programs of milling machines with a rotary axis A about X, as G-code.

Only words that free controllers run alike (LinuxCNC; grbl with a fourth axis): G0, G1, G17, G21,
G54, G61, G90, G93, G94, M3, M5, M30, one comment a line. Lengths are in mm in four decimals, A in
degrees in five, neither with an exponent.

In inverse time (G93) each move has its own F, one over its duration in minutes: how fast a tool
moves along a path that turns cannot be said by a feed in mm/min alone. G61 has each point reached,
where controllers otherwise round corners.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from gearcam.base.numerals import decimal
from gearcam.numeric.arrays import Array

_LONGEST: int = 70
"""Longest comment: a line of grbl has at most 80 characters."""


def gcode_bytes(
    moves: Array, per_minute: Array, spindle: float, notes: Sequence[str], *, crosswise: bool
) -> bytes:
    """Write a program.

    Parameters
    ----------
    moves : (n, 4) array, mm and deg
        X, Y, Z, A at the end of each move. The first one is rapid, and begins with Z.
    per_minute : (n,) array, 1/min
        Inverse times; 0 of rapid moves.
    spindle : float, rpm
        Speed of the spindle.
    notes : sequence of str
        Comments at its head; what is not ASCII and brackets are left out.
    crosswise : bool
        Whether the machine has the axis Y.

    Returns
    -------
    bytes
        ASCII.
    """
    lines = [f"({line})" for note in notes for line in _wrapped(note)]
    lines += ["G21 G90 G94 G17 G54", "G61", f"G0 Z{_short(moves[0, 2], 4)}"]
    lines += [f"S{decimal(spindle, 0)} M3", *_moved(moves, per_minute, crosswise=crosswise)]
    lines += ["M5", "M30"]
    return ("\n".join(lines) + "\n").encode("ascii")


def _moved(moves: Array, per_minute: Array, *, crosswise: bool) -> Iterator[str]:
    """Yield the moves, in inverse time where they cut."""
    inverse = False
    for (x, y, z, a), rate in zip(moves.tolist(), per_minute.tolist(), strict=True):
        if inverse is not (rate > 0.0):
            inverse = not inverse
            yield "G93" if inverse else "G94"
        words = [f"X{_short(x, 4)}", f"Y{_short(y, 4)}", f"Z{_short(z, 4)}", f"A{_short(a, 5)}"]
        if not crosswise:
            del words[1]
        if inverse:
            words.append(f"F{np.format_float_positional(rate, 5, fractional=False, trim='-')}")
        yield " ".join(["G1" if inverse else "G0", *words])


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
