"""The score of a campaign, as it is published: between two marks of a page."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from datetime import date
from pathlib import Path
from typing import Final

from fuzz.campaign import Campaign
from fuzz.outcome import BUILT, FAILED, LATE, REFUSED, WRONG
from fuzz.pool import MEMORY, SECONDS
from gearcam.export.write import rewrite

BEGIN: Final = "<!-- written by make fuzz -->"
END: Final = "<!-- end of what make fuzz writes -->"

COLUMNS: Final = ("right", "refused with a reason", "wrong", "out of time", "crashed")
"""What becomes of designs."""

ALL: Final = "all"
"""The last row."""

_RIGHT, _REFUSED, _WRONG, _LATE, _CRASHED = COLUMNS
_ENDS: Final = {BUILT: _RIGHT, REFUSED: _REFUSED, WRONG: _REFUSED}
_FAILURES: Final = {LATE: _LATE, "crash": _CRASHED, "memory": _CRASHED}
"""Columns of kinds of failures; those of the others are wrong."""

_MORE: Final = 'make fuzz MORE="--count 10000 --seed 2"'


@dataclass(frozen=True, kw_only=True)
class Score:
    """The score of a finished `campaign`, by `version` and `commit` of the program on a `day`.

    Parameters
    ----------
    campaign : Campaign
        All of its designs have been tried.
    version, commit : str
        What was tried.
    day : date
        When, UTC.
    """

    campaign: Campaign
    version: str
    commit: str
    day: date

    def block(self) -> str:
        """Return what stands between the marks."""
        head = ("designs", "tried", *COLUMNS)
        rows = [head, ("---", *["---:"] * (len(head) - 1)), *self._rows()]
        table = [f"| {' | '.join(row)} |" for row in rows]
        return "\n".join([self._caption(), "", *table, *self._failures(), ""])

    def _rows(self) -> Iterator[tuple[str, ...]]:
        table: defaultdict[str, Counter[str]] = defaultdict(Counter)
        for (kind, drawn, end), count in self.campaign.counts.items():
            if end != FAILED:
                table[f"{kind}, {drawn}"][_ENDS[end]] += count
        for one in self.campaign.found:
            column = _FAILURES.get(one.failure.kind, _WRONG)
            table[f"{one.case.kind}, {one.case.meant}"][column] += 1
        # the sum after its parts
        for name, ends in [*sorted(table.items()), (ALL, sum(table.values(), Counter[str]()))]:
            yield name, str(ends.total()), *(str(ends[column]) for column in COLUMNS)

    def _caption(self) -> str:
        seeds = ", ".join(sorted({str(case.seed) for case in self.campaign.cases}))
        return (
            f"gearcam {self.version}, commit {self.commit}, {self.day.isoformat()}: "
            f"{len(self.campaign.cases)} designs, seed {seeds}; for each design at most "
            f"{SECONDS:g} s, a second time if it was not done then, and {MEMORY >> 30} GiB. "
            f"Results compared with other methods: {self.campaign.doubted}. "
            f"Remedies built: {self.campaign.followed}. "
            f"`{_MORE}` tries more and replaces this table."
        )

    def _failures(self) -> Iterator[str]:
        """Yield how each failure is repeated."""
        if self.campaign.found:
            yield ""
        for one in sorted(self.campaign.found, key=lambda one: (one.case.kind, one.case.index)):
            yield f"- {one.failure.kind}: `{one.case.command}`"


def lacks_marks(page: str) -> bool:
    """Return whether a `page` has no single pair of marks, in order."""
    once = page.count(BEGIN) == page.count(END) == 1
    return not once or page.index(BEGIN) > page.index(END)


def with_block(page: str, block: str) -> str:
    """Return a `page` with another `block` between its marks.

    Parameters
    ----------
    page : str
        Its text.
    block : str
        Lines, see `Score.block`.

    Returns
    -------
    str

    Raises
    ------
    ValueError
        If the page has no single pair of marks.
    """
    if lacks_marks(page):
        raise ValueError(f"the page has no single pair of lines {BEGIN} and {END}")
    before, _, rest = page.partition(BEGIN)
    return f"{before}{BEGIN}\n\n{block}\n{END}{rest.partition(END)[2]}"


def publish(path: Path, block: str) -> None:
    """Write a `block` into the page at a `path`, whole or not at all."""
    rewrite(path, with_block(path.read_bytes().decode("utf-8"), block).encode())
