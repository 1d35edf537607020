"""Internal pairs against external ones with the same law, teeth and module."""

from __future__ import annotations

from functools import partial
from typing import Any

from cases import load, outlines
from measuring import Result, in_turns, table

DESIGN = """
kind = "gear-pair"
name = "{type}"
law = {{ {law} }}
pair = {{ type = "{type}", module_mm = 2, teeth = {teeth} }}
output = {{ files = ["csv"], chord_tolerance_mm = 0.001 }}
"""
PAIRS = {
    "24 : 48": ([24, 48], 'type = "formula", ratio = "1 + 0.25*cos(phi1)"'),
    "40 : 60": ([40, 60], 'type = "fourier", of = "ratio", cosines = [0.03], sines = [0.0, 0.02]'),
    "constant, 40 : 90": ([40, 90], 'type = "constant"'),
}
NOTE = """\
Both outlines at 1 um, module 2 mm; wheel and ring alternate with an external pair of the same law
and teeth, which has other curves. Times relative to the external pair: {listed}."""


def against_external(tries: int = 15) -> Result:
    """(q) Both outlines of internal pairs against those of external ones."""
    rows, ratios = [], {}
    for name, (teeth, law) in PAIRS.items():
        cases: dict[str, Any] = {
            f"{name}, {kind}": partial(
                outlines, load(DESIGN.format(type=kind, law=law, teeth=teeth))
            )
            for kind in ("internal", "external")
        }
        inside, outside = in_turns(cases, tries)
        rows += [inside, outside]
        ratios[name] = inside.over(outside)
    worst = max(ratios, key=lambda name: ratios[name])
    return Result(
        title="(q) Wheel and ring against an external pair",
        asked="less than twice the time at 1 um",
        found=f"at most {ratios[worst]:.2f} times, {worst}",
        passed=ratios[worst] < 2.0,
        body=[
            *table(rows),
            "",
            NOTE.format(listed=", ".join(f"{name} {ratio:.2f}" for name, ratio in ratios.items())),
        ],
    )
