"""Ratio in phases: values at knots, joined by cosine or cubic arcs with zero slope at each."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from gearcam.errors import InfeasibleError
from gearcam.laws.base import Claim, LawEntry, Lobes, RatioLaw, make_law, register
from gearcam.numeric.jets import Jet, cos, sin
from gearcam.numeric.piecewise import Piece
from gearcam.quantities import ANGLE, NUMBER, TEXT, Solve, param
from gearcam.tolerances import Tolerances


def _cosine(start: float, end: float, low: float, width: float) -> Piece:
    """003 eqs. (2.1), (2.17) with Tables 2.2, 2.4."""
    mean, half, speed = 0.5 * (start + end), 0.5 * (start - end), math.pi / width

    def ratio(x: Jet) -> Jet:
        return half * cos(speed * (x - low)) + mean

    def motion(x: Jet) -> Jet:
        return mean * x + (half / speed) * sin(speed * (x - low))

    return Piece(ratio, motion)


def _cubic(start: float, end: float, low: float, width: float) -> Piece:
    """003 eq. (2.13) with Table 2.3, written on the unit interval."""
    rise = end - start

    def ratio(x: Jet) -> Jet:
        t = (x - low) / width
        return rise * (t * t * (3.0 - 2.0 * t)) + start

    def motion(x: Jet) -> Jet:
        t = (x - low) / width
        return (t * (start + rise * (t * t * (1.0 - 0.5 * t)))) * width

    return Piece(ratio, motion)


_SHAPES = {"cosine": _cosine, "cubic": _cubic}


@dataclass(frozen=True, kw_only=True)
class Phases:
    """Knots over one turn (or one lobe), a ratio at each; one ratio may be left to closure."""

    shape: str = param(TEXT, default="cosine", choices=tuple(_SHAPES), doc="arc between the knots")
    knots: tuple[float, ...] = param(
        ANGLE, ge=0, le=360, min_length=2, doc="driver angles, from 0 to 360 or one lobe"
    )
    ratios: tuple[float | Solve, ...] = param(
        NUMBER, gt=0, min_length=2, doc='i21 at the knots; one may be "solve"'
    )

    def problems(self) -> Iterator[tuple[str, int | None, str, str]]:
        """Yield what is wrong by reading: field, index, message, allowed."""
        if len(self.knots) != len(self.ratios):
            yield (
                "ratios",
                None,
                f"{len(self.ratios)} ratios for {len(self.knots)} knots",
                "one ratio for each knot",
            )
            return
        if self.knots[0] != 0.0:
            yield "knots", 0, "the first knot is not 0", "0"
        for index in range(1, len(self.knots)):
            if not self.knots[index] > self.knots[index - 1]:
                yield "knots", index, "knots must rise", "more than the knot before"
        first, last = self.ratios[0], self.ratios[-1]
        if first != last:
            given = last if first == "solve" else first
            yield "ratios", len(self.ratios) - 1, "the last ratio is not the first", f"{given!r}"
        if sum(value == "solve" for value in self.ratios[:-1]) > 1:
            second = [k for k, value in enumerate(self.ratios) if value == "solve"][1]
            yield "ratios", second, 'more than one "solve"', 'one "solve"; one lobe is enough'

    def build(self, lobes: Lobes, tolerances: Tolerances) -> RatioLaw:
        """Return the law for `lobes`, to `tolerances`.

        Raises
        ------
        InfeasibleError
            If the knots span neither a turn nor a lobe, or the law does not close (naming the
            closing value of each ratio), or no positive ratio closes it.
        """
        knots, ratios = self._one_lobe(lobes)
        values, solved = self._close(knots, ratios, lobes, tolerances)
        shape = _SHAPES[self.shape]
        pieces = [
            shape(values[k], values[k + 1], float(knots[k]), float(knots[k + 1] - knots[k]))
            for k in range(len(knots) - 1)
        ]
        return make_law(lobes, knots, pieces, tolerances, solved)

    def _one_lobe(self, lobes: Lobes) -> tuple[np.ndarray, list[float | Solve]]:
        knots = np.array(self.knots)
        for repeats in (1, lobes.n1):
            count = (len(knots) - 1) // repeats
            if abs(knots[-1] * lobes.n1 / repeats - 2.0 * math.pi) > 1e-12:
                continue
            tiled = (lobes.period * np.arange(repeats)[:, None] + knots[:count]).ravel()
            same = count * repeats == len(knots) - 1
            if same and np.allclose(tiled, knots[:-1], rtol=0, atol=1e-12):
                lobe = list(self.ratios[: count + 1])
                if lobe[:-1] * repeats == list(self.ratios[:-1]) and lobe[0] == lobe[-1]:
                    return np.append(knots[:count], lobes.period), lobe
        spans = (
            "360" if lobes.n1 == 1 else f"360 (repeating {lobes.n1} times) or {360 / lobes.n1:g}"
        )
        raise InfeasibleError(
            f"the knots must span {spans} deg for these tooth counts",
            where="law.knots_deg",
            value=math.degrees(knots[-1]),
            limit=360 / lobes.n1,
            unit="deg",
        )

    def _close(
        self,
        knots: np.ndarray,
        ratios: list[float | Solve],
        lobes: Lobes,
        tolerances: Tolerances,
    ) -> tuple[list[float], dict[str, float]]:
        """Solve the one ratio left open; both shapes have the mean of their end values."""
        widths = np.diff(knots)
        weights = 0.5 * (widths + np.roll(widths, 1))
        given = np.array([0.0 if value == "solve" else value for value in ratios[:-1]], dtype=float)
        rest = lobes.advance - float(weights @ given)
        if "solve" in ratios[:-1]:
            index = ratios.index("solve")
            given[index] = rest / weights[index]
            if not given[index] > 0.0:
                raise InfeasibleError(
                    "no positive ratio closes the law",
                    where=f"law.ratios[{index}]",
                    value=float(given[index]),
                    limit=0.0,
                    nearest="closure asks for this value; lower the other ratios",
                )
            return [*given, given[0]], {f"ratios[{index}]": float(given[index])}
        if abs(rest) > tolerances.refusal:
            raise InfeasibleError(
                "the phases do not close",
                where="law.ratios",
                value=math.degrees(lobes.advance - rest),
                limit=math.degrees(lobes.advance),
                unit="deg",
                nearest=_closing_values(given, rest / weights),
            )
        return [*given, given[0]], {}


def _closing_values(given: np.ndarray, change: np.ndarray) -> str:
    """Say which value each ratio must have for the law to close if only that one is changed."""
    lines = ["it closes with one of these"]
    for index, (value, step) in enumerate(zip(given, change, strict=True)):
        closing = value + step
        name = f"ratios[{index}]" if index else f"ratios[0] and ratios[{len(given)}]"
        state = f"{closing:.10g}" if closing > 0 else f"none ({closing:.6g} is not positive)"
        lines.append(f"{name} = {state} instead of {value:.10g}")
    return "; ".join(lines)


def _claims() -> tuple[Claim, ...]:
    turn, mid = 2 * math.pi, math.radians(160)
    two = (0.0, mid, turn)
    three = (0.0, mid, 1.5 * math.pi, turn)
    return (
        Claim(
            parameters=Phases(shape="cosine", knots=two, ratios=(1.6, 0.4, 1.6)),
            ratio={0.0: 1.6, mid: 0.4, mid / 2: 1.0, mid / 3: 1.3},
            motion={mid: mid, turn: turn, mid / 2: mid / 2 + 0.6 * mid / math.pi},
            continuity=1,
        ),
        Claim(
            parameters=Phases(shape="cubic", knots=two, ratios=(1.6, 0.4, 1.6)),
            ratio={0.0: 1.6, mid: 0.4, mid / 2: 1.0, mid / 4: 1.6 - 1.2 * 5 / 32},
            motion={mid: mid, turn: turn, mid / 2: mid * (0.8 - 1.2 * 3 / 32)},
            continuity=1,
        ),
        Claim(
            parameters=Phases(shape="cosine", knots=three, ratios=(1.6, 0.4, "solve", 1.6)),
            ratio={1.5 * math.pi: 1.06, turn: 1.6, mid: 0.4},
            motion={mid: mid, 1.5 * math.pi: mid + math.radians(110) * 0.73, turn: turn},
            continuity=1,
        ),
    )


register(
    LawEntry(
        name="phases",
        parameters=Phases,
        doc="ratios at knots, joined by cosine or cubic arcs with zero slope at each knot",
        continuity="C1 at the knots",
        source="003 sections 2.2.2.1 to 2.2.2.3, eqs. (2.1), (2.13), (2.17), (2.22)",
        claims=_claims,
    )
)
