"""Reading: files that people give, whole, if they are files and no larger than they may be.

A pipe or a device may never end, and a huge file is no design: both are refused before a byte of
them is read.

Depends on numerals only.
"""

from __future__ import annotations

import os
import stat

from gearcam.numerals import size_of


class UnreadableError(OSError):
    """A file cannot be read; the message says why, in words that follow its name."""


def read(file: str | os.PathLike[str], most: int) -> bytes:
    """Return what is in a file.

    Parameters
    ----------
    file : path
        Its name; of a link the file that it leads to is read.
    most : int
        The largest size, bytes.

    Returns
    -------
    bytes

    Raises
    ------
    UnreadableError
        If there is none, if it is a folder, a pipe or a device, if it is larger, or if the disk
        refuses.
    """
    try:
        found = os.stat(file)  # noqa: PTH116 (a path would make an empty name a folder)
        if stat.S_ISDIR(found.st_mode):
            raise UnreadableError("this is a folder, not a file")
        if not stat.S_ISREG(found.st_mode):
            raise UnreadableError("this is a pipe or a device, not a file")
        if found.st_size <= most:
            with open(file, "rb") as stream:  # noqa: PTH123
                content = stream.read(most + 1)  # its size may not be told, or it may grow
            if len(content) <= most:
                return content
    except UnreadableError:
        raise
    except (FileNotFoundError, NotADirectoryError) as error:
        raise UnreadableError("there is no such file") from error
    except OSError as error:
        raise UnreadableError(f"cannot be read: {error.strerror or error}") from error
    except ValueError as error:
        raise UnreadableError("this can be no file's name here") from error
    told = f"has {size_of(found.st_size)}" if found.st_size > most else "is larger"
    raise UnreadableError(f"{told}, and files of up to {size_of(most)} are read")
