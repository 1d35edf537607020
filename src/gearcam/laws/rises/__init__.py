"""Rises: S over phi on the unit square, each in the registry `rises.base.RISES`."""
