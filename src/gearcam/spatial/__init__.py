"""Cams in space: the walls that a roller makes in a body that turns, whatever its axis does.

`spec` holds the settings of a design. `envelope` is the kernel: the walls of a cylindrical or
conical roller in closed form. `guides` moves the roller: along the cam, on an arm, on a turret.
`cam` has the walls of one cam with their measures, `make` makes it from a design, `developed` has
the error of constructing walls in the developed plane, `surface` the surface of the finished body
as triangles.

All lengths are in mm, angles in rad. The cam turns counter-clockwise about its axis, z, by theta; a
point of the cam is a fixed point, turned by -theta. A cam that turns clockwise is the mirror image.
"""
