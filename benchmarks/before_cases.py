"""Run times relative to an older commit, both measured in the same run."""

from __future__ import annotations

import math
import os
import subprocess
import sys
import tempfile
from contextlib import ExitStack
from itertools import pairwise
from pathlib import Path

from cases import NAIL, slope
from measuring import ROOT, Result, Timing, commands, table

sys.path.insert(0, str(ROOT / "tools"))
from compare_sides import tree_of

BEFORE = "44f8390"
"""The older commit to which all ratios refer."""

CHILD = """
import sys, tempfile, time
import gearcam
try:
    from gearcam.numeric.arrays import keep_freed_memory
except ImportError:  # its place in older commits
    from gearcam.numeric.memory import keep_freed_memory
keep_freed_memory()
nail = gearcam.load(sys.argv[1])

def outlines():
    job = gearcam.build(nail)
    job.gear1.outline, job.gear2.outline
    return job

def checked():
    job = outlines()
    job.findings
    return job

def whole(_):
    with tempfile.TemporaryDirectory() as folder:
        gearcam.build(nail).write(folder, files=("dxf", "stl", "csv"))

none = lambda: None
cases = {
    "dxf": (checked, lambda job: job.files("dxf")),
    "step": (checked, lambda job: job.files("step")),
    "warm": (none, whole),
}
for line in sys.stdin:
    prepare, act = cases[line.strip()]
    given = prepare()
    start = time.process_time()
    act(given)
    print(time.process_time() - start, flush=True)
"""
CALL = """
import sys
sys.path.insert(0, sys.argv.pop(1))
from gearcam.cli import main
sys.exit(main())
"""
CASES = {
    "dxf": ("(i) DXF of the nail machine", 0.25, 9),
    "warm": ("(m) The nail machine's dxf, stl and csv in one process", 0.35, 9),
    "step": ("(n) STEP of the nail machine", 0.6, 5),
}
"""Cases with title, largest ratio allowed, and number of samples."""
NOTE = f"Processor time, both sides alternately; before: commit {BEFORE}."


