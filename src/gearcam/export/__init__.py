"""Exporters: drawings (dxf, svg), solids (meshes, step), tables (csv), and the writing of files.

Each exporter turns a drawing, a mesh or columns into bytes and touches no disk; `write` alone
writes, whole or not at all, and `listing` decides what becomes of older files. Exporters see parts,
drawings and solids, never laws.
"""
