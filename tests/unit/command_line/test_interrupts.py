"""A signal at any stage of any command: a message, its exit code, and all files old or all new."""

from __future__ import annotations

import contextlib
import json
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path
from typing import Any

import pytest

import helpers_interrupts
from gearcam.base.interrupts import SIGNALS, interruptible, unbroken
from gearcam.view.workers import Workers
from helpers_interrupts import AFTER, BEFORE, CASES, EVERY, PAIR
from helpers_processes import ENVIRONMENT
from helpers_sampling import chosen

CODES = {"SIGINT": 130, "SIGTERM": 143, "SIGHUP": 129}
OUTLINES = {"centrodes.csv", "gear1_outline.csv", "gear2_outline.csv"}
NEW = {
    # what has changed where a command was not stopped before it was done
    "build": {f"output/pair/{name}" for name in (*OUTLINES, "pair.svg", "summary.json")},
    "mesh": {"output/pair/meshing.csv", "output/pair/summary.json"},
    "new": {"new.toml"},
}

QUICK = ("reading", "outline", "last write", "second move", "clearing", "new, writing", "schema")
"""Stages at which a signal comes each time."""


@pytest.fixture(scope="module")
def told(
    tmp_path_factory: pytest.TempPathFactory, request: pytest.FixtureRequest
) -> dict[tuple[str, str], dict[str, Any]]:
    """What came of each case that is asked for, by its name and signal."""
    folder = str(tmp_path_factory.mktemp("cases"))
    items: list[Any] = [one for one in request.session.items if one.path == request.path]
    asked = [one.callspec.params["case"] for one in items if "told" in one.fixturenames]
    command = [sys.executable, helpers_interrupts.__file__, folder, *asked]
    done = subprocess.run(
        command, env=ENVIRONMENT, capture_output=True, text=True, check=False, timeout=300
    )
    assert (done.returncode, done.stderr) == (0, "")
    lines = [json.loads(line) for line in done.stdout.splitlines()]
    return {(line["case"], line["signal"]): line for line in lines}


@pytest.mark.parametrize("case", chosen(CASES.keys(), *QUICK))
def test_a_signal_leaves_all_files_old_or_all_new(
    case: str, told: dict[tuple[str, str], dict[str, Any]]
) -> None:
    (command, *_), _, _, left = CASES[case]
    for name in CODES if case in EVERY else ("SIGTERM",):
        found = told[case, name]
        assert found["sent"], "the stage was never reached"
        assert found["code"] == CODES[name]
        assert "interrupted: " in found["err"]
        assert "Traceback" not in found["err"]
        assert not found["answered"], "the signal is still answered by the command"
        assert not [file for file in found["files"] if ".gearcam-" in file]
        changed = {file for file in found["changed"] if not file.startswith("output/cam/")}
        assert changed == (NEW[command] if left == AFTER else set())
        there = {file for file in found["files"] if file.startswith("output/pair/")}
        listed = {f"output/pair/{file}" for file in (*found["listed"], "summary.json")}
        # what a study leaves beside files of another state is listed as stale
        assert there == listed or (command == "mesh" and listed < there)


def test_the_stages_are_not_reached_by_chance() -> None:
    """Each command that writes or reads is stopped somewhere, and before it has written."""
    commands = {words[0] for words, *_ in CASES.values()}
    assert commands == {
        *("build", "check", "mesh", "compare", "follow", "accuracy"),
        *("new", "laws", "schema"),
    }
    assert {words[0] for words, *_, left in CASES.values() if left == BEFORE} == commands


def test_signals_wait_until_what_must_not_be_broken_is_done() -> None:
    done: list[str] = []

    def work() -> None:
        with unbroken():
            for number in SIGNALS:
                signal.raise_signal(number)
            done.append("unbroken")
        done.append("never")

    with interruptible() as ended:
        with pytest.raises(KeyboardInterrupt):
            work()
        assert done == ["unbroken"]
        assert ended.number in SIGNALS
        assert ended.number is not None
        assert ended.code(130) == 128 + ended.number
    assert signal.getsignal(signal.SIGTERM) is signal.SIG_DFL


def test_a_signal_that_comes_by_another_thread_waits_too() -> None:
    """No mask of this thread keeps it back."""
    done, free = list[str](), threading.Event()

    def work() -> None:
        with unbroken():
            os.kill(os.getpid(), signal.SIGTERM)
            time.sleep(0.05)
            done.append("unbroken")
        done.append("never")

    thread = threading.Thread(target=free.wait)
    thread.start()
    try:
        with interruptible(), pytest.raises(KeyboardInterrupt):
            work()
    finally:
        free.set()
        thread.join()
    assert done == ["unbroken"]


