"""Reading design files: a file becomes a design, or one error that lists all mistakes."""

from __future__ import annotations

import os

from gearcam.base.errors import DesignError
from gearcam.designs.design import Design
from gearcam.designs.examine import examine_file
from gearcam.designs.kind import KINDS
from gearcam.designs.reader import content_of, decoded, document_in, problems_of


def load(path: str | os.PathLike[str]) -> Design:
    """Read a design file.

    Parameters
    ----------
    path : path
        A TOML file in UTF-8.

    Returns
    -------
    Design
        In mm and rad; its class depends on the kind.

    Raises
    ------
    DesignError
        If the file cannot be read, or with all mistakes in it, each with its line.
    """
    file = os.fspath(path)
    return loads(decoded(content_of(file), file), file=file)


def loads(text: str, *, file: str = "") -> Design:
    """Read the text of a design file.

    Parameters
    ----------
    text : str
        TOML.
    file : str
        Name of the file, for messages; its stem is the default name of the design.

    Returns
    -------
    Design
        In mm and rad; its class depends on the kind.

    Raises
    ------
    DesignError
        With all mistakes, each with its line.
    """
    document = document_in(text, file)
    found = examine_file(document, file)
    if found.faults:
        raise DesignError(problems_of(found.faults, text, file))
    return KINDS[document["kind"]].design(source=file, examined=True, **found.parts)
