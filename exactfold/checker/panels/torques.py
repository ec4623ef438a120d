"""Certificates of torques that drive rigid panels along one way (docs/actuation.md, 7 and 8).

The claims are about a sheet of which all ways are known, with at most four folds at each vertex
and no fold held flat:

- `sha256`: the digest of the pattern; `ways`: how many ways there are;
- `way`: the motions of the way that is driven, each as [k, choice] for a mode of support k in the
  evidence, with its lines as there, or as [i, j] for a fold from boundary to boundary;
- `assignment`: M, V or F for each fold, on the ray that is driven;
- `self_foldable`: "proved" if some torques do work on every motion of the way and on no other way,
  "refuted" if none do; "undecided" claims nothing;
- `springs`: "equal", or "by length" if their stiffness is in proportion to the lengths;
- `torques`: for each fold a rational number, of size at most `limit`; if `creases` is a number, at
  most so many are not 0;
- `margin`: the power on the ray exceeds that on every rival by at least this number;
- `bound`: no torques of size at most `limit`, on at most `creases` folds if that is not null, have
  a larger margin.

The evidence has `count`, the claims of a panels certificate with all true motions; `turned`, for
each motion of the way a weight of the ray on which it is turned to the other side; and `rays`, each
[[[motion, c], ...], weight], a ray sum_i c_i u_i of another way, with rational c_i whose squares
add up to at most 1. The weights are not negative and add up to 1. With these the margin of torques
is at most their power on the target less the weighted rays, hence at most the sum of the sizes of
its components times `limit`, or of the largest of them.

The checker finds the modes again, and with them the ways. Whether the way is self-foldable it
decides by ranks, in intervals where it can, and else exactly.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any, TypedDict

from ..core import limits
from ..core.intervals import Interval
from ..core.kinds import DocumentKind
from ..core.reading import (
    at_most,
    counted,
    items,
    keys,
    keys_of,
    parse_rational,
    refusing,
    require,
    same,
    shown,
)
from ..sheets.panels import Edge, connected, read_panels
from . import certificate
from .forms import Forms
from .reduction import BITS, Joined, Work, reduced
from .unit_motions import (
    BY_LENGTH,
    EQUAL,
    Torques,
    UnitMotions,
    Vector,
    densities_of,
    plus,
    power,
    root_of_sum,
    weight_of,
)

MOST_RAYS = limits.TORQUE_RAYS


class TorqueClaims(TypedDict):
    """The claims of a file."""

    sha256: str
    ways: int
    way: list[list[int | str]]
    assignment: str
    self_foldable: str
    springs: str
    torques: list[str]
    limit: str
    creases: int | None
    margin: str
    bound: str


class TorqueEvidence(TypedDict):
    """The evidence of a file."""

    count: Any
    turned: list[str]
    rays: list[list[Any]]


@refusing()
def check(data: dict[str, Any]) -> TorqueClaims:
    """Verify every claim of a certificate; raises `CertificateError` at the first failure."""
    claims, evidence = data["claims"], data["evidence"]
    keys(claims, keys_of(TorqueClaims), "claims")
    keys(evidence, keys_of(TorqueEvidence), "evidence")
    counted_ways = {"pattern": data["pattern"], "claims": evidence["count"]}
    facts = certificate.check(counted_ways)
    require(facts["true"] is not None, "it is not known which ways truly fold")
    require(facts["modes"] is not None, "the ways are not all spanned by modes")
    require(not facts["held"], "folds are held flat: the ways are not those of the sheet")
    require(claims["springs"] in (EQUAL, BY_LENGTH), "the springs are of no kind that is known")
    sheet, digest = read_panels(data["pattern"])
    require(claims["sha256"] == digest, f"the digest of the pattern is {digest}")
    motions = UnitMotions(sheet, facts, claims["springs"])
    driven = _Driven(motions, claims)
    driven.check_margin()
    driven.check_bound(evidence)
    verdict = self_foldable(motions, driven.way, driven.rivals)
    said = claims["self_foldable"]
    require(said in ("undecided", verdict), f"that the way is self-foldable is {verdict}")
    proved: TorqueClaims = claims
    return proved


class _Driven:
    """The ray that is driven, its rivals, and the torques of a file."""

    def __init__(self, motions: UnitMotions, claims: TorqueClaims) -> None:
        self.motions, self.claims = motions, claims
        ways = motions.ways()
        self.way = [motions.find(name) for name in items(claims["way"], "way")]
        require(frozenset(self.way) in ways, "the motions that are driven are not those of a way")
        require(len(set(self.way)) == len(self.way), "the way names a motion twice")
        require(same(claims["ways"], len(ways)), f"there are {len(ways)} ways")
        self.rivals = [way for way in ways if way != frozenset(self.way)]
        self.own = self._sided()
        share = Interval.of(Fraction(1, len(self.way)), BITS).root()
        self.target: Vector = {}
        for row in self.own:
            self.target |= {fold: value * share for fold, value in row.items()}
        self.share = share
        self.torques = Torques(motions.sheet.folds, claims)

    def _sided(self) -> list[Vector]:
        """The motions of the way, each to the side that has the letters."""
        letters = self.claims["assignment"]
        folds = self.motions.sheet.folds
        require(
            isinstance(letters, str) and len(letters) == len(folds),
            "there is not one letter for each fold",
        )
        given = dict(zip(folds, letters, strict=True))
        sided: list[Vector] = []
        for place in self.way:
            row = self.motions.motions[place].row
            first = min(row)
            sided.append(row if given[first] == "V" else {e: -x for e, x in row.items()})
        signs = {fold: x.sign() for row in sided for fold, x in row.items()}
        right = "".join("FVM"[signs.get(fold, 0)] for fold in folds)
        require(letters == right, f"the letters on this ray are {right}")
        return sided

    def check_margin(self) -> None:
        """Refuse a margin that some rival contradicts."""
        powers = [power(motion.row, self.torques.by_fold) for motion in self.motions.motions]
        target = power(self.target, self.torques.by_fold)
        own = [power(row, self.torques.by_fold) * self.share for row in self.own]
        turned = [target - self._twice(one) for one in own]
        others = [root_of_sum([powers[k] for k in way]) for way in self.rivals]
        self.torques.check_margin(target, max(rival.high for rival in [*turned, *others]))

    def check_bound(self, evidence: TorqueEvidence) -> None:
        """Refuse a bound that the weights do not prove."""
        turned = [weight_of(x) for x in items(evidence["turned"], "turned", len(self.way))]
        gap = dict(self.target)
        for weight, row in zip(turned, self.own, strict=True):
            ray = plus(self.target, -self._twice(self.share), row)
            gap = plus(gap, -Interval.of(weight, BITS), ray)
        total = sum(turned, Fraction(0))
        rays = items(evidence["rays"], "rays")
        at_most(len(rays), MOST_RAYS, "the rays", "TORQUE_RAYS")
        for entry in rays:
            parts, text = items(entry, "a ray", 2)
            weight = weight_of(text)
            total += weight
            for place, c in self._ray(parts):
                share = Interval.of(-weight * c, BITS)
                gap = plus(gap, share, self.motions.motions[place].row)
        self.torques.check_bound(gap, total)

    def _ray(self, parts: Any) -> list[tuple[int, Fraction]]:
        """The motions of a ray of another way, with their coefficients."""
        ray = []
        for part in items(parts, "a ray"):
            name, text = items(part, "a motion of a ray", 2)
            ray.append((self.motions.find(name), parse_rational(text)))
        places = {place for place, _ in ray}
        require(len(places) == len(ray), "a ray names a motion twice")
        require(any(places <= way for way in self.rivals), "a ray lies on no other way")
        require(sum(c * c for _, c in ray) <= 1, "a ray is longer than 1")
        return ray

    @staticmethod
    def _twice(value: Interval) -> Interval:
        return value + value


def self_foldable(
    motions: UnitMotions, way: Sequence[int], rivals: Sequence[frozenset[int]]
) -> str:
    """Whether no motion of the way is a sum of multiples of motions that only other ways have."""
    others = sorted(set[int]().union(*rivals).difference(way))
    for group in connected(motions.near):
        own = [k for k in way if set(motions.motions[k].vertices) & set(group)]
        beside = [k for k in others if set(motions.motions[k].vertices) & set(group)]
        if own and not _outside(motions, own, beside, len(Forms(motions.sheet, group).first_order)):
            return "refuted"
    return "proved"


def _outside(motions: UnitMotions, own: list[int], beside: list[int], size: int) -> bool:
    """Whether no motion of `own` lies in the span of those beside it, in a part of the sheet.

    `size` is the dimension of its first-order motions.
    """
    work = Work()
    rank = len(reduced((motions.motions[k].row for k in beside), work))
    if rank == size:
        return False
    rows = [motions.motions[k].row for k in beside]
    if rank == len(beside) and all(
        len(reduced([*rows, motions.motions[k].row], work)) > rank for k in own
    ):
        return True
    joined = Joined()
    exact = [_exact(motions, joined, k) for k in [*beside, *own]]
    vectors = [{e: joined.tower.number(x) for e, x in vector.items()} for vector in exact]
    basis = [row for _, row in reduced(vectors[: len(beside)], work)]
    return all(
        len(reduced([*basis, vector], work)) > len(basis) for vector in vectors[len(beside) :]
    )


def _exact(motions: UnitMotions, joined: Joined, place: int) -> dict[Edge, Any]:
    motion = motions.motions[place]
    if motion.support is None:
        return {}
    return densities_of(motions.modes, motion.support, motion.choice, joined.of)


def summary(claims: TorqueClaims) -> str:
    """One line that states the verified claims."""
    others = counted(claims["ways"] - 1, "other way is", "other ways are")
    size = len(claims["way"])
    kind = "an isolated way" if size == 1 else f"a family of dimension {size}"
    most = "" if claims["creases"] is None else f" on at most {claims['creases']} folds"
    alone = {
        "proved": "; the way is self-foldable",
        "refuted": "; the way is not self-foldable",
    }.get(claims["self_foldable"], "")
    return (
        f"VALID: on a ray of {kind} the torques have at least {shown(claims['margin'])} more power "
        f"than on every rival, among which {others}; no torques of size at most "
        f"{shown(claims['limit'])}{most} have more than {shown(claims['bound'], up=True)}{alone}; "
        f"sha256 {claims['sha256']}"
    )


PANEL_TORQUES = DocumentKind(
    format="exactfold torques",
    named="panel-torques",
    versions=(1,),
    names="format version kind pattern claims evidence",
    claims=TorqueClaims,
    check=check,
    summary=summary,
)
"""Torques that drive rigid panels along one way (docs/actuation.md)."""