def test_a_handler_that_somebody_has_chosen_stays() -> None:
    """Such as that of ``nohup``, which has a closed terminal be ignored."""
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        with contextlib.suppress(KeyboardInterrupt), interruptible() as ended, unbroken():
            signal.raise_signal(signal.SIGHUP)
        assert ended.number is None
        assert ended.code(0) == 0
        assert signal.getsignal(signal.SIGHUP) is signal.SIG_IGN
    finally:
        signal.signal(signal.SIGHUP, before)


def test_other_threads_neither_answer_nor_hold_signals() -> None:
    found: list[Any] = []

    def work() -> None:
        with interruptible() as ended, unbroken():
            found.append((ended.number, signal.getsignal(signal.SIGTERM)))

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert found == [(None, signal.getsignal(signal.SIGTERM))]


def test_what_begins_within_answers_no_signal() -> None:
    """A worker that Ctrl-C reaches while it is loaded would show where it was."""
    words = "import signal; print(len(signal.pthread_sigmask(signal.SIG_BLOCK, [])))"
    with unbroken():
        within = subprocess.run([sys.executable, "-c", words], capture_output=True, check=True)
    later = subprocess.run([sys.executable, "-c", words], capture_output=True, check=True)
    assert (int(within.stdout), int(later.stdout)) == (len(SIGNALS), 0)


def test_ctrl_c_while_the_command_is_loaded(tmp_path: Path) -> None:
    (tmp_path / "gearcam_loads.py").write_text(
        "import signal, sys\n"
        "class Finder:\n"
        "    def find_spec(self, name, *_):\n"
        "        if name == 'gearcam.cli':\n"
        "            signal.raise_signal(signal.SIGINT)\n"
        "sys.meta_path.insert(0, Finder())\n"
        "from gearcam.__main__ import main\n"
        "raise SystemExit(main())\n"
    )
    command = [sys.executable, str(tmp_path / "gearcam_loads.py")]
    done = subprocess.run(command, env=ENVIRONMENT, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (130, "")
    assert done.stderr == "interrupted\n"


@pytest.mark.slow
@pytest.mark.parametrize(("name", "code"), [("SIGINT", 0), ("SIGTERM", 143), ("SIGHUP", 129)])
def test_the_view_ends_its_workers_at_once(tmp_path: Path, name: str, code: int) -> None:
    """Ctrl-C is how a view ends; a worker that is in the middle of a build is not waited for."""
    pair = PAIR.format(eccentricity=0.3, bore=8, files="[]")
    (tmp_path / "pair.toml").write_text(pair.replace("[22, 22]", "[3000, 3000]"))
    command = [sys.executable, "-m", "gearcam", "view", "--no-browser", "pair.toml"]
    process = subprocess.Popen(
        command, cwd=tmp_path, env=ENVIRONMENT, text=True,
        stdout=subprocess.PIPE, stderr=subprocess.PIPE,
    )  # fmt: skip
    assert process.stdout
    assert "live view at" in process.stdout.readline()
    children = Path(f"/proc/{process.pid}/task/{process.pid}/children")
    end = time.monotonic() + 60.0
    # one of them tracks what processes share
    while len(workers := children.read_text().split()) < 2 and time.monotonic() < end:
        time.sleep(0.02)
    process.send_signal(getattr(signal, name))
    out, err = process.communicate(timeout=15)
    assert (process.returncode, out, err) == (code, "the live view has ended\n", "")
    assert len(workers) > 1
    while any(map(_runs, workers)) and time.monotonic() < end:
        time.sleep(0.02)
    assert not any(map(_runs, workers))


@pytest.mark.slow
def test_workers_that_are_writing_replies_end_at_once() -> None:
    """The thread that reads the replies does not wait for the rest of one."""
    for number in range(24):
        workers = Workers()
        assert workers.submit(bytes, 1).result() == b"\0"
        for _ in range(3):
            workers.submit(bytes, 80_000_000)
        reader = vars(workers._pool)["_executor_manager_thread"]
        time.sleep(0.03 + 0.002 * number)  # some are in the middle of a reply
        workers.end()
        reader.join(10.0)
        assert not reader.is_alive()


def _runs(process: str) -> bool:
    """Whether a process is there, and no corpse that nobody has asked after."""
    try:
        state = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0]
    except OSError:
        return False
    return state != "Z"
