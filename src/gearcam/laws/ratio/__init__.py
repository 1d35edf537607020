"""Ratio laws: i21 and phi2 of a pair over phi1, in the registry `ratio.base.LAWS`."""
