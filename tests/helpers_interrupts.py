"""Runs commands that send signals to themselves, each at a named place, and tells what came of it.

``python -m helpers_interrupts FOLDER CASE ...`` prints a line of JSON for each case. It is a
process of its own: a signal that nobody answers ends it, and the tests that read its lines fail.
"""

from __future__ import annotations

import contextlib
import importlib
import io
import json
import os
import signal
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

PAIR = """\
kind = "gear-pair"
name = "pair"
[law]
type = "ellipse"
eccentricity = {eccentricity}
[pair]
module_mm = 2
teeth = [22, 22]
[blank]
bore_diameter_mm = {bore}
[meshing]
steps = 48
[output]
files = {files}
"""
CAM = """\
kind = "cam"
name = "cam"
[[motion]]
type = "rise"
law = "cycloidal"
angle_deg = 180
lift_mm = 5
[[motion]]
type = "return"
law = "cycloidal"
angle_deg = 180
lift_mm = 5
[follower]
type = "roller"
roller_radius_mm = 6
[cam]
prime_radius_mm = 40
[output]
files = ["csv"]
"""

BUILD = ("build", "pair.toml")
MESH = ("mesh", "pair.toml")
COMPARE = ("compare", "pair.toml", "--set", "law.eccentricity=0.1,0.15")
FOLLOW = ("follow", "cam.toml", "profile.csv")
ACCURACY = ("accuracy", "pair.toml", "--stage", "law", "--repeat", "1")
WRITE, MOVE = "pathlib.Path.write_bytes", "os.replace"

BEFORE, AFTER = "before", "after"
CASES: dict[str, tuple[tuple[str, ...], str, int, str]] = {
    # the command, what it calls when the signal comes, the how manyth call, which state is left
    "reading": (BUILD, "gearcam.designs.reader.read", 1, BEFORE),
    "law": (BUILD, "gearcam.kinds.gear_pair.made.make_pair", 1, BEFORE),
    "outline": (BUILD, "gearcam.kinds.gear_pair.made.make_gear", 2, BEFORE),
    "checks": (BUILD, "gearcam.kinds.gear_pair.result.run_checks", 1, BEFORE),
    "parts": (BUILD, "gearcam.kinds.gear_pair.parts.make_part", 2, BEFORE),
    "files": (BUILD, "gearcam.export.table.table_bytes", 1, BEFORE),
    "first write": (BUILD, WRITE, 1, BEFORE),
    "last write": (BUILD, WRITE, 4, BEFORE),
    "stale file": (BUILD, MOVE, 1, AFTER),
    "first move": (BUILD, MOVE, 2, AFTER),
    "second move": (BUILD, MOVE, 3, AFTER),
    "last move": (BUILD, MOVE, 9, AFTER),
    "clearing": (BUILD, "shutil.rmtree", 1, AFTER),
    "telling": (BUILD, "gearcam.commands.all_lines", 1, AFTER),
    "remedies": (("build", "refused.toml"), "gearcam.commands.remedies", 1, BEFORE),
    "second file": (("build", "cam.toml", "pair.toml"), "gearcam.designs.reader.read", 2, BEFORE),
    "check, writing": (("check", "pair.toml"), WRITE, 1, BEFORE),
    "mesh, no step": (MESH, "gearcam.meshing.study._block", 1, BEFORE),
    "mesh, some steps": ((*MESH, "--steps", "125"), "gearcam.meshing.study._block", 2, AFTER),
    "mesh, writing": (MESH, WRITE, 2, BEFORE),
    "compare": (COMPARE, "gearcam.compare.variants._built", 2, BEFORE),
    "compare, writing": (COMPARE, WRITE, 1, BEFORE),
    "follow": (FOLLOW, "gearcam.kinds.cam.given_profile.follow", 1, BEFORE),
    "follow, writing": (FOLLOW, WRITE, 1, BEFORE),
    "accuracy": (ACCURACY, "gearcam.results.accuracy._first_round", 1, BEFORE),
    "accuracy, writing": (ACCURACY, WRITE, 2, BEFORE),
    "new": (("new", "cam", "new.toml"), "gearcam.designs.template.template", 1, BEFORE),
    "new, writing": (("new", "cam", "new.toml"), "pathlib.Path.open", 1, AFTER),
    "laws": (("laws",), "gearcam.console._law_lines", 2, BEFORE),
    "schema": (("schema",), "gearcam.designs.schema.schema", 1, BEFORE),
}
EVERY = ("reading", "last write", "second move", "mesh, some steps")
"""Cases that are run with each signal; the others with SIGTERM."""


