"""Measure run times and write benchmarks/results/performance.md, with measured numbers only."""

from __future__ import annotations

import sys
from pathlib import Path

# the boolean sweep belongs to the tests, the table of outputs to a tool
sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))
sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tools"))

import asked_cases
import before_cases
import cam_cases
import cases
import design_cases
import dynamics_cases
import law_cases
import linkage_cases
import load_cases
import needs
import ring_cases
import solid_cases
import spatial_cases
import sweep_cases
from gearcam.numeric.arrays import keep_freed_memory
from measuring import Result, environment

HEAD = """# Performance

Written by `make bench`. Medians decide: medians of ratios if the samples of both sides alternate.
All samples are shown. A target that is not met is marked, with a measurement that shows why.
"""


def page(results: list[Result]) -> str:
    """Return the page as text."""
    lines = [HEAD, *environment(), "", "| case | target | measured | |", "|---|---|---|---|"]
    for result in results:
        verdict = result.verdict.replace("fail", "**fail**")
        lines.append(f"| {result.title} | {result.asked} | {result.found} | {verdict} |")
    for result in results:
        lines += ["", f"## {result.title}", "", *result.body]
        if result.given_up:  # also of a target that is met: others may refer to it
            begin = "Not met" if result.verdict == "not met" else "Where the time goes"
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
        solid_cases.against_booleans,
        spatial_cases.of_cylinder_cams,
        spatial_cases.of_globoidal_cams,
        linkage_cases.of_linkages,
        load_cases.of_loads,
        load_cases.of_assemblies,
        load_cases.of_machines,
        load_cases.of_dynamics,
        dynamics_cases.against_peers,
        sweep_cases.of_sweeps,
        design_cases.of_cams,
        design_cases.of_measures,
        before_cases.against_before,
        asked_cases.of_what_is_asked,
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
