"""What helps a cam: changes after a refusal or an error, and what is said beside findings."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import replace
from functools import cache, partial
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from gearcam.base.adjustments import Adjustment, Scale, least
from gearcam.base.errors import DesignError, InfeasibleError
from gearcam.base.findings import CHECKS, Finding, limit_of
from gearcam.base.numerals import DIGITS, formatted, shortened
from gearcam.cams.checks import KIND, driven
from gearcam.designs.design import document_of, value_at
from gearcam.kinds.cam.forms.base import lift_program
from gearcam.kinds.cam.motion import by_rows, of_radii
from gearcam.kinds.cam.tables import CAM_FORMATS
from gearcam.kinds.sizes import LARGER, SizeAdvice
from gearcam.laws.motion_table import MotionTable
from gearcam.parts.checks import KIND as PARTS_KIND
from gearcam.results.advice import kerf_paths

if TYPE_CHECKING:
    from gearcam.base.adjustments import Changes
    from gearcam.cams.cam import Cam
    from gearcam.cams.wall import PitchMotion
    from gearcam.kinds.cam.made import MadeCam
    from gearcam.results.advice import Search

_MOST: Final = 100.0
"""Largest radius that is tried, over what the follower needs: its lift, roller and offset."""

_LOOKS: Final = tuple(2**k for k in range(9))
"""Where larger radii than the one computed are looked at, in steps of the last digit printed."""

_CLOSER: Final = 1.0 + 1e-4
"""Factor of the least radius that a follower needs."""


_COARSEST: Final = 1.0
"""Largest chord tolerance of a cam, mm."""

_SCATTERED: Final = 4.0
"""Between a quarter and half of the rows the error falls by more than this if the lift is smooth,
and hardly at all if the rows scatter."""

_SHARES: Final = (0.4, 0.5, 0.65, 0.8, 1.0)
"""Smoothing tolerances that are tried, over the error: the farthest of scattered rows is about 0.4
of it beside the lift, and a much larger tolerance takes more from the lift than scatter did."""


def hinted(result: MadeCam, findings: tuple[Finding, ...]) -> tuple[Finding, ...]:
    """Return findings; their messages say with which values they disappear.

    Parameters
    ----------
    result : MadeCam
        Of the cam.
    findings : tuple of Finding
        Of its checks.
    """
    sentence = cache(partial(_sentence, result))  # several findings may be about one motion
    rounder = cache(partial(_rounder, result))
    hints: dict[str, Callable[[Finding], Iterable[str]]] = {
        "coarse-rows": lambda finding: _smoother(result, finding)
    }
    sizes: dict[str, Callable[[Finding], Iterable[str]]] = {
        **dict.fromkeys(("sharp-profile", "undercut"), lambda _: rounder()),
        **dict.fromkeys(
            ("pressure-angle", "jamming"),
            lambda finding: [sentence(finding.code, _motion_of(result, finding))],
        ),
    }
    hints |= {} if of_radii(result.design.motion) else sizes
    return tuple(
        replace(one, message=" ".join([one.message, *hints[one.code](one)]))
        if one.code in hints
        else one
        for one in findings
    )


def gentler(result: MadeCam, code: str, number: int = 0) -> dict[str, float] | None:
    """Return the smallest radius with which a motion has no finding of a code.

    Parameters
    ----------
    result : MadeCam
        Of the cam.
    code : str
        ``pressure-angle`` or ``jamming``.
    number : int
        Which of the cam's motions.

    Returns
    -------
    dict of str to float, or None
        Changes of the design, followed on the exact curve; None where no radius up to a hundred
        times what the follower needs does.
    """
    motion = result.cam.motions[number]
    if not motion.carrier.around:
        return None
    steep = next(_steep(result, code, number), None)
    if steep is None:
        return None
    found = _least(result, motion, code, math.radians(steep.limit or 0.0))
    if found is None:
        return None
    scale, start = Scale(DIGITS), shortened(found, 1.0)

    def changes(place: int) -> dict[str, float]:
        return resized(result, number, scale.value(scale.index(start) - 1 + place))

    def keeps(place: int) -> bool:
        # another size has the same lift
        other = type(result)(result.solved.with_(changes(place)), result.tolerances)
        return not any(_steep(result, code, number, other.form.make(result.program)))

    try:
        kept = least(keeps, _LOOKS, guessed=True)
    except (DesignError, InfeasibleError):
        return None
    return changes(kept[0]) if kept else None


def resized(result: MadeCam, number: int, size: float) -> dict[str, float]:
    """Return the changes that give a motion another prime radius.

    Parameters
    ----------
    result : MadeCam
        Of the cam.
    number : int
        Which of its motions.
    size : float, mm
        The radius; of the second of conjugate cams that at the highest lift.
    """
    document, motion = document_of(result.solved), result.cam.motions[number]
    follower = motion.follower
    if number:
        if value_at(document, "cam.prime_radius2_mm"):
            return {"cam.prime_radius2_mm": size}
        scale, unit = follower.lift_unit
        key = f"follower.{'arms_angle' if follower.angular else 'roller_distance'}_{unit}"
        more = scale * (follower.start - _started(motion, size))
        return {key: shortened(value_at(document, key) + more, more, 5)}
    base = value_at(document, "cam.base_radius_mm")
    key = "cam.prime_radius_mm" if base is None else "cam.base_radius_mm"
    own = size if base is None else float(f"{size - follower.radius:.10g}")
    return grown(document, key, own)


def grown(document: Mapping[str, Any], key: str, size: float) -> dict[str, float]:
    """Return the changes that give a cam another radius, its blank as much metal around it.

    Parameters
    ----------
    document : mapping
        The design, as a file holds it.
    key : str
        Of the radius.
    size : float, mm
        The radius.
    """
    blank = value_at(document, "cam.outer_diameter_mm")
    if not blank:
        return {key: size}
    wider = blank + 2.0 * (size - value_at(document, key))
    return {key: size, "cam.outer_diameter_mm": float(f"{wider:.10g}")}


def _sentence(result: MadeCam, code: str, number: int) -> str:
    """Return what keeps the limit of a check, in words."""
    changes = gentler(result, code, number)
    if changes is not None:
        changed = " and ".join(f"{key} = {formatted(value, 10)}" for key, value in changes.items())
        return f"The smallest cam that keeps the limit has {changed}."
    motion = result.cam.motions[number]
    follower = motion.follower
    if not follower.has_centre:
        return "A smaller face offset reduces it."
    if not motion.carrier.around:
        return "A smaller lift or a longer travel reduces it."
    unless = ", or another arm or pivot distance" if follower.angular else ""
    unless = ", or a smaller offset" if follower.aside else unless
    return (
        f"No prime radius up to {formatted(_MOST * _need(motion), 3)} mm keeps the limit: it takes "
        f"a larger angle or a smaller lift{unless}."
    )


def _rounder(result: MadeCam) -> tuple[str, ...]:
    """Return a sentence with each size that alone keeps all limits, or none."""
    if not result.form.solvable or result.cam.least_base_radius is not None:
        return ()  # of a face the check itself names the radius
    from gearcam.kinds.cam.solve import alone

    document = document_of(result.solved)
    given = (
        key
        for key in ("cam.prime_radius_mm", "cam.base_radius_mm", "follower.roller_radius_mm")
        if value_at(document, key)
    )
    sizes = {key: alone(result, key) for key in given}
    found = [f"{key} = {formatted(value, 10)}" for key, value in sizes.items() if value is not None]
    return (f"With {' or '.join(found)} it keeps all limits.",) if found else ()


def enlarged(result: MadeCam, findings: Iterable[Finding]) -> tuple[Finding, ...]:
    """Return findings of a study of forces; a contact pressure names the cam that keeps its limit.

    Parameters
    ----------
    result : MadeCam
        Of the cam.
    findings : iterable of Finding
        Of the study.
    """
    from gearcam.kinds.cam.solve import alone

    found: list[Finding] = []
    for one in findings:
        if one.code == "contact-pressure" and one.limit and result.form.solvable:
            key = next(
                key
                for key in ("cam.prime_radius_mm", "cam.base_radius_mm")
                if value_at(document_of(result.solved), key)
            )
            size = alone(result, key, {"limits.contact_pressure_mpa": one.limit})
            if size is not None:
                hint = f"With {key} = {formatted(size, 10)} it keeps all limits."
                one = replace(one, message=f"{one.message} {hint}")
        found.append(one)
    return tuple(found)


def _motion_of(result: MadeCam, finding: Finding) -> int:
    """Return which of a cam's motions a finding is about."""
    keyed = (k for k, one in enumerate(result.cam.motions) if one.key)
    motions = result.cam.motions
    return next((k for k in keyed if finding.where.startswith(motions[k].called)), 0)


