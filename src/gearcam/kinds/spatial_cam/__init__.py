"""Cams in space: a cylinder with a groove or an edge that moves a roller along it."""
