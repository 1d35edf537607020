"""What is tried of a design, and how that ended."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

BUILT: Final = "built"
REFUSED: Final = "refused"
WRONG: Final = "refused by reading"
FAILED: Final = "failed"

LATE: Final = "time"
"""The kind of failure of what takes too long."""


@dataclass(frozen=True, kw_only=True)
class Task:
    """A design that is to be tried: its `files`, and what is done beside building it.

    Parameters
    ----------
    files : mapping of str to str
        Texts by file name: the design file first.
    doubt, follow : bool
        Whether a study by other means is held against it; whether remedies are searched and
        built.
    """

    files: Mapping[str, str]
    doubt: bool = False
    follow: bool = False


@dataclass(frozen=True, kw_only=True)
class Failure:
    """What is wrong with the program.

    Parameters
    ----------
    kind : str
        Such as ``crash``, ``time``, ``polygon``.
    words : str
        What happened.
    place : str
        What tells it from other failures of its kind: an exception with the function that raised
        it, the name of a file.
    """

    kind: str
    words: str
    place: str = ""

    def same(self, other: Failure | None) -> bool:
        """Whether another failure is this one."""
        return other is not None and (self.kind, self.place) == (other.kind, other.place)


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """How the trial of a design ended.

    Parameters
    ----------
    end : {"built", "refused", "refused by reading", "failed"}
        How.
    seconds : float, s
        Processor time.
    reason : str
        Why it was refused, without its numbers.
    failure : Failure or None
        What went wrong.
    doubted : bool
        Whether a study by other means was held against it.
    followed : int
        Suggested changes that were built.
    """

    end: str
    seconds: float = 0.0
    reason: str = ""
    failure: Failure | None = None
    doubted: bool = False
    followed: int = 0