def _steep(result: MadeCam, code: str, number: int, cam: Cam | None = None) -> Iterator[Finding]:
    """Yield the findings of a code about one motion of a result's cam, or of another `cam`."""
    limit = limit_of(KIND, code, result.design.limits)
    for finding in CHECKS[KIND, code].run(cam or result.cam, limit):
        if _motion_of(result, finding) == number:
            yield finding


def _started(motion: PitchMotion, size: float) -> float:
    """Return the position at zero lift of a follower that stands at a radius, mm."""
    position = float(motion.follower.on_circle(size))
    # below the axis it stands nearest at the highest lift
    return -position - motion.program.range[1] if motion.follower.below else position


def _need(motion: PitchMotion) -> float:
    """Return what the size of a follower and its lift add up to, mm."""
    follower, (low, high) = motion.follower, motion.program.range
    return follower.lever * (high - low) + follower.aside + follower.radius


def _least(result: MadeCam, motion: PitchMotion, code: str, limit: float) -> float | None:
    """Return the least radius, mm, that keeps a limit, rad, at many cam angles."""
    follower, (bottom, top) = motion.follower, motion.program.range
    survey = motion.program.survey
    kinds = driven(result.cam, motion) if code == "jamming" else ("rise", "return")
    middles = survey.places.mean(axis=1)
    ends = [pair for kind in kinds for pair in motion.program.phases(kind)]
    inside = np.any([(low < middles) & (middles < high) for low, high in ends], axis=0)
    lift, speed = survey.values[:2, inside].reshape(2, -1)
    if follower.below:  # below the axis it stands nearest at the highest lift
        lift, bottom = top - lift, 0.0
    low, high = follower.least_start(limit, lift, speed)
    size = min(follower.prime_radius, _CLOSER * max(follower.radius, follower.nearest))
    low = max(low, float(follower.on_circle(size)) - bottom)
    if low > high:
        return None
    least = follower.distance(low)
    return least if least <= _MOST * _need(motion) else None


