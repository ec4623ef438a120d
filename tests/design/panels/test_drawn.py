"""The drawn letters of a sheet whose ways are not all known: answered with the count."""

import json

import pytest

import exactfold
from exactfold._support.verdict import PROVED, REFUTED, UNDECIDED
from exactfold.design.panels.match import PanelMatch
from exactfold.panels.decomposition import decompose
from exactfold.panels.result import Decomposition
from exactfold.pattern.panel_pattern import Edge, PanelPattern

pytestmark = pytest.mark.usefixtures("without_spaces")


def boxes(size: int) -> PanelPattern:
    """A square grid, with a diagonal in each third square."""
    up = size + 1
    edges = [(i * up + j, (i + 1) * up + j) for i in range(size) for j in range(up)]
    edges += [(j * up + i, j * up + i + 1) for i in range(size) for j in range(up)]
    squares = [(i, j) for i in range(size) for j in range(size) if (i + 2 * j) % 3 == 0]
    edges += [(i * up + j, i * up + j + up + 1) for i, j in squares]
    return PanelPattern([(i, j) for i in range(up) for j in range(up)], edges)


def drawing(pattern: PanelPattern, letters: dict[Edge, str]) -> dict[str, object]:
    return {
        "file_spec": 1.1,
        "vertices_coords": [[float(x), float(y)] for x, y in pattern.vertices],
        "edges_vertices": [list(edge) for edge in pattern.edges],
        "edges_assignment": [letters.get(edge, "B") for edge in pattern.edges],
    }


def counted(letters: dict[Edge, str], **more: float) -> Decomposition:
    found = exactfold.count(drawing(boxes(5), letters), **more)
    assert isinstance(found, Decomposition)
    return found


def by_letter(letter: str) -> dict[Edge, str]:
    return dict.fromkeys(boxes(5).folds, letter)


@pytest.mark.slow
def test_all_valleys_are_refuted_and_the_bounds_are_those_of_the_sheet() -> None:
    found = counted(by_letter("V"))
    assert found.status is UNDECIDED
    assert found.drawn is not None
    assert (found.drawn.starts, found.drawn.truly) == (REFUTED, REFUTED)
    assert found.freedom == decompose(found.pattern).freedom
    data = found.to_dict()
    assert data["drawn"] == json.loads(json.dumps(found.drawn.to_dict()))
    assert (data["drawn"] or {})["starts"] == "refuted"


@pytest.mark.slow
def test_a_way_that_was_found_is_proved_as_drawn() -> None:
    """The letters of a mode that truly folds; all other folds are drawn as flat."""
    mode = counted(by_letter("U")).modes[0]
    matched = exactfold.match(
        drawing(boxes(5), by_letter("V")), by_letter("F") | dict(mode.assignment)
    )
    assert matched.starts is PROVED  # type: ignore[union-attr]
    flat = {edge for edge in boxes(5).folds if edge not in mode.assignment}
    drawn = counted(by_letter("U") | dict(mode.assignment)).drawn
    assert flat
    assert drawn is not None
    assert drawn.starts is not REFUTED


def test_creases_that_fold_together_as_drawn_while_the_others_stay_flat() -> None:
    """They are proved by `match` with the letter F for all others."""
    found = counted(by_letter("V"))
    assert found.drawn is not None
    together = found.drawn.together
    assert len(together) > 5
    matched = exactfold.match(
        drawing(boxes(5), by_letter("U")), by_letter("F") | dict.fromkeys(together, "V")
    )
    assert isinstance(matched, PanelMatch)
    assert (matched.starts, matched.truly) == (PROVED, PROVED)


@pytest.mark.slow
def test_without_letters_or_with_a_complete_answer_nothing_is_said() -> None:
    assert counted(by_letter("U")).drawn is None
    complete = exactfold.count("miura")
    assert isinstance(complete, Decomposition)
    assert complete.drawn is None


def test_a_limit_stops_the_search_and_not_the_quick_proofs() -> None:
    found = counted(by_letter("V"), limit=1e-9)
    assert "(--limit), was used up" in found.reason
    assert found.drawn is not None
    assert found.drawn.starts is REFUTED
    assert found.freedom is not None
    assert found.freedom.least == 3