def against_before(fewer: int = 1) -> list[Result]:
    """(i), (m) to (o) Run times of stages relative to the older commit."""
    with ExitStack() as stack:
        before = stack.enter_context(tree_of(BEFORE))
        nail = Path(stack.enter_context(tempfile.TemporaryDirectory())) / NAIL.name
        # the older commit has no report
        nail.write_text(NAIL.read_text(encoding="utf-8").replace(', "report"', ""), "utf-8")
        trees = {"before": before, "now": ROOT}
        sides = {name: stack.enter_context(_side(tree, nail)) for name, tree in trees.items()}
        results = []
        for case, (title, asked, tries) in CASES.items():
            timings = alternately(sides, case, max(tries // fewer, 1))
            results.append(ratio_of(title, asked, timings, NOTE))
        return [*results, _cold(trees, nail, max(9 // fewer, 1))]


def _side(tree: Path, nail: Path) -> subprocess.Popen[str]:
    return child(CHILD, str(nail), PYTHONPATH=str(tree / "src"))


def child(program: str, *words: str, **variables: str) -> subprocess.Popen[str]:
    """Return a process that answers lines with times."""
    return subprocess.Popen(
        [sys.executable, "-c", program, *words],
        env={**os.environ, **variables},
        text=True,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
    )


def alternately(sides: dict[str, subprocess.Popen[str]], case: str, count: int) -> list[Timing]:
    """Return samples of a case from both sides, alternately; the first round is not counted."""
    samples: dict[str, list[float]] = {name: [] for name in sides}
    for _ in range(count + 1):
        for name, side in sides.items():
            assert side.stdin is not None
            assert side.stdout is not None
            print(case, file=side.stdin, flush=True)
            samples[name].append(float(side.stdout.readline()))
    return [Timing(name, tuple(values[1:])) for name, values in samples.items()]


def _cold(trees: dict[str, Path], nail: Path, tries: int) -> Result:
    """Return the result for the whole command in a separate process."""
    with tempfile.TemporaryDirectory() as folder:
        words = ["build", str(nail), "--only", "dxf,stl,csv", "-o", folder]
        timings = commands(
            {
                name: [sys.executable, "-c", CALL, str(tree / "src"), *words]
                for name, tree in trees.items()
            },
            tries,
        )
    note = f"Whole processes, alternately; before: commit {BEFORE}."
    return ratio_of("(o) The nail machine's dxf, stl and csv by the command", 0.55, timings, note)


def ratio_of(title: str, asked: float, timings: list[Timing], note: str) -> Result:
    """Return the ratio of the second timing to the first."""
    before, now = timings
    ratio = now.over(before)
    return Result(
        title=f"{title} against an older commit",
        asked=f"at most {asked:g} of its time",
        found=f"{ratio:.3f} of it",
        passed=ratio <= asked,
        body=[*table(timings), "", note],
    )


GROWING = """
import sys, time
import gearcam
try:
    from gearcam.numeric.arrays import keep_freed_memory
except ImportError:  # its place in older commits
    from gearcam.numeric.memory import keep_freed_memory
keep_freed_memory()
design = gearcam.load(sys.argv[1])
for _ in sys.stdin:
    start = time.process_time()
    job = gearcam.build(design)
    job.gear1.outline, job.gear2.outline
    print(time.process_time() - start, flush=True)
"""
PAIR = """
kind = "gear-pair"
name = "growing"
law = {{ {law} }}
pair = {{ module_mm = {module}, teeth = [{teeth}, {teeth}] }}
output = {{ files = ["csv"] }}
"""
TEETH = [187, 375, 750, 1500, 3000]
GROWTHS = {
    "teeth of an ellipse of eccentricity 0.99": TEETH,
    "knots of phases": [25, 50, 100, 200, 400],
    "rows of a table": [625, 1250, 2500, 5000, 10000],
    "harmonics": [4, 8, 16, 32, 64],
}


def large_growth(tries: int = 5) -> Result:
    """(p) Outlines against numbers of teeth, knots, rows of tables and harmonics."""
    rows, slopes, worst = [], {}, 0.0
    for what, counts in GROWTHS.items():
        with ExitStack() as stack:
            folder, sides = Path(stack.enter_context(tempfile.TemporaryDirectory())), {}
            for count in counts:
                path = folder / f"{count}.toml"
                path.write_text(_design(what, count), encoding="utf-8")
                side = stack.enter_context(child(GROWING, str(path)))
                sides[f"{count} {what}"] = side
            timings = alternately(sides, "", tries)
        rows += [timing.line() for timing in timings]
        steps = [timing.over(before) for before, timing in pairwise(timings)]
        slopes[what] = slope(counts, [math.prod(steps[:k]) for k in range(len(counts))])
        worst = max(worst, steps[-1])
    listed = ", ".join(f"{what} n^{value:.2f}" for what, value in slopes.items())
    return Result(
        title="(p) To 3000 teeth, 400 knots, 10 000 rows and 64 harmonics",
        asked="time grows at most linearly (n^1.05 and 2.2 times, for noise)",
        found=f"{listed}; the last doubling takes at most {worst:.2f} times as long",
        passed=max(slopes.values()) <= 1.05 and worst <= 2.2,
        body=[
            "| case | median | samples |",
            "|---|---|---|",
            *rows,
            "",
            "Processor time of both outlines; 40 teeth of module 2 mm except where teeth grow.",
        ],
    )


def _design(what: str, count: int) -> str:
    teeth, module = 40, 2.0
    angles = [360.0 * k / (count - 1) for k in range(count)]
    waves = [round(math.cos(math.radians(angle)), 12) for angle in angles]
    match what.split()[0]:
        case "teeth":
            teeth, module = count, 20.0 / count
            law = 'type = "ellipse", eccentricity = 0.99'
        case "knots":
            # so shallow that no arc between knots is too sharp for the teeth
            ratios = [1.0 + 1e-4 * wave for wave in waves]
            values = ", ".join(['"solve"' if k == 1 else f"{r}" for k, r in enumerate(ratios)])
            law = f'type = "phases", knots_deg = {angles}, ratios = [{values}]'
        case "rows":
            law = f'type = "table", phi1_deg = {angles}, ratio = {[1 + 0.3 * w for w in waves]}'
        case _:
            # so small that all centrodes are convex
            cosines = [0.1 * math.sin(k) / k**3 for k in range(1, count + 1)]
            law = f'type = "fourier", cosines = {cosines}'
    return PAIR.format(law=law, teeth=teeth, module=module)
