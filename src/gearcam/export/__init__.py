"""Exporters: drawings (dxf, svg), solids (stl, 3mf, glb), tables (csv), and the writing of files.

Each exporter turns a drawing, a mesh or columns into bytes and touches no disk; `write` alone
does, whole or not at all. Exporters see parts, drawings and solids, never laws.
"""
