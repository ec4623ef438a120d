"""Enclosed fold angles of a nonlinear mode: each is computed from another one at a vertex.

Proof of Theorem 10 (docs/motion.md, 20), in its notation: take the vertices in the order in which
they are passed, the first known fold of each being the driver, or a fold of a vertex before.
Suppose that the motion of all vertices before exists until there, so that t = tau^2 of the known
fold is no larger on the way than at the end (Theorem 9). The signs of the discriminant, divided by
c^2, and of a new c where it is not positive in any case, are those of b^2 - 4 (p + q t) a and of (p
+ q t) / p. Both are linear in t. They are positive at the flat sheet, the first because the two
gains there are different, and positive at the end, hence on the way. So the chosen root continues
the gain at the flat state, and no fold at the vertex is closed: the vertex follows, as in the proof
of Theorem 9. Round loops the transmissions are the identity.
"""

from __future__ import annotations

from typing import NamedTuple

from flint import arb, arb_series, ctx

from exactfold.exact.surds import ball
from exactfold.motion.panels.followable import PanelMode
from exactfold.panels.vertex.stars import dot
from exactfold.panels.vertex.transmission import Transmission
from exactfold.pattern.panel_pattern import Edge

Tangent = tuple[arb_series, arb_series]
"""(c, s), where s / c is the tangent of half a fold angle; c > 0 until the fold is closed."""


class Passed(NamedTuple):
    """One transmission, from the tangent of the fold `start` to that of the fold `end`.

    With tau = tan(angle / 2) / length, tau_end = u tau. `quadratic` is (p, q, b, a) with (p + q
    tau^2) u^2 + b u + a = 0, or None if u is the constant `gain`. `lengths` are those of both
    folds.
    """

    start: Edge
    end: Edge
    gain: arb
    quadratic: tuple[arb, arb, arb, arb] | None
    lengths: tuple[arb, arb]

    def __call__(self, tangent: Tangent) -> Tangent:
        """The tangent of the end, from that of the start.

        For tau = n / c it is n z, where (p c^2 + q n^2) z^2 + b c z + a = 0. Of the two roots z, it
        is the one that equals the gain where the fold is flat. The result is not finite if the root
        may be double. Raises `ValueError` if the two roots cannot be distinguished.
        """
        c, s = tangent
        n = s / self.lengths[0]
        if self.quadratic is None:
            return c, n * self.gain * self.lengths[1]
        p, q, b, a = self.quadratic
        leading, middle = c * c * p + n * n * q, c * b
        first = 2 * p * self.gain + b
        if not (first > 0 or first < 0):
            raise ValueError("two roots cannot be distinguished")
        side = 1 if first > 0 else -1
        root = (middle * middle - 4 * leading * a).sqrt() * side
        if b == 0 or bool(b > 0) == (side > 0):
            return side * (middle + root), (-2 * side) * n * a * self.lengths[1]
        turn = 1 if p > 0 else -1
        return (2 * turn) * leading, turn * n * (root - middle) * self.lengths[1]


def passes_of(mode: PanelMode, driver: Edge, bits: int) -> list[Passed]:
    """The transmissions from the driver to all other folds, in the order in which they are used."""
    passes: list[Passed] = []
    known = {driver}
    with ctx.workprec(bits):
        lengths = {
            fold: ball(dot(d, d), bits).sqrt()
            for fold in mode.folds
            for d in [mode.pattern.direction(*fold)]
        }
        for k, fold in mode.order_from(driver):
            star, local = mode.stars[k], mode.choice[k]
            for other in star.folds:
                if other in known:
                    continue
                known.add(other)
                step = Transmission(star, local, fold, other)
                quadratic = None
                if step.quadratic is not None and not step.is_linear:
                    p, q, b, a = (ball(value, bits) for value in step.quadratic)
                    quadratic = p, q, b, a
                ends = lengths[fold], lengths[other]
                passes.append(Passed(fold, other, ball(step.gain, bits), quadratic, ends))
    return passes


def spread(passes: list[Passed], driver: Edge, tangent: Tangent) -> dict[Edge, Tangent]:
    """The tangents of all folds of a mode, computed from that of its driver.

    Raises `ValueError` if some fold may be closed, because the mode may end there.
    """
    tangents = {driver: tangent}
    for passed in passes:
        tangents[passed.end] = passed(tangents[passed.start])
    if not all(c[0] > 0 for c, _ in tangents.values()):
        raise ValueError("a fold may be closed")
    return tangents
