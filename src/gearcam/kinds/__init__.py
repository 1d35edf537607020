"""The kinds of design, each in a folder with everything specific to it.

`gearcam.designs.kind` describes the modules of a folder and finds the folders; no code outside this
package names one. The imports below declare the public names for type checkers.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from gearcam.kinds.cam.public import *  # noqa: F403
    from gearcam.kinds.gear_pair.public import *  # noqa: F403
    from gearcam.kinds.globoidal_cam.public import *  # noqa: F403
    from gearcam.kinds.mechanism.parts import *  # noqa: F403
    from gearcam.kinds.mechanism.public import *  # noqa: F403
    from gearcam.kinds.spatial_cam.public import *  # noqa: F403
