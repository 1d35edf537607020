"""Measure everything and write benchmarks/results/performance.md, which holds no number by hand."""

from __future__ import annotations

import sys
from pathlib import Path

# the sweep is the witness of the tests; what each output needs is found by a tool
sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))
sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tools"))

import before_cases
import cam_cases
import cases
import law_cases
import needs
import ring_cases
from gearcam.numeric.memory import keep_freed_memory
from measuring import Result, environment

HEAD = """# Performance

Written by `make bench`; medians decide, of ratios of samples taken in turns where there are such,
and every sample is shown. A target that cannot be met is given up by name, with the measurement
that shows why.
"""


def page(results: list[Result]) -> str:
    """The page as text."""
    lines = [HEAD, *environment(), "", "| target | asked | found | |", "|---|---|---|---|"]
    for result in results:
        verdict = result.verdict.replace("fail", "**fail**")
        lines.append(f"| {result.title} | {result.asked} | {result.found} | {verdict} |")
    for result in results:
        lines += ["", f"## {result.title}", "", *result.body]
        if result.given_up:  # of one that passes too: others' reasons may point there
            begin = "Given up" if result.verdict == "given up" else "What the time is"
            lines += ["", f"{begin}: {result.given_up}"]
    return "\n".join(lines) + "\n"


def main() -> int:
    keep_freed_memory()  # as the command line does
    results = []
    for case in (
        cases.whole_process,
        cam_cases.against_subtraction,
        cam_cases.cam_growth,
        cam_cases.groove_against_disc,
        cases.growth,
        cases.against_whole_outlines,
        cases.against_sweep,
        cases.against_ncgears,
        law_cases.against_ellipse,
        ring_cases.against_external,
        before_cases.against_before,
        before_cases.large_growth,
    ):
        found = case()
        for result in found if isinstance(found, list) else [found]:
            results.append(result)
            print(f"{result.verdict}  {result.title}: {result.found}", flush=True)
    results.sort(key=lambda result: result.title)
    needs.write(page(results))
    return 0 if all(result.verdict != "fail" for result in results) else 1


if __name__ == "__main__":
    sys.exit(main())
