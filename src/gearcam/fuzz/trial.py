"""The trial of one design: read, built, written, doubted, its remedies followed."""

from __future__ import annotations

import re
import shutil
import time
import traceback
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from gearcam import build, load, remedies
from gearcam.console import all_lines, refusal_text, remedy_lines
from gearcam.designs.kind import KINDS
from gearcam.errors import DesignError, InfeasibleError
from gearcam.fuzz.oracles import look_at
from gearcam.fuzz.outcome import BUILT, FAILED, REFUSED, WRONG, Failure, Outcome

SEARCH: Final = 1.0
"""Patience of a search for remedies, s: a few designs."""

_PACKAGE: Final = f"{Path(__file__).parents[1].name}/"


class FaultError(Exception):
    """A fault of the program was found."""

    def __init__(self, failure: Failure) -> None:
        self.failure = failure
        super().__init__(failure.words)


@dataclass
class Trial:
    """A design that is tried.

    Parameters
    ----------
    files : mapping of str to str
        Its texts by file name: the design file first.
    folder : Path
        An empty one.
    doubt : bool
        Whether a study by other means is held against it.
    follow : bool
        Whether remedies are searched, and followed.
    """

    files: Mapping[str, str]
    folder: Path
    doubt: bool = False
    follow: bool = False
    doubted: bool = False
    followed: int = 0

    def run(self) -> Outcome:
        """Return how it ended."""
        start = time.process_time()
        reason, failure = "", None
        try:
            end, reason = self._end()
        except FaultError as fault:
            end, failure = FAILED, fault.failure
        except MemoryError as error:
            end, failure = (
                FAILED,
                Failure(kind="memory", words="out of memory", place=_place(error)),
            )
        except Exception as error:
            words = f"{type(error).__name__}: {error}"
            end, failure = FAILED, Failure(kind="crash", words=words[:500], place=_place(error))
        return Outcome(
            end=end,
            seconds=time.process_time() - start,
            reason=reason,
            failure=failure,
            doubted=self.doubted,
            followed=self.followed,
        )

    def _end(self) -> tuple[str, str]:
        """Return how it ended and why; raise what is a fault."""
        for name, text in self.files.items():
            (self.folder / name).write_text(text, encoding="utf-8")
        file = str(self.folder / next(iter(self.files)))
        try:
            result: Any = build(load(file))
            written = result.write(self.folder / "out")
        except DesignError as error:
            refusal_text(error, file, BUILT)
            return WRONG, _without_numbers(error.problems[0].message)
        except InfeasibleError as error:
            refusal_text(error, file, BUILT)
            self._follow(result, error)
            return REFUSED, _without_numbers(error.what)
        list(all_lines(written))
        self._hold(look_at(result, written))
        if self.doubt:
            self._doubt(result)
        if any(one.severity == "error" for one in written.findings):
            self._follow(result, None)
        return BUILT, ""

    def _hold(self, found: Any) -> None:
        for failure in found:
            raise FaultError(failure)

    def _doubt(self, result: Any) -> None:
        with suppress(ModuleNotFoundError):
            room = KINDS[result.design.kind].room("doubts")
            self.doubted = True
            self._hold(
                Failure(kind="contradiction", words=words, place=place)
                for place, words in room.doubts(result)
            )

    def _follow(self, result: Any, refusal: InfeasibleError | None) -> None:
        """Build what is suggested, with all its files."""
        if not self.follow:
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
            self._hold(look_at(other, written))
            self.followed += 1


def _without_numbers(words: str) -> str:
    """Return what is the same in messages that differ by numbers and by words in quotes."""
    told = re.sub(r"\"[^\"]*\"|'[^']*'", "...", words.splitlines()[0])
    return re.sub(r"[-+]?\d[\d.e+-]*", "#", told)[:80]


def _place(error: BaseException) -> str:
    """Return what was raised and the innermost function of the program that it came through."""
    frames = traceback.extract_tb(error.__traceback__)
    own = [one for one in frames if _PACKAGE in one.filename.replace("\\", "/")]
    last = own[-1] if own else frames[-1]
    return f"{type(error).__name__} in {Path(last.filename).name}, {last.name}"
