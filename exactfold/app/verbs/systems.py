"""`sheet_system` and `certify_points`: equations for other programs, and proofs of answers."""

from __future__ import annotations

import textwrap
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import gcd
from typing import Final, Literal

from exactfold._support.plurals import counted
from exactfold._support.verdict import PROVED, UNDECIDED, Verdict
from exactfold.errors import NotApplicableError, NotCountedError, UsageError
from exactfold.exact.numbers import RationalLike, over_common_denominator
from exactfold.exact.surds import Number, Surd, common_field
from exactfold.interop.export import (
    System,
    Term,
    polynomials_of,
    to_homotopy_continuation,
    to_macaulay2,
    to_msolve,
    to_sage_script,
    to_singular,
    to_sympy_script,
)
from exactfold.panels.vertex.stars import bracket, stars
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.loading import PatternLike, open_sheet
from exactfold.pattern.panel_pattern import PanelPattern
from exactfold.rigidity.curvature import curvature_form
from exactfold.rigidity.equations.branch_system import BranchSystem
from exactfold.rigidity.equations.problem import Problem
from exactfold.rigidity.equations.quadratic import QuadraticSystem
from exactfold.solve.certify.box import IsolatingBox, Uncertified
from exactfold.solve.certify.exact_krawczyk import krawczyk
from exactfold.solve.certify.points import Points

PROGRAMS: Final[Mapping[str, tuple[Callable[[System], str], str]]] = {
    "msolve": (to_msolve, ""),
    "m2": (to_macaulay2, "--"),
    "singular": (to_singular, "//"),
    "sage": (to_sage_script, "#"),
    "julia": (to_homotopy_continuation, "#"),
    "sympy": (to_sympy_script, "#"),
}
"""By program: the function that writes its input, and the sign of a comment; msolve has none."""


@dataclass(frozen=True, repr=False)
class SheetSystem:
    """The equations of a sheet: polynomials with integer coefficients.

    A term is a coefficient with the indices of its unknowns, one for each factor. `about` says what
    the unknowns and the equations are. `square` holds the same equations if they are as many
    quadrics as unknowns, so that `certify_points` can prove zeros; else it is None.
    """

    kind: Literal["saddle", "boundary heights", "heights", "panels"]
    unknowns: tuple[str, ...]
    polynomials: tuple[tuple[Term, ...], ...]
    about: str
    square: QuadraticSystem | None = None

    def __repr__(self) -> str:
        equations = counted(len(self.polynomials), "equation")
        return f"<SheetSystem: {self.kind}, {equations} in {len(self.unknowns)} unknowns>"

    def text(self, program: str) -> str:
        """The input of a program of `PROGRAMS`, with `about` as a comment.

        >>> print(sheet_system("single-vertex-4").text("sympy"), end="")
        # heights h of vertices, in the unit of the sheet; one equation K_v = 0 for each interior
        # vertex; the heights of 1, 2, 3 are 0, and the boundary saddle is 1
        from sympy import symbols
        h4, = symbols("h4,")
        equations = [
          4096*h4**2-1458*h4-295,
        ]
        """
        write, comment = PROGRAMS[program]
        lines = _wrapped(self.about, 98 - len(comment)) if comment else []
        return "".join(f"{comment} {line}\n" for line in lines) + write(self)


def sheet_system(
    sheet: PatternLike,
    boundary_heights: Mapping[int, RationalLike] | None = None,
) -> SheetSystem:
    """The second-order equations of a sheet, for its kind.

    - Triangulated, four boundary vertices: K_v = 0 in the heights of the other vertices, where the
      boundary saddle is 1; n quadrics in n unknowns.
    - Triangulated, convex, with `boundary_heights`: K_v = 0 in the heights of the interior
      vertices; n quadrics in n unknowns.
    - Triangulated, more boundary vertices: K_v = 0 in the heights of all vertices but three; the
      quadrics are homogeneous.
    - Rigid panels: for each interior vertex sum_j w_j d_j = 0 (two linear equations) and
      sum_{k<j} w_k w_j [d_k, d_j] = 0 in the fold densities w of the folds that can fold
      (docs/panels.md). Square roots of the coordinates are unknowns r1, r2, ... with their
      equations; of the zeros, those with r1, r2, ... > 0 belong to the sheet.

    Raises `NotCountedError` for a sheet that has no unknowns and for a drawing whose exact sheet is
    not known, and the errors of `Problem.of`.

    >>> sheet_system("two-vertex"), sheet_system("miura").kind
    (<SheetSystem: saddle, 2 equations in 2 unknowns>, 'panels')
    """
    opened = open_sheet(sheet)
    if opened.doubt:
        raise NotCountedError(f"{opened.doubt}; --snap exact takes the digits as written")
    sheet = opened.sheet
    if isinstance(sheet, PanelPattern):
        if boundary_heights is not None:
            raise UsageError("boundary heights belong to triangulated sheets")
        return _of_panels(sheet)
    if boundary_heights is not None:
        return _of_given_heights(sheet, boundary_heights)
    if len(sheet.boundary) > 4:
        return _of_heights(sheet)
    problem = Problem.of(sheet)
    problem.require_foldable()
    chart = BranchSystem(problem.sheet).chart
    labels = problem.labels
    pins = ", ".join(str(labels[v]) for v in chart.branch_system.pinned)
    eliminated = labels[chart.eliminated]
    about = f"{_HEIGHTS}; the heights of {pins} are 0, and the boundary saddle is 1"
    if eliminated not in sheet.boundary:
        about += f", which gives the height of {eliminated}"
    names = tuple(f"h{labels[v]}" for v in chart.variables)
    return _square("saddle", names, chart.system, about)


