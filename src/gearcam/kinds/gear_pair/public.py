"""What people who write Python make pairs of."""

from __future__ import annotations

from typing import Final

from gearcam.gears.spec import PairSpec, Rack, StepsSpec
from gearcam.kinds.gear_pair.design import GearPairDesign, PairOutputSpec
from gearcam.meshing.settings import MeshingSpec
from gearcam.parts.blank import Blank

PUBLIC: Final = (
    GearPairDesign, PairSpec, Rack, Blank, StepsSpec, PairOutputSpec, MeshingSpec
)  # fmt: skip
