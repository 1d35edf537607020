"""The sides of a comparison: a source tree, and a process that builds designs with it."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tarfile
import tempfile
from collections import deque
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from io import BytesIO
from pathlib import Path
from typing import Any, Final, NoReturn

ROOT: Final = Path(__file__).resolve().parents[1]
WORKER: Final = Path(__file__).with_name("compare_worker.py")
SAFE: Final[dict[str, Any]] = {"filter": "data"} if hasattr(tarfile, "data_filter") else {}
"""How archives are unpacked: Python knows filters from 3.11.4 on."""

GALLERY: Final = "profiles"


class Side:
    """A process that builds designs with the source of one tree.

    Parameters
    ----------
    tree : Path
        Folder that contains ``src``.
    folder : Path
        Folder of its designs.
    limit : float, s
        CPU time allowed for a design.
    """

    def __init__(self, tree: Path, folder: Path, limit: float) -> None:
        self.tree, self.folder, self.limit = tree, folder, limit
        self.pending: deque[dict[str, str]] = deque()
        self.seconds = 0.0
        self.folder.mkdir(parents=True, exist_ok=True)
        self.log = self.folder / "stderr"
        self._start()

    def _start(self) -> None:
        env = {**os.environ, "PYTHONPATH": str(self.tree / "src"), "PYTHONHASHSEED": "0"}
        command = [sys.executable, str(WORKER), str(self.limit)]
        with self.log.open("w") as log:
            self.process = subprocess.Popen(
                command,
                cwd=self.folder,
                env=env,
                text=True,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=log,
            )
        ready = self._line()
        if ready is None or not Path(ready["gearcam"]).is_relative_to(self.tree / "src"):
            self.stop()
            words = self.log.read_text() if ready is None else f"{ready['gearcam']} runs instead"
            complain(f"{self.tree}/src does not run\n{words}")
        for task in self.pending:
            self._send(task)

    def _line(self) -> dict[str, Any] | None:
        line = self.process.stdout.readline() if self.process.stdout else ""
        return json.loads(line) if line else None

    def _send(self, task: dict[str, str]) -> None:
        with suppress(BrokenPipeError):  # of a crash, which answer() handles
            if self.process.stdin:
                self.process.stdin.write(json.dumps(task) + "\n")
                self.process.stdin.flush()

    def ask(self, file: Path, out: Path) -> None:
        """Send a design `file` to be built into the folder `out`."""
        self.pending.append({"file": file.name if file.parent == self.folder else str(file),
                             "out": str(out)})  # fmt: skip
        self._send(self.pending[-1])

    def answer(self) -> dict[str, Any]:
        """Return the outcome of the oldest design; restart the process if it crashed."""
        found = self._line()
        self.pending.popleft()
        if found is None:
            found = {"end": f"crash {self.process.wait()}", "seconds": 0.0}
            self.stop()
            self._start()
        self.seconds += found["seconds"]
        return found

    def stop(self) -> None:
        """End the process."""
        with suppress(BrokenPipeError), self.process:  # discard a pending request
            self.process.kill()


def complain(words: str) -> NoReturn:
    """Print why nothing can be compared, and exit."""
    print(words, file=sys.stderr)
    raise SystemExit(2)


@contextmanager
def tree_of(base: str) -> Iterator[Path]:
    """Yield a folder with the source of a commit, or the folder `base` itself."""
    if (Path(base) / "src").is_dir():
        yield Path(base).resolve()
        return
    command = ["git", "archive", base, "src", GALLERY]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, check=False)
    if done.returncode:
        complain(f"{base}: {done.stderr.decode().strip()}")
    with tempfile.TemporaryDirectory(prefix="base-") as folder:
        with tarfile.open(fileobj=BytesIO(done.stdout)) as archive:
            archive.extractall(folder, **SAFE)
        yield Path(folder).resolve()
