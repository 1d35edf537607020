"""Ratio laws: i21 and phi2 over phi1 of a pair, each law in the registry `ratio.base.LAWS`."""
