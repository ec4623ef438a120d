"""The answer to "in how many ways does this sheet start to fold?", with its proof."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar, overload

from exactfold._support.notebook import Page
from exactfold._support.plurals import counted
from exactfold._support.results import Certified, Ways
from exactfold._support.verdict import PROVED, UNDECIDED, Verdict
from exactfold.branches.values.branch import Branch
from exactfold.branches.values.lettered import Lettered, lettered
from exactfold.errors import UsageError
from exactfold.pattern.crease_pattern import CreasePattern, Edge
from exactfold.pattern.described import described
from exactfold.pattern.near_degeneracy import near_degenerate, warnings
from exactfold.pattern.rounding import half_step
from exactfold.rigidity.equations.branch_system import Chart
from exactfold.rigidity.rigid_triangles import RigidTriangle

if TYPE_CHECKING:  # counting branches does not load what panels need
    from exactfold.branches.connected_components.result import ConnectedComponents
    from exactfold.branches.values.count_document import (
        BranchCountDocument,
        BranchCountKeys,
        Power,
    )
    from exactfold.branches.values.nearly_flat import Bends, NearlyFlat
    from exactfold.panels.count_document import AsWrittenDocument, MotionKeys, OfDigits
    from exactfold.panels.result import Decomposition, Proposal
    from exactfold.pattern.meant import Meant
    from exactfold.pattern.opening import ReadDocument
    from exactfold.solve.certify.algebraic import AlgebraicProof


@dataclass(frozen=True)
class Proof:
    """The proof of a count; `branches.certificates.listing` writes it down (docs/certificate.md).

    `kind` is one of the following. "chambers": one root for each sign vector. "isolated": the roots
    of the branches, each in a box, are all roots. "algebraic": by multiplicities, see
    `AlgebraicProof`. "rigid" and "single vertex". The first three refer to `chart`, whose vertex k
    is vertex `labels[k]` of the pattern. `lines` are the lines of the certificate if `kind` is
    "chambers".
    """

    kind: str
    triangles: tuple[RigidTriangle, ...]
    labels: tuple[int, ...] = ()
    chart: Chart | None = None
    algebraic: AlgebraicProof | None = None
    lines: tuple[str, ...] = field(default=(), repr=False)


@dataclass(frozen=True, repr=False)
class BranchCount(Page, Ways[Branch], Certified):
    """What is known of the branches of a pattern at the unfolded state.

    `status` is PROVED if the counts are proved. Otherwise the counts are None, and `reason` says
    what is missing. `why` says why the method was chosen. `distinct` is the number of branches as
    lines (for D = 1). `with_multiplicity` is the number of solutions of the branch system with
    multiplicity. `real` and `nonreal` are the numbers of its distinct real and nonreal solutions.
    `true_branches` is PROVED if the count is also that of the true configuration space
    (docs/mathematics.md, True branches). `true_bounds` are bounds of the number of true branches
    for D = 1 (docs/any_border.md, Theorem 9). `dimension` and `degree` are those of the cone of all
    complex solutions, modulo planes, with multiplicity: D and 2^Vi if that is proved
    (docs/mathematics.md, Single vertex), and None otherwise.

    `branches` contains every branch that is decided. These are all branches if the status is PROVED
    and D = 1. For D > 1 a branch is not a line, and none is listed. There, for a convex boundary,
    the solutions are 2^n graphs over the boundary heights, and `connected_components` says how many
    connected components they have. `families` are their irreducible components, if `count_ways`
    computed them. The counts are then None, except for a single vertex.

    `meant` says what was inferred if the digits of the drawing are inexact, and `as_written` is the
    answer for these digits alone. If `doubt` says why an answer would hold for the digits of the
    sheet only, the status is UNDECIDED, and `as_written` has that answer; `proposal` is then a
    sheet that may have been meant, if one was looked for and found. `bends` has the angles of folds
    that were measured during the proof.

    A certificate is written from `proof`. `open_questions` says what is missing; if the status is
    PROVED, it names folds with the letter "U". `letters` are those of the file, by fold; it is
    empty if the file has none. `len(result)`, iteration and `result["+-"]` or `result[3]` refer to
    `branches`.
    """

    pattern: CreasePattern
    status: Verdict
    method: str
    reason: str
    why: str = ""
    distinct: int | None = None
    with_multiplicity: int | None = None
    real: int | None = None
    nonreal: int | None = None
    true_branches: Verdict = UNDECIDED
    true_bounds: tuple[int, int] | None = None
    dimension: int | None = None
    degree: int | None = None
    branches: tuple[Branch, ...] = ()
    open_questions: tuple[str, ...] = ()
    proof: Proof | None = None
    settings: Mapping[str, int | str] = field(default_factory=dict)
    snapped: Fraction = Fraction(0)
    read: ReadDocument | None = None
    letters: Mapping[Edge, str] = field(default_factory=dict)
    connected_components: ConnectedComponents | None = None
    families: Decomposition | None = None
    meant: Meant | None = None
    doubt: str = ""
    as_written: OfDigits | None = None
    proposal: Proposal | None = None
    bends: Bends | None = field(default=None, repr=False, compare=False)
    seconds: float = field(default=0.0, compare=False)

    WRITER: ClassVar = "exactfold.branches.certificates.listing:certificate"

    def listed(self) -> tuple[Branch, ...]:
        """`branches`."""
        return self.branches

    def __contains__(self, which: object) -> bool:
        return which in self._by_signs if isinstance(which, str) else which in self.branches

    @overload
    def __getitem__(self, which: int | str) -> Branch: ...
    @overload
    def __getitem__(self, which: slice) -> tuple[Branch, ...]: ...
    def __getitem__(self, which: int | str | slice) -> Branch | tuple[Branch, ...]:
        """A branch by its place in the list, or by its vertex signs, as in "+-0"; or a slice.

        Raises `KeyError` for signs that no listed branch has. Raises `UsageError` for signs that
        several branches have, which is possible only if the boundary has a reflex corner.
        """
        if isinstance(which, int | slice):
            return self.branches[which]
        branches = self._by_signs.get(which, [])
        if not branches:
            raise KeyError(
                f"no listed branch has the vertex signs {which!r}; give one of +, - and 0 for each "
                f"of {counted(self.pattern.Vi, 'interior vertex')}"
            )
        if len(branches) > 1:
            raise UsageError(
                f"{len(branches)} branches have the vertex signs {which!r}; choose one by its "
                "number"
            )
        return branches[0]

    @cached_property
    def _by_signs(self) -> dict[str, list[Branch]]:
        groups: dict[str, list[Branch]] = {}
        for branch in self.branches:
            groups.setdefault(branch.sign_text, []).append(branch)
        return groups

    @property
    def known(self) -> BranchCount:
        """This answer, or, if it is doubted, what is known for the digits as they are read."""
        known = self.as_written
        return known if self.doubt and isinstance(known, BranchCount) else self

    @property
    def warning(self) -> str | None:
        """A warning about the pattern to read before the count; see `near_degenerate`."""
        if self.meant is not None:
            return None
        near_degeneracy = near_degenerate(self.pattern)
        if near_degeneracy is None and self.families is not None:
            return self.families.warning
        near = near_degeneracy or self.nearly_flat
        return None if near is None else near.text

    @cached_property
    def nearly_flat(self) -> NearlyFlat | None:
        """Folds that are flatter on some branches than chance explains, though not flat.

        None if there are none, or if the coordinates are no decimals that may be rounded.
        """
        if self.bends is not None:
            sheet, labels = self.pattern.without_rigid_parts()
            near = self.bends.nearly_flat(sheet)
            return None if near is None else near.labelled(labels)
        inferred = self.meant is not None and self.meant.inferred
        if not self.branches or not (inferred or half_step(self.pattern.vertices)):
            return None
        from exactfold.branches.values.nearly_flat import bends_of  # exact sheets do without it

        bends = bends_of(self.branches)
        return None if bends is None else bends.nearly_flat(self.pattern)

    @property
    def by(self) -> str | None:
        """How the result was proved: by "enumeration", by the "theorem" alone, or None."""
        if self.method == "theorem":
            return "theorem"
        return "enumeration" if self.status is PROVED else None

    @cached_property
    def lettered(self) -> Lettered | None:
        """Which branches have `letters`; None if there are no letters or no branch is listed."""
        if not self.letters or not self.branches:
            return None
        return lettered(self.branches, self.letters, self.status is PROVED)

    def to_dict(
        self, certificate: str | None = None, name: str | None = None
    ) -> BranchCountDocument:
        """The object printed by `exactfold count --json`: `schema("count")`.

        Raises `ArithmeticError` for a count that is proved and lacks numbers, which is a defect.
        """
        keys, many = self._keys(certificate, name), self.with_multiplicity
        connected_components = (
            None if self.connected_components is None else self.connected_components.to_dict()
        )
        if self.status is not PROVED:
            return {
                **keys,
                "status": "undecided",
                "by": "theorem" if self.method == "theorem" else None,
                "method": self.method,
                "distinct": None,
                "with_multiplicity": None if many is None else _number(many),
                "real": None,
                "nonreal": self.nonreal,
                "pieces": connected_components,
            }
        if self.method == "theorem" and connected_components is not None:
            return {
                **keys,
                "status": "proved",
                "by": "theorem",
                "method": "theorem",
                "distinct": None,
                "with_multiplicity": None if many is None else _number(many),
                "real": None,
                "nonreal": self.nonreal,
                "pieces": connected_components,
            }
        if self.distinct is None or many is None or self.real is None or self.nonreal is None:
            raise ArithmeticError("numbers are missing from a count that is proved")
        return {
            **keys,
            "status": "proved",
            "by": "enumeration",
            "method": self.method,
            "distinct": self.distinct,
            "with_multiplicity": _number(many),
            "real": self.real,
            "nonreal": self.nonreal,
            "pieces": connected_components,
        }

    def _keys(self, certificate: str | None, name: str | None) -> BranchCountKeys:
        bounds, near = self.true_bounds, self.known.nearly_flat
        return {
            "format": "exactfold count result",
            "version": 2,
            "pattern": described(self.pattern, name, self.snapped),
            "ways": self.ways,
            "reason": self.reason,
            "why": self.why,
            "true_branches": str(self.true_branches),
            "true_bounds": None if bounds is None else [_number(x) for x in bounds],
            "dimension": self.dimension,
            "degree": None if self.degree is None else _number(self.degree),
            "certificate": certificate,
            "warnings": warnings(self.pattern) or ([near.to_dict()] if near else []),
            "seconds": round(self.seconds, 3),
            "open_questions": list(self.open_questions),
            "settings": dict(self.settings),
            "branches": [branch.entry() for branch in self.branches],
            "theory": "branches",
            "letters": None if self.lettered is None else self.lettered.to_dict(),
            "rigid": self.distinct == 0 if self.status is PROVED else None,
            "exceptional_vertices": list(self.exceptional_vertices),
            "read": None if self.read is None else {**self.read},
            "meant": None if self.meant is None else self.meant.to_dict(),
            "as_written": None if self.as_written is None else self.as_written.of_digits(),
            **self._families(),
        }

    def of_digits(self) -> AsWrittenDocument:
        """The key `as_written` of the answer for the sheet that was meant."""
        from exactfold.pattern.opened import digits  # imported here: a count does not need it

        return {
            "sheet": digits(self.meant, self.read),
            "status": str(self.status),
            "reason": self.reason,
            "rigid": self.distinct == 0 if self.status is PROVED else None,
            "distinct": self.distinct,
            "components": self._families()["components"],
        }

    @property
    def ways(self) -> int | None:
        """The number of branches, or of families of motions with more than four corners; 0 for a
        rigid sheet, None if the number is infinite or not known.
        """
        return self.distinct if self.families is None else self.families.ways

    def _families(self) -> MotionKeys:
        """The keys of the JSON output that belong to irreducible components."""
        if self.families is not None:
            return self.families.keys()
        return {
            "components": None,
            "freedom": None,
            "drawn": None,
            "proposal": None if self.proposal is None else self.proposal.to_dict(),
            "modes_count": None,
            "modes": [],
            "way_list": [],
            "flat_folds": [],
            "still_folds": [],
            "free_folds": [],
            "near_misses": [],
        }

    @property
    def exceptional_vertices(self) -> tuple[int, ...]:
        """Vertices outside triangulated triangles whose star is flat on some branch, for D = 1.

        If there are any, some branch is multiple. For almost all positions of the interior vertices
        there are 2^(Vi - Vt) different branches, none of which has such a vertex (docs/generic.md,
        Theorem 11). The result is also empty if branches are not listed.
        """
        if self.pattern.Ve != 4:
            return ()
        flat = {v for b in self.branches for v, sign in b.vertex_signs.items() if sign == 0}
        return tuple(sorted(flat - self.pattern.rigid_vertices))

    @property
    def sign_vectors(self) -> Counter[str]:
        """The number of branches with each vertex-sign vector; opposite vectors are counted
        together.
        """
        return Counter(branch.names[0] for branch in self.branches)

    @property
    def undecided_folds(self) -> Counter[Edge]:
        """The number of branches on which each fold has the letter "U"; it may be flat or nearly so
        there.
        """
        return Counter(
            fold
            for branch in self.branches
            if "U" in branch.assignment_text
            for fold in branch.undecided_folds
        )

    @property
    def repeated_assignments(self) -> int | None:
        """The number of branches that share their mountain-valley assignment, up to reflection.

        None if the letter of some fold is undecided.
        """
        if self.undecided_folds:
            return None
        counts = Counter(branch.names[1] for branch in self.branches)
        return sum(count for count in counts.values() if count > 1)

    def __repr__(self) -> str:
        if self.connected_components is not None and self.distinct is None:
            return f"<BranchCount: {self.status}, {self.connected_components!r}, {self.pattern!r}>"
        number = counted("?" if self.distinct is None else self.distinct, "branch")
        return f"<BranchCount: {self.status}, {number}, {self.pattern!r}>"

    def _repr_latex_(self) -> str | None:
        if self.connected_components is not None and self.distinct is None:
            return None
        if self.distinct is None:
            return r"$B = {?}\quad \text{(undecided)}$"
        return (
            rf"$B = {self.distinct}\ \text{{({self.status})}},\quad "
            rf"V_i = {self.pattern.Vi},\ V_e = {self.pattern.Ve},\ V_t = {self.pattern.Vt}$"
        )


def _number(value: int) -> Power:
    """A number of solutions for JSON; a power of two if some programs could not read it exactly."""
    if value < 1 << 53:
        return value
    return f"2^{value.bit_length() - 1}"
