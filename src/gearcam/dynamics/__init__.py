"""Machines in motion: speeds and torques over the turn, stiff teeth, followers that jump.

A *machine* has one degree of freedom, the angle of its driver: its moments of inertia are reduced
to the driver (000, 5.1), a motor drives it and loads resist. In its *regime* the speed repeats with
every turn. In the *stiff model* teeth are springs with a damper and backlash, and the driven wheel
lags. A *follower* of a cam has one or two masses on springs; the cam turns evenly.

Everything is integrated over the driver's angle, so that each knot of a law or a load is met
exactly; the time is part of the state. SI here: rad, s, kg m2, N m; lifts of followers in mm.

Depends on meshing, mechanics and numeric; scipy where something is integrated.
"""
