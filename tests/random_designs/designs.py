"""Random designs as the texts of their files: most can be built, one in ten has an error.

A design depends on its kind, the seed and its number only, not on how many others are drawn. Laws
and followers take turns.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from gearcam.designs.writing import toml_text
from random_designs import cam, gear_pair, globoidal_cam, mechanism, spatial_cam
from random_designs.broken import broken
from random_designs.documented import is_text, places, value
from random_designs.draw import Draw
from random_designs.output import limits, tables_as_files

BROKEN: Final = 0.1
"""Share of designs with an error, which may be refused."""

_ANYWHERE: Final = 0.15
"""Share of the others with one value drawn from its whole documented range."""

_LIMITED: Final = 0.15
"""Share of designs that set limits of checks."""

MAKERS: Final = {
    "cam": cam.design,
    "gear-pair": gear_pair.design,
    "globoidal-cam": globoidal_cam.design,
    "mechanism": mechanism.design,
    "spatial-cam": spatial_cam.design,
}
"""What makes a random design of each kind, as the tables of its file."""


@dataclass(frozen=True, kw_only=True)
class Drawn:
    """A random design.

    Parameters
    ----------
    files : mapping of str to str
        Texts by file name: the design file first, then its CSV files.
    broken : str
        The error in it; empty for a design meant to be buildable.
    """

    files: Mapping[str, str]
    broken: str = ""

    def write(self, folder: Path) -> Path:
        """Write the files into a `folder` and return the path of the design file."""
        folder.mkdir(parents=True, exist_ok=True)
        for name, text in self.files.items():
            (folder / name).write_text(text, encoding="utf-8")
        return folder / next(iter(self.files))


def design(kind: str, seed: int, index: int) -> Drawn:
    """Return a random design.

    Parameters
    ----------
    kind : str
        One of `MAKERS`.
    seed, index : int
        Seed, and number of the design.
    """
    d = Draw(f"{kind} {seed} {index}")
    name = f"{kind}-{seed}-{index}"
    document = {"kind": kind, "name": name, **MAKERS[kind](d, index)}
    if d.chance(_LIMITED):
        document["limits"] = limits(d, document)
    tables = tables_as_files(d, document, name)
    if d.chance(BROKEN):
        return Drawn(**broken(d, document, tables))
    if d.chance(_ANYWHERE):
        named = kind == "mechanism"  # most texts are names: another one is an error
        found = [one for one in places(document) if not (named and is_text(one[2]))]
        table, key, node = d.pick(found)
        table[key] = value(d, key, node)
    return Drawn(files={f"{name}.toml": toml_text(document), **tables})
