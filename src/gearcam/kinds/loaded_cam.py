"""What results of all cams have for the study of their forces."""

from __future__ import annotations

from abc import abstractmethod
from functools import cached_property
from typing import TYPE_CHECKING, Any

from gearcam.results.staged import Staged

if TYPE_CHECKING:
    from collections.abc import Sequence

    from gearcam.laws.program import Program
    from gearcam.mechanics.driver_axis import DriverAxis
    from gearcam.mechanics.statics import Touch
    from gearcam.numeric.arrays import Array


class LoadedCam(Staged):
    """Result of a cam whose forces can be computed (see `gearcam.kinds.under_load`)."""

    design: Any
    cam: Any
    """Its first motion has the follower, and the program of its lift."""

    @cached_property
    @abstractmethod
    def program(self) -> Program:
        """The lift over a turn or travel."""

    @cached_property
    @abstractmethod
    def touches(self) -> Sequence[Touch]:
        """Where the cam can press on its follower."""

    @property
    @abstractmethod
    def follower_spec(self) -> Any:
        """The table of the follower."""

    @property
    @abstractmethod
    def driver(self) -> DriverAxis:
        """Name and unit of the cam's angle or travel in output."""

    @property
    def follower(self) -> Any:
        """The follower; for conjugate cams that on the first."""
        return self.cam.motions[0].follower

    @cached_property
    @abstractmethod
    def places_under_load(self) -> Array:
        """Positions of the driver that the study of forces looks at, rad or mm."""
