"""Independent witnesses: the mathematics of a gear pair once more, by other means.

Nothing here imports gearcam. Depends on numpy, shapely and mpmath.

* `laws`: ratio laws written out once, for plain floats, arrays and high precision alike;
* `oracle`: lengths, angles, radii of curvature and centre distances in 30 digits and more;
* `kinematics`: where a cutter stands when it has rolled the arc length s, by Gauss quadrature;
* `sweep`: a rack's teeth at many positions, subtracted from the blank;
* `shaper`: the same with a pinion cutter, for wheels with concave parts.
"""
