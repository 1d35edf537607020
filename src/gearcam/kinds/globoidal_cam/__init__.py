"""Globoidal indexing cams with their turrets."""
