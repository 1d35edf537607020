"""Stress of teeth: plane elastic wheels under the forces of their contacts.

A wheel's part is a plane *region* bounded by true curves (`region`), or a `sector` of one; `mesh`
fills it with triangles, small where `size_field` asks for it. Everything is per mm of width, static
and linear.

Depends on base, numeric, parts and gears, and on scipy and scikit-fem, which the extra ``stress``
installs.
"""
