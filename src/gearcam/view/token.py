"""The token in the address of the page: the same for a file and a port after each start.

It is an HMAC of both by a secret *key* of this user, a file that only the user can read. Where no
such file can be kept, and where the system chooses the port, the token is random: it ends with the
server.
"""

from __future__ import annotations

import hashlib
import hmac
import os
import secrets
import sys
import tempfile
from base64 import urlsafe_b64encode
from contextlib import suppress
from pathlib import Path
from stat import S_IMODE, S_ISREG
from typing import Final

BYTES: Final = 16
"""Length of a token before it is written in letters, bytes."""

_LENGTH: Final = 32
"""Length of the key, bytes."""

_KEY: Final = "view.key"
_OWN: Final = 0o700
_OTHERS: Final = 0o077
"""Rights of a folder, and those that nobody else may have on the key."""


def token_of(file: str, port: int) -> str:
    """Return the token of the page of a file.

    Parameters
    ----------
    file : str
        Name of the design file.
    port : int
        Port that was asked for; 0 if the system chooses one.

    Returns
    -------
    str
        URL-safe letters.
    """
    key = _kept_key() if port else None
    if key is None:
        return secrets.token_urlsafe(BYTES)
    told = f"{port}\0{Path(file).resolve()}".encode("utf-8", "surrogateescape")
    digest = hmac.digest(key, told, hashlib.sha256)
    return urlsafe_b64encode(digest[:BYTES]).rstrip(b"=").decode()


def state_folder() -> Path:
    """Return the folder in which the system has programs keep what they need from run to run."""
    home = Path.home()
    if sys.platform == "win32":
        return Path(os.environ.get("LOCALAPPDATA") or home / "AppData/Local") / "gearcam"
    if sys.platform == "darwin":
        return home / "Library/Application Support/gearcam"
    named = Path(os.environ.get("XDG_STATE_HOME", ""))
    return (named if named.is_absolute() else home / ".local/state") / "gearcam"


def _kept_key() -> bytes | None:
    """Return the key, made if there is none that can be trusted; None if none can be kept."""
    with suppress(OSError, RuntimeError):  # the latter without a home
        path = state_folder() / _KEY
        return _read(path) or _written(path)
    return None


def _read(path: Path) -> bytes | None:
    """Return the key in a file; None if there is none, or others could have read or written it."""
    try:
        with path.open("rb") as file:
            state, key = os.fstat(file.fileno()), file.read(_LENGTH + 1)
    except FileNotFoundError:
        return None
    own = os.name != "posix" or (
        state.st_uid == os.getuid() and not S_IMODE(state.st_mode) & _OTHERS
    )
    return key if own and S_ISREG(state.st_mode) and len(key) == _LENGTH else None


def _written(path: Path) -> bytes | None:
    """Write a new key in one step, so that no other process reads a part of it, and return it."""
    path.parent.mkdir(_OWN, parents=True, exist_ok=True)
    number, name = tempfile.mkstemp(dir=path.parent)  # readable by its owner alone
    try:
        with os.fdopen(number, "wb") as file:
            file.write(secrets.token_bytes(_LENGTH))
        Path(name).replace(path)
    except OSError:
        with suppress(OSError):
            Path(name).unlink()
        raise
    return _read(path)  # that of another process if it was written later
