"""A reader of programs: what a controller does with them, by the rules of LinuxCNC.

It knows of a program only its words. Its machine stands somewhere when it begins; its top is 300 mm
above the zero of the program.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

import numpy as np

TOP = 300.0
"""Z0 of the machine in the frame of the program, mm."""

FLOOR = 0.1
"""Least speed of LinuxCNC in inverse time, mm/min, or deg/min where only A moves."""

BEGIN = (-80.0, 12.0, 90.0, 200.0)
"""Where the machine stands when a program begins."""


@dataclass(frozen=True)
class Program:
    """A program as it is run: places in mm and degrees, the first where the machine stood.

    Moves, from each place to the next: which are rapid, 1/min, minutes, and whether the spindle
    turns.
    """

    places: np.ndarray
    rapid: np.ndarray
    rates: np.ndarray
    minutes: np.ndarray
    spins: np.ndarray
    words: tuple[str, ...]

    def densely(self, most: float = 0.2) -> np.ndarray:
        """Places of all cutting moves, interpolated in proportion, at most `most` degrees apart."""
        found = []
        for before, after, rapid in zip(self.places[:-1], self.places[1:], self.rapid, strict=True):
            if not rapid:
                count = 2 + math.ceil((after[3] - before[3]) / most)
                found.append(before + (after - before) * np.linspace(0.0, 1.0, count)[:, None])
        return np.concatenate(found)


def turned(at: float, word: str, *, wrapped: bool) -> float:
    """Where A goes from a place, deg: on a wrapped axis the sign of the word is the way."""
    value = float(word)
    if not wrapped:
        return value
    assert abs(value) < 360.0, f"A{word} is no place on a wrapped axis"
    if word.startswith("-"):
        return at - (at - abs(value)) % 360.0
    return at + (value - at) % 360.0


def minutes(step: np.ndarray, rate: float) -> float:
    """How long a move takes in inverse time, with the floor: A counts only if it moves alone."""
    length = math.hypot(*step[:3]) or abs(step[3])
    return length / max(FLOOR, length * rate)


def read(text: str, *, wrapped: bool = False) -> Program:
    """Read a program: modal words, comments, absolute millimetres, inverse time."""
    modal, spins, words = {"motion": "", "rate": "G94"}, False, []
    places, moves = [np.array(BEGIN)], []
    places[0][1] *= " Y" in text.partition("\nG21")[2]  # else it is locked at 0
    for line in text.splitlines():
        plain = re.sub(r"\([^()]*\)", "", line)
        assert len(line) < 80, line
        assert re.fullmatch(r"( ?[A-Z]-?\d+(\.\d+)?)*", plain), line
        given = re.findall(r"([A-Z])(-?[\d.]+)", plain)
        codes = [a + b for a, b in given if a in "GM"]
        words += codes
        spins = (spins or not {"M3", "M0"}.isdisjoint(codes)) and "M5" not in codes
        modal["motion"] = next((one for one in codes if one in ("G0", "G1")), modal["motion"])
        modal["rate"] = next((one for one in codes if one in ("G93", "G94")), modal["rate"])
        moved, last = {a: b for a, b in given if a in "XYZA"}, places[-1]
        if not moved:
            continue
        place = [float(moved.get(axis, at)) for axis, at in zip("XYZA", last, strict=True)]
        if "G53" in codes:
            assert (moved, modal["motion"]) == ({"Z": "0"}, "G0"), line
            place[2] = TOP
        if "A" in moved:
            place[3] = turned(last[3], moved["A"], wrapped=wrapped)
        places.append(np.array(place))
        rapid = modal["motion"] == "G0"
        assert rapid or modal["rate"] == "G93", line
        rate = math.inf if rapid else float(dict(given)["F"])
        taken = 0.0 if rapid else minutes(places[-1] - last, rate)
        moves.append((rapid, rate, taken, spins))
    rapids, rates, taken, turning = map(np.array, zip(*moves, strict=True))
    return Program(np.array(places), rapids, rates, taken, turning, tuple(words))