@contextlib.contextmanager
def sending(number: int, target: str, call: int) -> Iterator[list[int]]:
    """Have a function send a signal at a call of it, and go on; yield its calls."""
    owner, _, name = target.rpartition(".")
    try:
        place: Any = importlib.import_module(owner)
    except ModuleNotFoundError:
        module, _, kind = owner.rpartition(".")
        place = getattr(importlib.import_module(module), kind)
    real: Callable[..., Any] = getattr(place, name)
    calls: list[int] = []

    def hooked(*arguments: Any, **options: Any) -> Any:
        calls.append(1)
        if len(calls) == call:
            signal.raise_signal(number)
        return real(*arguments, **options)

    setattr(place, name, hooked)
    try:
        yield calls
    finally:
        setattr(place, name, real)


def state(folder: Path) -> dict[str, str]:
    """Every file below a folder, hidden ones too, but for what runs."""
    return {
        place.relative_to(folder).as_posix(): place.read_bytes().hex()
        for place in sorted(folder.rglob("*"))
        if place.is_file()
    }


def prepare(cases: list[str]) -> None:
    from gearcam.cli import main

    pair = PAIR.replace("{bore}", "8")
    first = pair.format(eccentricity=0.3, files='["csv", "svg"]')
    Path("pair.toml").write_text(first)
    Path("cam.toml").write_text(CAM)
    assert main(["build", "pair.toml", "cam.toml"]) == 0
    Path("profile.csv").write_bytes(Path("output/cam/profile.csv").read_bytes())
    Path("pair.toml").write_text(pair.format(eccentricity=0.2, files='["csv"]'))
    refused = pair.replace("= 8", "= 90").replace('"pair"', '"refused"')
    Path("refused.toml").write_text(refused.format(eccentricity=0.2, files='["csv"]'))
    # what loads libraries does so here, not where calls are counted
    Path("warm").mkdir()
    commands = {CASES[case][0][0] for case in cases}
    for words in (BUILD, COMPARE, MESH, FOLLOW, ACCURACY):
        if words[0] not in commands:
            continue
        assert main([*words, "-o", "warm"]) in (0, 1), words
    assert main(["new", "cam", "warm/new.toml"]) == 0  # looks for what other packages bring


def run(name: str, signal_name: str, home: Path) -> dict[str, Any]:
    """Run a case in the state of `home`, in a copy of it."""
    import shutil

    from gearcam.cli import main

    words, target, call, left = CASES[name]
    place = home.parent / "run"
    shutil.rmtree(place, ignore_errors=True)
    shutil.copytree(home, place)
    os.chdir(place)
    out, err, before = io.StringIO(), io.StringIO(), state(place)
    number = getattr(signal, signal_name)
    with (
        contextlib.redirect_stdout(out),
        contextlib.redirect_stderr(err),
        sending(number, target, call) as calls,
    ):
        code = main(list(words))
    after = state(place)
    return {
        "case": name, "signal": signal_name, "left": left, "code": code, "sent": len(calls) >= call,
        "out": out.getvalue(), "err": err.getvalue(),
        "files": sorted(after), "changed": sorted(
            key for key in {*before, *after} if before.get(key) != after.get(key)
        ),
        "listed": json.loads(Path("output/pair/summary.json").read_bytes())["files"],
        "answered": signal.getsignal(number) not in (signal.SIG_DFL, signal.default_int_handler),
    }  # fmt: skip


if __name__ == "__main__":
    # whoever runs the tests may have it ignored, as nohup does, and the command would heed that
    signal.signal(signal.SIGHUP, signal.SIG_DFL)
    home = Path(sys.argv[1]) / "home"
    home.mkdir()
    os.chdir(home)
    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
        prepare(sys.argv[2:])
    for case in sys.argv[2:]:
        for one in ("SIGTERM", "SIGINT", "SIGHUP") if case in EVERY else ("SIGTERM",):
            print(json.dumps(run(case, one, home)), flush=True)
