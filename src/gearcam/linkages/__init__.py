"""Plane linkages: drives and dyads in a row, solved in closed form at any angle of the driver.

`plane` has points and directions as complex jets. `dyads` solves each group of two members and
three joints from what it begins at. `elements` has the parts of a linkage: shafts, cranks, slides,
guides, dyads, points. `chain` has the one group with a root per position. `linkage` puts the parts
in order and evaluates all of them. `closing` finds where a linkage closes, its change points, and
the nearest length that closes. `geneva` is one more part.

`efforts` are the forces and moments that act, each on one of the `coordinates`: the ways and angles
on which they do work. `work` finds the driver's moment from them.

`measures` has the extremes, dead centres, travel and time ratio of an output, `dwells` where it
rests, `transmission` the pressure angles of dyads, `grashof` the class of a four-bar. `paths` has
length, area, cusps and crossings of a point's path, `path_fits` how straight or round it is.

All lengths are in mm, angles in rad, counter-clockwise from the x axis. Everything is a function of
the driver's angle q; the derivatives are those by q. A room that knows no wheels and no cams: what
turns a shaft comes as a function of q.
"""
