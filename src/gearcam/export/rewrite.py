"""Rewriting one file of the user's, whole or not at all.

The new content is written beside the file under a temporary name, takes its permissions, and is
moved into its place; of a link the file that it leads to is rewritten.

Refused: whatever the disk refuses.

Depends on errors only.
"""

from __future__ import annotations

import os
import shutil
import uuid
from contextlib import suppress
from pathlib import Path

from gearcam.errors import WriteError
from gearcam.export.write import TEMPORARY


def rewrite(file: str | os.PathLike[str], content: bytes) -> None:
    """Give an existing file another content.

    Parameters
    ----------
    file : path
        Its name.
    content : bytes
        What it shall hold.

    Raises
    ------
    WriteError
        If the disk refuses; the file is as it was then.
    """
    target = Path(file).resolve()
    spare = target.with_name(f"{TEMPORARY}{uuid.uuid4().hex}.tmp")
    try:
        spare.write_bytes(content)
        shutil.copymode(target, spare)
        spare.replace(target)
    except OSError as error:
        raise WriteError(f"cannot write to {file}: {error.strerror or error}") from error
    finally:
        with suppress(OSError):
            spare.unlink()
