"""Certificates of torques that drive rigid panels, for `exactfold.checker`."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from typing import Any

from exactfold._support.verdict import PROVED
from exactfold.certificates.entries import Document
from exactfold.checker.panels.torques import PANEL_TORQUES, TorqueClaims, TorqueEvidence
from exactfold.design.actuation.panels.result import PanelActuation
from exactfold.errors import NotApplicableError
from exactfold.exact.numbers import format_rational
from exactfold.motion.panels.followable import PanelMode
from exactfold.panels.certificate import certificate_of_panels, choice_text
from exactfold.panels.vertex.stars import stars
from exactfold.pattern.panel_pattern import Edge

_SLACK = Fraction(1, 10**15)
"""What the claims leave for the rounding of the checker, where a margin is a rational number."""


def panel_torques_certificate(found: PanelActuation) -> Document:
    """The certificate of torques for one way of rigid panels, as a JSON object.

    It contains the count of all ways, what the torques do, a bound of the margin of all torques,
    and whether the way is self-foldable (docs/actuation.md, 10). Raises `NotApplicableError` if
    the margin is not proved to be positive against all ways, if folds are held flat, and for sheets
    on which more than four folds of a vertex may fold.

    >>> from exactfold import checker
    >>> from exactfold.branches.counting.ways import count_ways
    >>> from exactfold.design.actuation.panels.actuate import actuate_panels
    >>> document = panel_torques_certificate(actuate_panels(count_ways("zigzags"), 1))
    >>> checker.check(document)["self_foldable"]
    'proved'
    """
    if found.status is not PROVED:
        raise NotApplicableError(
            f"only torques that are proved to prefer a way have a certificate: {found.reason}"
        )
    if not found.motions.by_structure:
        raise NotApplicableError(
            "no certificate: only ways that modes span have one, and more than four folds of a "
            "vertex may fold"
        )
    if found.decomposition.held:
        raise NotApplicableError("no certificate: it is about sheets with no fold held flat")
    count = certificate_of_panels(found.decomposition)
    names = _Names(found, count["claims"]["supports"])
    folds = found.pattern.folds
    sizes = [abs(torque) for torque in found.torques.values()]
    claims: TorqueClaims = {
        "sha256": found.pattern.sha256,
        "ways": len(found.motions.ways),
        "way": [names.name(place) for place in names.way],
        "assignment": "".join(found.assignment.get(fold, "F") for fold in folds),
        "self_foldable": str(found.self_foldable),
        "springs": found.springs,
        "torques": [format_rational(found.torques[fold]) for fold in folds],
        "limit": format_rational(max(sizes) if found.given else Fraction(1)),
        "creases": found.creases,
        "margin": format_rational(found.margin[0] - _SLACK),
        "bound": format_rational(found.shown + _SLACK),
    }
    turned = [Fraction(0)] * len(names.way)
    rays: list[list[Any]] = []
    for recipe, weight in found.proof:
        if isinstance(recipe, int):
            turned[recipe] += weight
        else:
            ray = [[names.name(k), format_rational(names.side(k) * c)] for k, c in recipe]
            rays.append([ray, format_rational(weight)])
    evidence: TorqueEvidence = {
        "count": count["claims"],
        "turned": [format_rational(weight) for weight in turned],
        "rays": rays,
    }
    return {
        "format": PANEL_TORQUES.format,
        "version": PANEL_TORQUES.version,
        "kind": PANEL_TORQUES.named,
        "pattern": count["pattern"],
        "claims": claims,
        "evidence": evidence,
    }


class _Names:
    """The names that the motions of a sheet have in a certificate."""

    def __init__(self, found: PanelActuation, supports: Iterable[dict[str, Any]]) -> None:
        self.motions = found.motions
        self.way = self.motions.way(found.way.number).motions
        self.moving = stars(found.pattern, found.decomposition.held)
        self.places: dict[tuple[Edge, ...], int] = {
            tuple((i, j) for i, j in support["folds"]): k for k, support in enumerate(supports)
        }

    def name(self, place: int) -> list[int | str]:
        """[k, choice] for a mode, [i, j] for a fold from boundary to boundary."""
        source = self.motions.motions[place].source
        if isinstance(source, PanelMode):
            return [self.places[source.folds], choice_text(source.choice, self.moving)]
        if isinstance(source, tuple):
            return list(source)
        raise NotApplicableError("no certificate: a way is a space of motions")

    def side(self, place: int) -> int:
        """1 if the first fold of a motion is a valley, else -1: the checker has a valley there."""
        rows = self.motions.directions
        ends = zip(rows.low[place], rows.high[place], strict=True)
        return next(1 if low > 0 else -1 for low, high in ends if low > 0 or high < 0)
