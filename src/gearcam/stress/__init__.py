"""Stress of teeth: plane elastic wheels under the forces of their contacts.

A wheel's part is a plane *region* bounded by true curves (`region`); `mesh` fills it with
triangles, small where the stress is to be known. Everything is per mm of width, static and linear.

Depends on base, numeric, parts and gears, and on scipy and scikit-fem, which the extra ``stress``
installs.
"""
