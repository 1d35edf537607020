"""Nothing that nobody asks for: drafts and rows of sweeps against an older commit."""

from __future__ import annotations

from contextlib import ExitStack

from before_cases import alternately, child, ratio_of, tree_of
from measuring import ROOT, Result

BEFORE = "25aaf740"
"""The commit before drafts, records and searches left out what nobody asks for."""

CHILD = """
import json, sys, time
import gearcam
from gearcam.numeric.arrays import keep_freed_memory
from gearcam.view.numbers import numbers
from gearcam.view.work import follow
keep_freed_memory()
count = 0

def draft(name, key):
    path = f"profiles/{name}.toml"
    text = open(path, encoding="utf-8").read()
    value = numbers(text)[key] * (1.0 + 1e-4 * count)
    start = time.process_time()
    reply = follow(text, path, {key: value}, key, False)
    seconds = time.process_time() - start
    if json.loads(reply)["error"]:
        sys.exit(json.loads(reply)["error"])
    return seconds

def row(name, key):
    design = gearcam.load(f"profiles/{name}.toml")
    start = time.process_time()
    gearcam.build(design).record()
    return time.process_time() - start

for line in sys.stdin:
    what, name, key = line.split()
    count += 1
    print({"draft": draft, "row": row}[what](name, key), flush=True)
"""
CASES = {
    "draft plate_cam_offset_roller cam.prime_radius_mm": ("(zo) A draft of a disc cam", 0.75),
    "draft nail_machine_two_phase pair.center_distance_mm": ("(zp) A draft of a pair", 0.9),
    "draft nail_machine_slide crank[0].length_mm": ("(zq) A draft of a machine", 0.5),
    "draft cylinder_cam motion[0].lift_mm": ("(zr) A draft of a cylinder cam", 0.5),
    "draft globoidal_indexer turret.reach_mm": ("(zs) A draft of a globoidal cam", 0.15),
    "row ellipse -": ("(zt) A row of a sweep, ellipse", 0.8),
    "row nail_machine_two_phase -": ("(zu) A row of a sweep, nail machine", 0.9),
    "row cylinder_cam -": ("(zv) A row of a sweep, cylinder cam", 0.75),
}
"""Cases with title and largest ratio allowed."""
NOTE = f"""\
Processor time, both sides alternately; before: commit {BEFORE}. Drafts have three charts, which
those of that commit do not have; rows have no estimated errors, which those of that commit have."""


def of_what_is_asked(tries: int = 9) -> list[Result]:
    """(zo) to (zv) Drafts of the live view and rows of sweeps."""
    results = []
    with ExitStack() as stack:
        trees = {"before": stack.enter_context(tree_of(BEFORE)), "now": ROOT}
        sides = {
            name: stack.enter_context(
                child(CHILD, PYTHONPATH=str(tree / "src"), OPENBLAS_NUM_THREADS="1")
            )
            for name, tree in trees.items()
        }
        for case, (title, asked) in CASES.items():
            results.append(ratio_of(title, asked, alternately(sides, case, tries), NOTE))
    return results
