"""The kinds of design: each a folder that holds all that only it needs.

What a folder has, and how it is found, `gearcam.designs.kind` says; nothing outside this package
names one of them. Type checkers do not look into folders: they are told here of what is public.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from gearcam.kinds.cam.public import *  # noqa: F403
    from gearcam.kinds.gear_pair.public import *  # noqa: F403
