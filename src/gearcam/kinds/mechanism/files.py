"""From the result of a mechanism to the contents of its files: one function a format."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, Final

from gearcam.report.file import report_files

if TYPE_CHECKING:
    from gearcam.kinds.mechanism.build import MechanismResult

Files = dict[str, bytes]


def _tables(result: MechanismResult, _: Any) -> Files:
    """Return the motion as a table.

    Files: motion.csv.

    The master's angle in degrees, and for each output its value and its derivatives by that angle,
    in rad; with a speed also those by time.
    """
    from gearcam.export.table import table_bytes

    return {"motion.csv": table_bytes(result.motion())}


FILES: Final[Mapping[str, Callable[..., Files]]] = {"csv": _tables, "report": report_files}
"""What makes the files of each format: contents by name."""
