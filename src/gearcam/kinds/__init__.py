"""The kinds of design, each in a folder with everything specific to it, and `build` for all.

`gearcam.designs.kind` describes the modules of a folder and finds the folders; no code outside this
package names one. The imports below declare the public names for type checkers, the signatures of
`build` which result belongs to which design.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, overload

if TYPE_CHECKING:
    from gearcam.base.tolerances import Tolerances
    from gearcam.designs import Design
    from gearcam.kinds.cam.public import *  # noqa: F403
    from gearcam.kinds.cam.public import CamDesign, CamResult
    from gearcam.kinds.gear_pair.public import *  # noqa: F403
    from gearcam.kinds.gear_pair.public import GearPairDesign, GearPairResult
    from gearcam.kinds.globoidal_cam.public import *  # noqa: F403
    from gearcam.kinds.globoidal_cam.public import GloboidalCamDesign, GloboidalCamResult
    from gearcam.kinds.mechanism.parts import *  # noqa: F403
    from gearcam.kinds.mechanism.public import *  # noqa: F403
    from gearcam.kinds.mechanism.public import MechanismDesign, MechanismResult
    from gearcam.kinds.spatial_cam.public import *  # noqa: F403
    from gearcam.kinds.spatial_cam.public import SpatialCamDesign, SpatialCamResult


@overload
def build(design: CamDesign, tolerances: Tolerances | None = None) -> CamResult: ...
@overload
def build(design: GearPairDesign, tolerances: Tolerances | None = None) -> GearPairResult: ...
@overload
def build(
    design: GloboidalCamDesign, tolerances: Tolerances | None = None
) -> GloboidalCamResult: ...
@overload
def build(design: MechanismDesign, tolerances: Tolerances | None = None) -> MechanismResult: ...
@overload
def build(design: SpatialCamDesign, tolerances: Tolerances | None = None) -> SpatialCamResult: ...
@overload
def build(design: Design, tolerances: Tolerances | None = None) -> Any: ...
def build(design: Design, tolerances: Tolerances | None = None) -> Any:
    """Return the result of a design, which computes values when they are first used.

    Parameters
    ----------
    design : Design
        From `load`, `loads` or `design`.
    tolerances : Tolerances, optional
        Accuracy of the internal computations.

    Returns
    -------
    Result
        Its class depends on the kind of design. Its attributes raise `InfeasibleError` if what they
        describe cannot be made.

    Raises
    ------
    DesignError
        If the argument is not a design.

    Examples
    --------
    >>> import gearcam as gc
    >>> result = gc.build(gc.load("profiles/ellipse.toml"))
    >>> round(result.contact_ratio, 3)
    1.705
    """
    from gearcam.designs import KINDS, Design
    from gearcam.numeric.arguments import instance

    kind = instance("design", design, Design, "a design, as returned by load").kind
    given = () if tolerances is None else (tolerances,)
    return KINDS[kind].result(design, *given)
