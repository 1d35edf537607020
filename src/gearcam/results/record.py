"""Records: the facts of one result as a flat row of a table (`Result.record`)."""

from __future__ import annotations

from gearcam.base.near_names import UnknownNameError
from gearcam.base.two_names import spellings
from gearcam.results.kind import KINDS


class Record(dict[str, float | str]):
    """Plain numbers and texts by dotted names; also found by the keys that facts repeat.

    An unknown name raises a KeyError with the nearest ones, or with the reason why there are none.
    """

    refusal: str = ""
    """Why the design cannot be made."""

    def __missing__(self, name: str) -> float | str:
        kind = str(self.get("kind", ""))
        keys = KINDS[kind].repeated if kind in KINDS else {}
        for one in spellings(keys, name) if isinstance(name, str) else ():
            if one in self:
                return self[one]
        reason = f"this variant was refused: {self.refusal}" if self.refusal else ""
        raise UnknownNameError(name, self, reason)
