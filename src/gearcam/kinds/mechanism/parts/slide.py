"""The table ``[[slide]]``."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from gearcam.kinds.mechanism.asked import Output
from gearcam.kinds.mechanism.keys import Sort, named, point_param, way_of
from gearcam.kinds.mechanism.parts.part import MachinePart, Setting
from gearcam.linkages.elements import Element, MemberPoint, PushedSlide

if TYPE_CHECKING:
    from gearcam.kinds.mechanism.parts.picture import Picture
    from gearcam.linkages.coordinates import PointWay


class PushedPart(MachinePart):
    """A member that is pushed along a guide.

    Parameters
    ----------
    name, joint : str
        Of the member, and of its joint.
    """

    name: str
    joint: str

    @property
    def way(self) -> str:
        """Name of the quantity that is its place on its guide."""
        raise NotImplementedError

    @property
    def guide(self) -> str:
        """Name of its guide."""
        return way_of(self.way)

    def outputs(self) -> Mapping[str, tuple[Output, ...]]:
        """Return its place."""
        return {self.name: (Output(self.name, self.name, self.way, False),)}

    def ways(self) -> Mapping[str, PointWay]:
        """Return its way along its guide, which is that of its joint."""
        from gearcam.linkages.coordinates import PointWay

        way = PointWay(self.joint, self.guide, slide=self.way)
        return dict.fromkeys((self.name, self.joint), way)

    def unturned(self) -> Mapping[str, str]:
        """Return that it keeps its direction."""
        return {self.name: self.joint}


@dataclass(frozen=True, kw_only=True)
class SlideSpec(PushedPart):
    """A member that a drive pushes along a straight guide: a follower, a plate, a rack, a slide.

    Examples
    --------
    >>> import gearcam as gc
    >>> gc.SlideSpec(name="tool", on="cam.follower", joint="T")
    SlideSpec(name='tool', on='cam.follower', joint='T')
    """

    name: str = named(gives=Sort.MEMBER, doc="its name", example="tool")
    on: str = named(
        needs=Sort.WAY,
        doc="what pushes it: cam.follower, cam.plate, pair.rack, or the name of a slide",
        example="cam.follower",
    )
    joint: str = named(gives=Sort.JOINT, doc="name of its joint", example="T")
    at: tuple[float, float] = point_param(
        doc="the joint in the frame of the follower's end, the rack or the slide, x along its way",
        default=(0.0, 0.0),
    )

    def elements(self, setting: Setting, where: str) -> Iterator[Element]:
        """Yield the slide, and its joint beside its place on the guide (see `MachinePart`)."""
        beside = any(self.at)
        joint = f"{self.name}.end" if beside else self.joint
        yield PushedSlide(self.name, self.way, self.guide, joint)
        if beside:
            yield MemberPoint(self.joint, complex(*self.at), self.name)

    @property
    def way(self) -> str:
        """What pushes it."""
        return self.on

    def draw(self, picture: Picture) -> None:
        """Draw its link, and its block unless it is on a follower or a rack, which is drawn."""
        pins = [0j, complex(*self.at)] if any(self.at) else [0j]
        block = () if picture.setting.drawn(self.on) else ((0j, 0.0),)
        picture.member(self.name, *pins, blocks=block)

    def stand(self, picture: Picture) -> None:
        """Draw its guide, unless a follower or a rack goes along it."""
        if not picture.setting.drawn(self.on):
            picture.way(self.guide)