_HEIGHTS: Final = (
    "heights h of vertices, in the unit of the sheet; one equation K_v = 0 for each interior vertex"
)


def _of_heights(sheet: CreasePattern) -> SheetSystem:
    """The homogeneous quadrics of a sheet with more than four boundary vertices."""
    reduced, labels = sheet.without_rigid_parts(())
    if not reduced.interior:
        raise NotCountedError("no interior vertex of this sheet can pop: it has no equations")
    system = BranchSystem(reduced)
    _, polynomials = polynomials_of(system)
    pins = ", ".join(str(labels[v]) for v in system.pinned)
    names = tuple(f"h{labels[v]}" for v in system.variables)
    return SheetSystem(
        "heights", names, tuple(map(tuple, polynomials)), f"{_HEIGHTS}; the heights of {pins} are 0"
    )


def _of_given_heights(
    sheet: CreasePattern, boundary_heights: Mapping[int, RationalLike]
) -> SheetSystem:
    """The quadrics of a convex sheet whose boundary heights are given."""
    problem = Problem.of(sheet, boundary_heights=boundary_heights)
    problem.require_foldable()
    given, unknowns = problem.gauge.boundary_heights, problem.gauge.unknowns
    place = {v: k for k, v in enumerate(unknowns)}
    size = len(unknowns)
    matrices = []
    for v in unknowns:
        form = curvature_form(problem.sheet, v)
        matrix = [[Fraction(0)] * (size + 1) for _ in range(size + 1)]
        lifts = [(place[u], Fraction(1)) if u in place else (size, given[u]) for u in form.labels]
        for (i, x), row in zip(lifts, form.matrix, strict=True):
            for (j, y), weight in zip(lifts, row, strict=True):
                matrix[i][j] += Fraction(weight) * x * y
        matrices.append(matrix)
    names = tuple(f"h{problem.labels[v]}" for v in unknowns)
    return _square(
        "boundary heights",
        names,
        QuadraticSystem.from_rational(matrices),
        f"{_HEIGHTS}; the boundary has the heights that were given",
    )


def _of_panels(sheet: PanelPattern) -> SheetSystem:
    """The linear and quadratic equations of rigid panels, in fold densities."""
    moving = stars(sheet)
    folds = sorted({edge for star in moving.values() for edge in star.folds})
    if not folds:
        raise NotCountedError("no fold that ends at an interior vertex can fold: no equations")
    directions = [x for star in moving.values() for d in star.directions for x in d]
    roots = common_field(directions)
    place = {edge: k for k, edge in enumerate(folds)}
    first = len(folds)
    equations: list[list[tuple[Number, tuple[int, ...]]]] = []
    for star in moving.values():
        at = [place[edge] for edge in star.folds]
        for axis in (0, 1):
            line = zip(star.directions, at, strict=True)
            equations.append([(d[axis], (k,)) for d, k in line if d[axis]])
        quadric = []
        for j, (dj, wj) in enumerate(zip(star.directions, at, strict=True)):
            for dk, wk in zip(star.directions[:j], at[:j], strict=True):
                if weight := bracket(dk, dj):
                    quadric.append((weight, tuple(sorted((wk, wj)))))
        equations.append(quadric)
    polynomials = [_with_roots(terms, first) for terms in equations if terms]
    for k, radicand in enumerate(roots.radicands):
        root = first + k
        below: list[tuple[Fraction, tuple[int, ...]]] = [(Fraction(1), (root, root))]
        below += [(-c, _product(m, first)) for m, c in enumerate(radicand) if c]
        polynomials.append(_integral(below))
    count = len(roots.radicands)
    names = [f"w{i}x{j}" for i, j in folds] + [f"r{k + 1}" for k in range(count)]
    about = (
        "fold densities w (fold angle / length) of the folds that can fold; for each interior "
        "vertex two linear equations and one quadric, up to common positive factors"
    )
    if count:
        about += "; r1, ... are the square roots in the coordinates, all positive"
    return SheetSystem("panels", tuple(names), tuple(polynomials), about)


