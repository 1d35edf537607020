"""What a part of a mechanism finds in its machine."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from gearcam.kinds.mechanism.moved import Moved
    from gearcam.kinds.mechanism.placed import PlacedDrive


class Mover(NamedTuple):
    """A shaft or a slide of a drive: the `drive`, and the `word` behind its name."""

    drive: PlacedDrive
    word: str

    @property
    def moved(self) -> Moved:
        """What is moved."""
        return self.drive.moved[self.word]


class Setting:
    """What a part finds in its machine: what drives move, and the joints that stand still.

    Parameters
    ----------
    standing : mapping of str to complex, mm
        Where the joints are that stand still, by name.
    drives : sequence of PlacedDrive
        Its drives.
    """

    def __init__(self, standing: Mapping[str, complex], drives: Sequence[PlacedDrive]) -> None:
        self.standing = standing
        self.movers = {
            name: Mover(drive, word)
            for drive in drives
            for word in drive.moved
            for name in drive.spec.names_of(word)
        }

    def place(self, name: str) -> complex:
        """Return where a joint that stands still, or a shaft of a drive, is, mm."""
        if name in self.standing:
            return self.standing[name]
        return self.movers[name].drive.machine(self.movers[name].moved.at)

    def drawn(self, name: str) -> str:
        """Return the word for a wheel, a rack, a plate, a cam or its follower that a drive draws.

        Parameters
        ----------
        name : str
            Of the shaft or slide; empty is returned for any other.
        """
        mover = self.movers.get(name)
        if mover is None or mover.drive.result is None:
            return ""
        # of a follower along a cylinder cam only the roller is drawn
        return "" if mover.drive.spec.in_space and mover.moved.along else mover.word
