"""The followers of cams: position, velocity and contact of each, once for every carrier.

Points of the plane are complex numbers, mm, in the fixed frame. The *position* p of a follower is
its lift added to its position at zero lift, mm or rad. A round follower has a centre ``C(p)``;
its path has the unit tangent t, the follower's direction, and the length ``lever`` per unit of p:

==================== ======================================= ========= ==========
follower             centre                                  lever     direction t
==================== ======================================= ========= ==========
stem                 ``exp(i*tilt)*(offset + i*p)``          1         ``i*exp(i*tilt)``
arm                  ``pivot - hand*arm*exp(-i*hand*p)``     ``arm``   ``i*exp(-i*hand*p)``
==================== ======================================= ========= ==========

With U, the velocity of a point at rest seen from the cam, the centre moves in the cam's frame by
``A + i*B = i*lever*s' + i*conj(t)*U``: A across the follower's direction, B against it.
``alpha = arctan(B/A)`` is the pressure angle, ``w = hypot(A, B)`` the speed of the centre and
``turning = rate - spin*s' - alpha'`` the angular rate of the normal; the pitch curve's curvature is
``turning/w`` (positive for a convex curve), and the profile, a roller's radius r inside it, is
traced at the speed ``w - r*turning``. Where that is negative the profile is undercut.

A flat face is a support line at the distance h from the cam's axis, which turns by ``-beta`` in the
cam's frame: it touches ``g = h'/beta'`` along itself, and the profile is traced at the speed
``h*beta' + g'``. The curves run clockwise.

Frame: the cam's axis is the origin. Over a cam that turns a stem moves along ``+y``, and the pivot
of an arm or a swinging face is on the x axis; positions are

==================== ==========================================================
stem                 height of the centre
flat stem            height of the face
arm                  Psi, between the arm and the line from pivot to cam
flat arm             the same of the face
==================== ==========================================================

A roller *below* the axis, the second on one follower, has a negative position; the formulas of the
first are valid for it unchanged.

Refused: positions that an arm or a swinging face cannot take.

Sources: 000 eqs. (3.17), (3.21), (3.26), (3.30), (3.33), section 3.4.4; derived anew.

`base` says what a follower answers, `rounds` has those with a centre, `faces` those with a line.
"""

from __future__ import annotations

from gearcam.cams.followers.base import Contact, Follower
from gearcam.cams.followers.faces import Face, FlatArm, FlatStem
from gearcam.cams.followers.rounds import Arm, Round, Stem

__all__ = ["Arm", "Contact", "Face", "FlatArm", "FlatStem", "Follower", "Round", "Stem"]