def _smoother(result: MadeCam, finding: Finding) -> Iterator[str]:
    """Yield values with which the rows of a motion table are not coarser than the profile."""
    table, lead, error = result.design.motion, result.cam.motions[0], finding.value or 0.0
    if isinstance(table, MotionTable) and lead.program.fall < _SCATTERED:
        lever, design = lead.follower.lever, result.solved
        name = "radius_tolerance" if table.of_radii else "smoothing_tolerance"
        entries = by_rows().table.bound([design.follower.motion]).entries.values()
        entry = next(one for one in entries if one.name == name)
        given, unit = 2.0 * (getattr(table, name) or 0.0), 1.0 if table.of_radii else lever
        asked = (entry.outward(max(share * error / unit, given)) for share in _SHARES)
        sizes = {shortened(size, 1.0, 2) for size in asked}
        for size in sorted(sizes):
            smoother = replace(table, **{name: entry.inward(size)})
            try:  # what is left of the error is computed, not assumed
                changed = replace(design, motion=smoother, examined=True)
                program = lift_program(changed, result.tolerances)
            except InfeasibleError:  # a tolerance as large as the lift
                break
            if program.errors[0] * lever <= lead.tolerance:
                yield f"With motion.{entry.key} = {formatted(size)} the scatter is averaged out."
                break
    coarser = shortened(error, 1.0, 2)
    if coarser <= _COARSEST:
        yield (
            f"With output.chord_tolerance_mm = {formatted(coarser)} the profile is cut only as "
            "finely as the lift is known."
        )


