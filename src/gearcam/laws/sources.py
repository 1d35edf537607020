"""The texts that laws cite."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

SOURCES: Final[Mapping[str, str]] = {
    "de Boor": "C. de Boor: A Practical Guide to Splines. Springer, New York, 1978",
    "Duca, Buium, Paraoaru": "C. D. Duca, Fl. Buium, G. Paraoaru: Mecanisme (Mechanisms; in "
    'Romanian). Textbook, "Gh. Asachi" Technical University, Iasi, 2003',
    "Litvin, Fuentes": "F. L. Litvin, A. Fuentes: Gear Geometry and Applied Theory, 2nd edition. "
    "Cambridge University Press, 2004",
    "Neklutin": "C. N. Neklutin: Mechanisms and Cams for Automatic Machines. American Elsevier, "
    "New York, 1969",
    "Niculescu": "M. Niculescu: Cercetari privind proiectarea si generarea angrenajelor "
    "necirculare cu aplicabilitate in industria metalurgica (Design and generation of "
    "non-circular gears for the metallurgical industry; in Romanian). Summary of the doctoral "
    'thesis, "Dunarea de Jos" University, Galati, 2017',
    "Norton": "R. L. Norton: Cam Design and Manufacturing Handbook, 2nd edition. Industrial Press, "
    "New York, 2009",
}
"""Author, title, place and year, by what citations begin with: ``Norton`` in ``Norton, ch. 3``."""
