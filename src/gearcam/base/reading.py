"""Reading of files that users name: only regular files up to a given size.

A pipe or a device may never end, and a huge file is not a design: both are refused before anything
is read.

Depends on numerals only.
"""

from __future__ import annotations

import os
import stat

from gearcam.base.numerals import size_of


class UnreadableError(OSError):
    """A file cannot be read; the message gives the reason and follows the file's name."""


def read(file: str | os.PathLike[str], most: int) -> bytes:
    """Return the content of a file.

    Parameters
    ----------
    file : path
        Its name; links are followed.
    most : int
        The largest size, bytes.

    Returns
    -------
    bytes

    Raises
    ------
    UnreadableError
        If there is no such file, if it is a folder, a pipe or a device, if it is larger, or if the
        system refuses.
    """
    try:
        status = os.stat(file)  # noqa: PTH116 (a path would make an empty name a folder)
        if stat.S_ISDIR(status.st_mode):
            raise UnreadableError("this is a folder, not a file")
        if not stat.S_ISREG(status.st_mode):
            raise UnreadableError("this is a pipe or a device, not a file")
        if status.st_size <= most:
            with open(file, "rb") as stream:  # noqa: PTH123
                content = stream.read(most + 1)  # the size may be unknown, or the file may grow
            if len(content) <= most:
                return content
    except UnreadableError:
        raise
    except (FileNotFoundError, NotADirectoryError) as error:
        raise UnreadableError("there is no such file") from error
    except OSError as error:
        raise UnreadableError(f"cannot be read: {error.strerror or error}") from error
    except ValueError as error:
        raise UnreadableError("this is not a possible file name") from error
    size = f"has {size_of(status.st_size)}" if status.st_size > most else "is larger"
    raise UnreadableError(f"{size}, but files of at most {size_of(most)} are read")
