"""Mechanics of a mechanism: how fast it is driven, what it works against, and what it is made of.

Each module has a table of design files, which all kinds of design share: they name its class in
their tables, and none reads such keys by itself. `drive` has the speed of the driver, `load` given
forces and torques, `spring`, `mass` and `gravity` what a moving member carries, `friction` the
coefficients with the sizes of bearings, `material` elasticity and strength; `hertz` is the pressure
between two bodies, `clearance` what is said of a roller without any.

The statics of a follower on any cam: `follower_loads` is what acts on it, `supports` what holds it,
`statics` the forces, with the places where a cam presses as `Touch`, `force_checks` their checks,
`driver_axis` the name of the cam's angle or travel.

Inside the program speeds are in rad/s (of a driver that slides mm/s), forces in N, torques in N mm,
masses in kg and stresses in MPa. Units that mix with mm and s are turned where they are used.

Depends on base, and on laws for formulas.
"""