_ALSO: Final[Mapping[str, Callable[[Any], object]]] = {
    "csv": lambda result: result.angles,
    "tool-path": lambda result: result.paths(),
    "dxf": kerf_paths,
    "cut-svg": kerf_paths,
    "curvature": lambda result: result.files("curvature"),
    "grinding": lambda result: result.files("grinding"),
}
"""Checks of single file formats, which may refuse a file although the profiles can be drawn."""


def _demand(kind: str) -> Callable[[Any], object]:
    """Return the check of a file format for which all profiles are drawn."""
    return lambda result: (result.profiles, kind in _ALSO and _ALSO[kind](result))


class CamAdvice(SizeAdvice):
    """Remedies of plate cams."""

    file_demands = MappingProxyType({kind: _demand(kind) for kind in CAM_FORMATS})
    larger = (
        "cam.prime_radius_mm",
        "cam.base_radius_mm",
        "cam.prime_radius2_mm",
        "follower.roller_distance_mm",
    )
    smaller = ("follower.roller_radius_mm", "follower.roller2_radius_mm")

    def seek(self, search: Search, refusal: InfeasibleError | None) -> None:
        """Guide a `search`; the refusal of a size that is solved for names what has to give."""
        if not search.result.design.asked:
            super().seek(search, refusal)

    def grown(self, document: Mapping[str, Any], key: str, size: float) -> Changes:
        """Return the changes that give a cam another `size` (see `grown`)."""
        return grown(document, key, size)

    def farthest(self, search: Search, size: float) -> float:  # noqa: ARG002
        """Return up to which `size`, mm, a cam is made in a `search`: by follower and lift."""
        return LARGER * _reach(search)

    def named(self, search: Search, refusal: InfeasibleError) -> Iterator[Adjustment]:
        """Yield what a `refusal` names in a `search`; a bore leaves a wall that is thick enough."""
        wall = 2.0 * limit_of(PARTS_KIND, "thin-wall", search.result.design.limits)
        for adjustment in refusal.adjustments:
            bore = [*adjustment.far] == ["blank.bore_diameter_mm"] and not adjustment.near
            if bore and refusal.limit is not None and wall < 0.9 * refusal.limit:
                yield replace(adjustment, near={"blank.bore_diameter_mm": refusal.limit - wall})
            else:
                yield adjustment

    def of_errors(self, search: Search) -> Iterator[Adjustment]:
        """Yield the least radii without jamming, and for a face with the least profile radius.

        The radius of a profile below a flat face is ``base + s + s''``, 0 at the border of
        undercut.
        """
        result: Any = search.result
        if "jamming" in search.codes:
            motions = range(len(result.cam.motions))
            sizes = [gentler(result, "jamming", number) or {} for number in motions]
            yield Adjustment(near={key: size for one in sizes for key, size in one.items()})
        if "undercut" in search.codes and (base := result.cam.least_base_radius) is not None:
            base += limit_of(KIND, "sharp-profile", result.design.limits)
            yield Adjustment(
                near=grown(search.document, "cam.base_radius_mm", shortened(base, 1.0))
            )


def _reach(search: Search) -> float:
    """Return how far a follower and its lift reach, mm."""
    result: Any = search.result
    follower = result.solved.follower
    lift = 0.0
    with suppress(InfeasibleError):
        lift = float(np.ptp(result.program.range)) * (
            follower.arm or follower.pivot_distance or 1.0
        )
    sizes = (follower.radius, abs(follower.offset), follower.arm, follower.pivot_distance)
    return lift + sum(size or 0.0 for size in sizes)
