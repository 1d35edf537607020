"""Refusal of planetary pairs: a planet on a carrier between sun and ring."""

from __future__ import annotations

from typing import Any

from gearcam.designs.faults import Fault


def planetary_fault(teeth: Any) -> Fault:
    """Return the fault of a design that asks for a planet on a carrier.

    Parameters
    ----------
    teeth : object
        Value of ``pair.teeth``.

    Returns
    -------
    Fault
        Of the tooth counts, if there are three.
    """
    three = isinstance(teeth, list) and len(teeth) == 3
    return Fault(
        ("pair", "teeth") if three else ("pair",),
        "a planet between sun and ring on a carrier is not available",
        teeth if three else None,
        allowed="two tooth counts, driver first; design each pair of wheels separately",
        hint="only round wheels mesh in a ring of sun + 2*planet teeth, none in a smaller one",
    )
