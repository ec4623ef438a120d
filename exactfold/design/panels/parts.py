"""Whether one part of a sheet of panels, which moves independently of the others, has letters."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from itertools import chain, islice
from typing import Any, Final

import networkx as nx

from exactfold._support.clock import UNLIMITED, Clock
from exactfold._support.plurals import counted
from exactfold._support.verdict import PROVED, REFUTED, UNDECIDED, Verdict
from exactfold.design.panels.candidates import MotionSearch
from exactfold.design.panels.cells import Cell, CellSearch, OpenLoop
from exactfold.design.panels.first_order_program import FirstOrderProgram
from exactfold.design.panels.lettered_spaces import LetteredSpaces, truly_begin
from exactfold.design.panels.nappe_program import NappeCases
from exactfold.design.panels.proof import ProvedMotion, proved_motion
from exactfold.design.panels.refutation import PanelRefutation
from exactfold.design.panels.vertex.reasons import VertexReason, vertex_reason
from exactfold.design.panels.vertex.witness import vertex_witness
from exactfold.design.refutations.refutation import Letters
from exactfold.errors import TooManyModesError
from exactfold.exact.surds import Number
from exactfold.panels.modes.densities import UndecidedDensityError
from exactfold.panels.modes.extension import Loops, extension
from exactfold.panels.vertex.stars import Star, edge_of
from exactfold.panels.vertex.vertex_motions import vertex_motion
from exactfold.pattern.panel_pattern import Edge, PanelPattern

_MOST_CELLS: Final = 64
_MOST_STARTS: Final = 8
_MOST_CASED: Final = 6
"""The nappes of up to so many vertices are distinguished."""
_MOST_FOLDS: Final = 1_200
"""From so many folds on, the search starts once only; with fewer folds it starts more often."""


@dataclass(frozen=True)
class PartAnswer:
    """Whether a part starts to fold with its letters, whether a finite motion starts so, and why.

    `starts` is about motions to second order, and `truly` about true motions of the panels. `ways`
    is the number of cells with these letters, or None if it is not known. `densities` is one such
    motion, approximately, and `motion` is one exactly if it is that of a vertex or was found in a
    linear space. `named` are the vertices that the reason names. `vertex` is a vertex that the
    theorem of Abel et al. refutes, where no vectors do. `by_list` says that the complete list of
    motions refutes the letters. `loop` is the loop that refutes the letters, if one does. `tree`
    are the cases of which each is refuted by one of the refutations, where there are several.
    """

    vertices: tuple[int, ...]
    starts: Verdict
    truly: Verdict
    reason: str = ""
    ways: int | None = None
    densities: Mapping[Edge, float] = field(default_factory=dict)
    refutations: tuple[PanelRefutation, ...] = ()
    named: tuple[int, ...] = ()
    loop: OpenLoop | None = None
    motion: Mapping[Edge, Number] = field(default_factory=dict, repr=False)
    vertex: int | None = None
    by_list: bool = False
    tree: tuple[tuple[str, Any], ...] = ()


def answered(
    pattern: PanelPattern,
    moving: Mapping[int, Star],
    letters: Letters,
    clock: Clock = UNLIMITED,
) -> PartAnswer:
    """The answer for one part of the sheet.

    Where some vertex has more than four folds, the part is cut at mountains and valleys that alone
    join their two sides. Motions of the two sides with the letters can be scaled so that they agree
    at this fold, and true motions can be followed at speeds such that they agree. So the part has
    the letters if and only if both sides have them.
    """
    if all(len(star.folds) <= 4 for star in moving.values()):
        return block_answer(pattern, moving, letters, clock)
    answers: list[PartAnswer] = []
    for vertices in blocks_of(moving, letters):
        answers.append(block_answer(pattern, {v: moving[v] for v in vertices}, letters, clock))
        if answers[-1].starts is REFUTED:
            return answers[-1]
    if len(answers) == 1:
        return answers[0]
    verdicts = {answer.starts for answer in answers}
    if UNDECIDED in verdicts:
        return next(answer for answer in answers if answer.starts is UNDECIDED)
    truly = PROVED if all(answer.truly is PROVED for answer in answers) else UNDECIDED
    return PartAnswer(tuple(moving), PROVED, truly, densities=_joined(answers))


def blocks_of(moving: Mapping[int, Star], letters: Letters) -> list[tuple[int, ...]]:
    """The vertices of the blocks between mountains and valleys that alone join their sides.

    Each block but the first shares such a fold with an earlier one.
    """
    graph = nx.Graph()
    graph.add_nodes_from(moving)
    inner = {e for star in moving.values() for e in star.folds if set(e) <= moving.keys()}
    graph.add_edges_from(sorted(inner))
    cuts = [e for e in nx.bridges(graph) if letters[edge_of(*e)] in "MV"]
    order = {v: k for k, v in enumerate(nx.dfs_preorder_nodes(graph, min(moving)))}
    graph.remove_edges_from(cuts)
    blocks = [tuple(sorted(block)) for block in nx.connected_components(graph)]
    return sorted(blocks, key=lambda block: min(order[v] for v in block))


def _joined(answers: Iterable[PartAnswer]) -> dict[Edge, float]:
    """The motions of the blocks, scaled so that they agree at the folds that join them."""
    total: dict[Edge, float] = {}
    for answer in answers:
        shared = next((edge for edge in answer.densities if edge in total), None)
        scale = 1.0 if shared is None else total[shared] / answer.densities[shared]
        total |= {edge: scale * x for edge, x in answer.densities.items() if edge not in total}
    return total


def block_answer(
    pattern: PanelPattern, moving: Mapping[int, Star], letters: Letters, clock: Clock
) -> PartAnswer:
    """The answer for one block; cheap proofs are tried first, until the clock has passed.

    The order is: single vertices; vectors that refute all first-order motions; loops of vertices
    with at most four folds, which are the complete answer if there are no other vertices; a
    candidate in floating point and its proof; the linear spaces of all motions, split as `count`
    splits them, which are a complete answer if they are few enough.
    """
    vertices = tuple(moving)
    few = all(len(star.folds) <= 4 for star in moving.values())
    # With at most four folds at each vertex, true motions lie in the cells to second order.
    no = REFUTED if few else UNDECIDED
    if not any(letters[edge] in "MV" for star in moving.values() for edge in star.folds):
        return PartAnswer(vertices, PROVED, PROVED, ways=None)
    if stuck := _stuck(moving, letters):
        return _refused_at(vertices, moving, stuck)
    for v, star in moving.items():
        if vertex_motion(star, letters) is None and {"M", "V"} & {letters[e] for e in star.folds}:
            text = f"vertex {v} cannot have its letters, whatever its free folds do"
            return PartAnswer(vertices, REFUTED, REFUTED, text, named=(v,), vertex=v)
    if len(vertices) == 1 and not few:
        (star,) = moving.values()
        if (motion := vertex_witness(star, letters)) is not None:
            return PartAnswer(vertices, PROVED, PROVED, densities=_floats(motion), motion=motion)
    program = FirstOrderProgram(moving, letters, clock)
    start = program.motion()
    if start is None and (refutation := program.refutation()) is not None:
        named = tuple(refutation.planes)
        return PartAnswer(
            vertices,
            REFUTED,
            no,
            _first_order_text(named),
            refutations=(refutation,),
            named=named,
        )
    if few:
        return _by_cells(pattern, moving, letters)
    if (loop := _loop(pattern, moving, letters)) is not None:
        return PartAnswer(vertices, REFUTED, REFUTED, loop.text, named=loop.loop, loop=loop)
    cases = NappeCases(moving, letters, clock)
    if len(vertices) <= _MOST_CASED and cases.refute():
        strict = all(letters[edge] in "MV" for edge in cases.folds)
        text = "in each nappe of the forms of these vertices, vectors contradict the letters"
        return PartAnswer(
            vertices,
            REFUTED,
            REFUTED if strict else UNDECIDED,
            f"{_where(vertices)}: {text}",
            refutations=tuple(cases.refutations),
            named=vertices,
            tree=tuple(cases.steps),
        )
    if start is not None and (proved := _found(program, start)) is not None:
        truly = PROVED if proved.folds else UNDECIDED
        return PartAnswer(vertices, PROVED, truly, densities=proved.densities)
    by_spaces = _by_spaces(pattern, moving, letters, clock)
    if by_spaces is not None:
        return by_spaces
    if start is None:
        text = "neither a first-order motion with these letters nor a refutation of one was found"
    else:
        text = (
            "some first-order motions have these letters, but no motion to second order that has "
            "them was proved"
        )
    if clock.passed:
        text += f"; {clock.said}"
    return PartAnswer(vertices, UNDECIDED, UNDECIDED, f"{_where(vertices)}: {text}")


def _found(program: FirstOrderProgram, start: Mapping[Edge, float]) -> ProvedMotion | None:
    """A proved motion, searched for from a first-order motion and then from several others."""
    search, folds = MotionSearch(program), len(program.folds)
    number = min(_MOST_STARTS, _MOST_FOLDS // folds)
    for begin in chain([start], program.extreme_motions(start, number)):
        if (near := search.found(begin)) is not None:
            proved = proved_motion(program.stars, program.letters, near)
            if proved is not None:
                return proved
    return None


def _by_spaces(
    pattern: PanelPattern, moving: Mapping[int, Star], letters: Letters, clock: Clock
) -> PartAnswer | None:
    """The answer of the complete list of spaces of motions; None if it is not obtained."""
    vertices = tuple(moving)
    try:
        starts, motion = LetteredSpaces(moving, letters, clock=clock).motion()
    except TooManyModesError:
        return None
    if starts is PROVED:
        truly = PROVED if truly_begin(pattern, moving, motion) else UNDECIDED
        return PartAnswer(vertices, PROVED, truly, densities=_floats(motion), motion=motion)
    if starts is UNDECIDED:
        return None
    text = "the list of its motions to second order is complete, and none has these letters"
    return PartAnswer(
        vertices,
        REFUTED,
        UNDECIDED if _weakly(moving, letters) else REFUTED,
        f"{_where(vertices)}: {text}",
        by_list=True,
    )


def _floats(motion: Mapping[Edge, Number]) -> dict[Edge, float]:
    """The densities of an exact motion in floats; the largest is 1 or -1."""
    densities = {edge: float(x) for edge, x in motion.items() if x}
    largest = max(map(abs, densities.values()), default=1.0)
    return {edge: x / largest for edge, x in densities.items()}


def _weakly(moving: Mapping[int, Star], letters: Letters) -> bool:
    """Whether some motion to second order, not 0, may have no fold bend against its letter.

    If none has, no true motion has the letters, because its terms of lowest order are such a
    motion.
    """
    try:
        return LetteredSpaces(moving, letters).moves_weakly()
    except TooManyModesError:
        return True


def _stuck(moving: Mapping[int, Star], letters: Letters) -> list[VertexReason]:
    reasons = (vertex_reason(star, letters) for star in moving.values())
    return [reason for reason in reasons if reason is not None]


def _refused_at(
    vertices: tuple[int, ...], moving: Mapping[int, Star], stuck: list[VertexReason]
) -> PartAnswer:
    """The answer refuted at single vertices; the reason names the vertex with the fewest folds.

    A vertex that has no motion to second order with its letters has no configuration with them near
    the flat state (docs/vertices.md, Theorem 1).
    """
    first = min(stuck, key=lambda reason: (len(moving[reason.vertex].folds), reason.vertex))
    more = len(stuck) - 1
    others = f"; {counted(more, 'vertex')} more cannot have their letters either" if more else ""
    return PartAnswer(
        vertices,
        REFUTED,
        REFUTED,
        f"{first.text}{others}",
        refutations=first.refutations,
        named=tuple(reason.vertex for reason in stuck),
    )


def _by_cells(pattern: PanelPattern, moving: Mapping[int, Star], letters: Letters) -> PartAnswer:
    """The answer of the structure theorem: all cells, if they are few, and which of them truly
    fold.
    """
    vertices = tuple(moving)
    try:
        search = CellSearch(moving, letters, pattern.field)
        cells = list(islice(search, _MOST_CELLS + 1))
    except (TooManyModesError, UndecidedDensityError) as error:
        return PartAnswer(vertices, UNDECIDED, UNDECIDED, f"{_where(vertices)}: {error}")
    if not cells:
        text = "no choice of a mode at each vertex makes the vertices fit together"
        loop = min(search.open_loops, key=lambda one: abs(one.off), default=None)
        return PartAnswer(
            vertices,
            REFUTED,
            REFUTED,
            loop.text if loop else text,
            named=loop.loop if loop else (),
            loop=loop,
        )
    known: Loops = {}
    folding: list[Verdict] = []
    chosen = cells[0]
    for cell in cells:
        folding.append(_extends(pattern, moving, cell, known))
        if folding[-1] is PROVED:
            chosen = cell
            break
    complete = len(cells) <= _MOST_CELLS
    if folding[-1] is PROVED:
        truly = PROVED
    else:
        truly = REFUTED if complete and set(folding) == {REFUTED} else UNDECIDED
    return PartAnswer(
        vertices,
        PROVED,
        truly,
        ways=len(cells) if complete else None,
        densities=chosen.densities,
    )


def _extends(
    pattern: PanelPattern, moving: Mapping[int, Star], cell: Cell, known: Loops
) -> Verdict:
    verdicts = {extension(pattern, moving, mode, known).verdict for mode in cell.modes}
    if REFUTED in verdicts:
        return REFUTED
    return UNDECIDED if UNDECIDED in verdicts else PROVED


def _loop(pattern: PanelPattern, moving: Mapping[int, Star], letters: Letters) -> OpenLoop | None:
    """Why the vertices with at most four folds cannot have these letters; None if they can.

    Only these vertices are considered. Folds that lead to other vertices have no condition there.
    """
    few = {v: star for v, star in moving.items() if len(star.folds) <= 4}
    if any(letters[edge] == "U" for star in few.values() for edge in star.folds):
        return None
    try:
        search = CellSearch(few, letters, pattern.field)
        if next(iter(search), None) is not None or not search.open_loops:
            return None
    except (TooManyModesError, UndecidedDensityError):
        return None
    return min(search.open_loops, key=lambda loop: abs(loop.off))


def _first_order_text(named: Iterable[int]) -> str:
    shown = [str(v) for v in named]
    where = ", ".join(shown[:12]) + (f" and {len(shown) - 12} more" if len(shown) > 12 else "")
    return (
        f"the vertices {where} cannot have their letters together, not even to first order: these "
        "mountains and valleys contradict that the folds around each of them close up"
    )


def _where(vertices: tuple[int, ...]) -> str:
    return f"the part of {counted(len(vertices), 'vertex')} with vertex {vertices[0]}"
