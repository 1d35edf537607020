"""Cams with their followers: the kind ``cam``."""
