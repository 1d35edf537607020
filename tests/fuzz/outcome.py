"""The trial of a design and its outcome."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

BUILT: Final = "built"
REFUSED: Final = "refused"
WRONG: Final = "invalid"
FAILED: Final = "failed"

LATE: Final = "time"
"""The kind of failure of a trial that takes too long."""


@dataclass(frozen=True, kw_only=True)
class Task:
    """A design to try, with the additional checks to run.

    Parameters
    ----------
    files : mapping of str to str
        Texts by file name, the design file first.
    doubt, follow : bool
        Whether to compare the result with other methods; whether to search and build remedies.
    """

    files: Mapping[str, str]
    doubt: bool = False
    follow: bool = False


@dataclass(frozen=True, kw_only=True)
class Failure:
    """A bug in the program.

    Parameters
    ----------
    kind : str
        Such as ``crash``, ``time``, ``polygon``.
    words : str
        Description.
    place : str
        What distinguishes it from other failures of its kind: an exception with the function that
        raised it, or a file extension.
    """

    kind: str
    words: str
    place: str = ""

    def same(self, other: Failure | None) -> bool:
        """Return whether another failure has the same kind and place."""
        return other is not None and (self.kind, self.place) == (other.kind, other.place)


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """The outcome of a trial.

    Parameters
    ----------
    end : {"built", "refused", "invalid", "failed"}
        How it ended.
    seconds : float, s
        Processor time.
    reason : str
        Reason for the refusal, without its numbers.
    failure : Failure or None
        The bug found.
    doubted : bool
        Whether the result was compared with other methods.
    followed : int
        Number of remedies built.
    """

    end: str
    seconds: float = 0.0
    reason: str = ""
    failure: Failure | None = None
    doubted: bool = False
    followed: int = 0