def _with_roots(terms: Sequence[tuple[Number, tuple[int, ...]]], first: int) -> tuple[Term, ...]:
    """Terms with integer coefficients, where roots are unknowns from index `first` on."""
    rational: list[tuple[Fraction, tuple[int, ...]]] = []
    for weight, factors in terms:
        parts = weight.coefficients if isinstance(weight, Surd) else (Fraction(weight),)
        rational += [(c, (*factors, *_product(m, first))) for m, c in enumerate(parts) if c]
    return _integral(rational)


def _product(mask: int, first: int) -> tuple[int, ...]:
    """The unknowns of a product of roots; bit i of `mask` stands for the root r_(i+1)."""
    return tuple(first + i for i in range(mask.bit_length()) if mask >> i & 1)


def _integral(terms: Sequence[tuple[Fraction, tuple[int, ...]]]) -> tuple[Term, ...]:
    coefficients, _ = over_common_denominator(c for c, _ in terms)
    common = gcd(*coefficients)
    return tuple(
        (c // common, factors) for c, (_, factors) in zip(coefficients, terms, strict=True)
    )


def _square(
    kind: Literal["saddle", "boundary heights"],
    names: tuple[str, ...],
    system: QuadraticSystem,
    about: str,
) -> SheetSystem:
    _, polynomials = polynomials_of(system)
    return SheetSystem(kind, names, tuple(map(tuple, polynomials)), about, system)


def _wrapped(text: str, width: int) -> list[str]:
    return textwrap.wrap(text, min(width, 88))


@dataclass(frozen=True, repr=False)
class CertifiedPoints:
    """What is proved of points that another program found.

    `boxes[k]` isolates the zero near point k, or says why none was proved. `same[k]` is the first
    point whose box has a common point with that of point k, and so may hold the same zero; it is k
    itself if there is none before.
    """

    system: SheetSystem
    boxes: tuple[IsolatingBox | Uncertified, ...]
    same: tuple[int, ...]

    @property
    def proved(self) -> int:
        """The number of points with a proved zero."""
        return sum(isinstance(box, IsolatingBox) for box in self.boxes)

    @property
    def zeros(self) -> tuple[IsolatingBox, ...]:
        """Disjoint boxes, each with exactly one zero."""
        return tuple(
            box
            for k, box in enumerate(self.boxes)
            if isinstance(box, IsolatingBox) and self.same[k] == k
        )

    @property
    def complete(self) -> Verdict:
        """PROVED if the disjoint boxes are as many as Bezout's number 2^n of the n quadrics.

        Then they hold all zeros, also non-real ones (docs/mathematics.md, Completeness).
        """
        known = [box for box in self.zeros if box.is_real or box.is_nonreal]
        return PROVED if len(known) == 2 ** len(self.system.unknowns) else UNDECIDED

    def __repr__(self) -> str:
        points = counted(len(self.boxes), "point")
        return f"<CertifiedPoints: {self.proved} of {points} proved, {len(self.zeros)} zeros>"


def certify_points(system: SheetSystem, points: Points) -> CertifiedPoints:
    """Prove, for each point, that exactly one zero of the system lies in a small box around it.

    Krawczyk's test in integers decides (`exactfold.solve.krawczyk`). Points are rows of
    coordinates in the order of `system.unknowns`. A point near a multiple zero, or too far from a
    zero, is not proved; this does not mean that there is no zero nearby. Raises
    `NotApplicableError` for a system that has not as many equations as unknowns.

    >>> system = sheet_system("single-vertex-4")
    >>> certify_points(system, [[-0.144], [0.5], [0.49]])
    <CertifiedPoints: 3 of 3 points proved, 2 zeros>
    """
    if system.square is None:
        raise NotApplicableError(
            f"isolated zeros are proved for as many equations as unknowns; this system has "
            f"{len(system.polynomials)} equations in {len(system.unknowns)} unknowns"
            + ("; give boundary heights" if system.kind == "heights" else "")
        )
    boxes = krawczyk(system.square, points)
    same: list[int] = []
    for k, box in enumerate(boxes):
        known = range(k) if isinstance(box, IsolatingBox) else ()
        same.append(next((j for j in known if same[j] == j and _meet(boxes[j], box)), k))
    return CertifiedPoints(system, tuple(boxes), tuple(same))


def _meet(one: IsolatingBox | Uncertified, other: IsolatingBox | Uncertified) -> bool:
    return (
        isinstance(one, IsolatingBox)
        and isinstance(other, IsolatingBox)
        and not one.is_disjoint_from(other)
    )
