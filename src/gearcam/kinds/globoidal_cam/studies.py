"""The studies of globoidal cams."""

from __future__ import annotations

from typing import Final

from gearcam.kinds.shared import accuracy_study

STUDIES: Final = {one.name: one for one in (accuracy_study(),)}
"""Studies by name."""
