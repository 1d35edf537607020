"""The trial of one design: read it, build it, write and check its files, build its remedies."""

from __future__ import annotations

import re
import shutil
import time
import traceback
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Final

import gearcam
from fuzz import (
    cross_checks_cam,
    cross_checks_globoidal,
    cross_checks_mechanism,
    cross_checks_pair,
    cross_checks_spatial,
)
from fuzz.oracles import look_at
from fuzz.outcome import BUILT, FAILED, REFUSED, WRONG, Failure, Outcome, Task
from gearcam import build, load, remedies
from gearcam.base.errors import DesignError, InfeasibleError
from gearcam.console import all_lines, refusal_text, remedy_lines

SEARCH: Final = 0.6
"""Patience of the search for remedies, s: enough for a few designs."""

_SHOWN: Final = 500
"""Characters of an exception that are reported."""

_HOMES: Final = {Path(gearcam.__file__).parent, Path(__file__).parent}

_CROSS_CHECKS: Final = {
    "cam": cross_checks_cam.doubts,
    "gear-pair": cross_checks_pair.doubts,
    "globoidal-cam": cross_checks_globoidal.doubts,
    "mechanism": cross_checks_mechanism.doubts,
    "spatial-cam": cross_checks_spatial.doubts,
}
"""What other methods say against the result of a design, by its kind."""


class FaultError(Exception):
    """A bug in the program was found."""

    def __init__(self, failure: Failure) -> None:
        self.failure = failure
        super().__init__(failure.words)


def tried(task: Task, folder: Path) -> Outcome:
    """Return the outcome of a `task`, tried in an empty `folder`."""
    return Trial(task, folder).run()


@dataclass
class Trial:
    """The trial of a design.

    Parameters
    ----------
    task : Task
        The design and the additional checks.
    folder : Path
        An empty folder.
    doubted : bool
        Whether the result was compared with other methods.
    followed : int
        Number of remedies built.
    """

    task: Task
    folder: Path
    doubted: bool = False
    followed: int = 0

    def run(self) -> Outcome:
        """Run the trial and return its outcome."""
        start = time.process_time()
        reason, failure = "", None
        try:
            end, reason = self._end()
        except FaultError as fault:
            end, failure = FAILED, fault.failure
        except Exception as error:
            kind = "memory" if isinstance(error, MemoryError) else "crash"
            words = f"{type(error).__name__}: {error}"
            end, failure = FAILED, Failure(kind=kind, words=words[:_SHOWN], place=_place(error))
        return Outcome(
            end=end,
            seconds=time.process_time() - start,
            reason=reason,
            failure=failure,
            doubted=self.doubted,
            followed=self.followed,
        )

    def _end(self) -> tuple[str, str]:
        """Return the end of the trial and the reason; raise `FaultError` for a bug."""
        for name, text in self.task.files.items():
            (self.folder / name).write_text(text, encoding="utf-8")
        file = str(self.folder / next(iter(self.task.files)))
        try:
            result: Any = build(load(file))
        except DesignError as error:
            return WRONG, _told(error, file, error.problems[0].message)
        try:
            written = result.write(self.folder / "out")
        except InfeasibleError as error:
            self._follow(result, error)
            return REFUSED, _told(error, file, error.what)
        except DesignError as error:
            return WRONG, _told(error, file, error.problems[0].message)
        list(all_lines(written))
        self._hold(look_at(result, written))
        if self.task.doubt:
            self._doubt(result)
        if any(one.severity == "error" for one in written.findings):
            self._follow(result, None)
        return BUILT, ""

    def _hold(self, found: Any) -> None:
        for failure in found:
            raise FaultError(failure)

    def _doubt(self, result: Any) -> None:
        self.doubted = True
        self._hold(
            Failure(kind="contradiction", words=words, place=place)
            for place, words in _CROSS_CHECKS[result.design.kind](result)
        )

    def _follow(self, result: Any, refusal: InfeasibleError | None) -> None:
        """Build the remedies, with all their files."""
        if not self.task.follow:
            return
        found = remedies(result, refusal, patience=SEARCH)
        list(remedy_lines(found))
        for remedy in found.found:
            shutil.rmtree(self.folder / "out", ignore_errors=True)
            try:
                other: Any = build(remedy.design)
                written = other.write(self.folder / "out")
            except (DesignError, InfeasibleError) as error:
                words = f"with {remedy.text} it should be built: {error}"
                raise FaultError(Failure(kind="remedy", words=words)) from error
            if any(one.severity == "error" for one in written.findings):
                words = f"with {remedy.text} it should have no error"
                raise FaultError(Failure(kind="remedy", words=words))
            self._hold(
                replace(one, words=f"with {remedy.text} {one.words}")
                for one in look_at(other, written)
            )
            self.followed += 1


def _told(error: DesignError | InfeasibleError, file: str, words: str) -> str:
    """Return the reason of a refusal with its numbers and names replaced by placeholders."""
    refusal_text(error, file, BUILT)
    told = re.sub(r"\"[^\"]*\"|'[^']*'", "...", words.splitlines()[0])
    return re.sub(r"[-+]?\d[\d.e+-]*", "#", told)[:80]


def _place(error: BaseException) -> str:
    """Return the type of an exception and the innermost function of gearcam in its traceback."""
    frames = traceback.extract_tb(error.__traceback__)
    own = [one for one in frames if _HOMES & {*Path(one.filename).parents}]
    last = own[-1] if own else frames[-1]
    return f"{type(error).__name__} in {Path(last.filename).name}, {last.name}"
