"""Sheets that may have been meant by drawings whose noise has no clear level."""

import json
import random
from dataclasses import replace
from math import exp, log
from pathlib import Path

import pytest
from jsonschema import Draft202012Validator
from noise_put_back import SHEETS, noisy, turned
from sampling import slow_after
from typer.testing import CliRunner

import exactfold
from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.app.cli import app
from exactfold.app.schemas import schema
from exactfold.panels.result import Decomposition
from exactfold.pattern.drawing.meant.levels import proposed_levels
from exactfold.pattern.drawing.meant.noise import TOLERANCE
from exactfold.pattern.meaning import proposals
from exactfold.pattern.opening import Opened
from exactfold.pattern.reading import Reading


def by_hand(name: str, seed: int = 0) -> dict[str, object]:
    """A sheet drawn by hand: vertices are off by 1e-6 to 1e-3 of the size, all sizes as likely."""
    rng = random.Random(seed)
    sheet, letters = exactfold.read(name).sheet, exactfold.read(name).letters
    size = max(float(max(c) - min(c)) for c in zip(*sheet.vertices, strict=True))

    def drawn(value: object) -> float:
        off = exp(rng.uniform(log(1e-6), log(1e-3)))
        return float(value) + size * rng.choice((-off, off))  # type: ignore[arg-type]

    return {
        "file_spec": 1.1,
        "vertices_coords": [[drawn(x), drawn(y)] for x, y in sheet.vertices],
        "edges_vertices": [list(edge) for edge in sheet.edges],
        "edges_assignment": [letters.get(edge, "B") for edge in sheet.edges],
    }


@pytest.mark.parametrize(("name", "seed"), slow_after(0, [("miura", 0), ("map-fold", 1)]))
def test_proposals_are_what_their_noise_level_gives(name: str, seed: int) -> None:
    document = by_hand(name, seed)
    opened = exactfold.read(document)
    assert opened.doubt
    made = proposals(opened, 60.0)
    assert made
    for level, sheet in made:
        assert sheet.meant is not None
        assert (sheet.meant.inferred, sheet.doubt) == (True, "")
        assert exactfold.read(document, noise=level).sheet == sheet.sheet


@pytest.mark.slow
def test_a_count_tells_a_proposal_and_stays_undecided() -> None:
    found = exactfold.count(by_hand("map-fold"))
    exact = exactfold.count("map-fold")
    assert isinstance(found, Decomposition)
    assert isinstance(exact, Decomposition)
    assert found.status is UNDECIDED
    assert found.proposal is not None
    answer = found.proposal.answer
    assert isinstance(answer, Decomposition)
    assert answer.second_order == exact.second_order
    assert found.proposal.distance < 2e-3
    document = json.loads(json.dumps(found.to_dict()))
    Draft202012Validator(schema("count")).validate(document)
    assert document["proposal"]["answer"]["components"]["true"] == {
        str(k): n for k, n in (exact.true or {}).items()
    }


@pytest.mark.slow
def test_a_proposal_is_printed_with_its_answer_and_no_claim_about_the_drawing(
    tmp_path: Path,
) -> None:
    path = tmp_path / "hand.fold"
    path.write_text(json.dumps(by_hand("square-twist")))
    result = CliRunner().invoke(app, ["count", str(path)])
    assert result.exit_code == 4
    said = " ".join(result.stdout.split())
    first, of_it = said.split("a proposal (--noise 0.001): ")
    assert first.startswith("the number of ways to fold is UNDECIDED")
    assert "nothing proves that it was meant" in of_it
    assert "of that sheet: rigid - PROVED" in of_it
    assert of_it.endswith("a loop of folds that was meant to close may miss by the noise")


def test_nothing_is_proposed_where_nothing_is_open() -> None:
    opened = exactfold.read(by_hand("miura"))

    def asked(reading: Reading) -> Opened:
        return replace(opened, reading=reading)

    assert proposals(exactfold.read("miura"), 9.0) == []
    assert proposals(asked(Reading(noise=1e-4)), 9.0) == []
    assert proposals(asked(Reading(snap=1000)), 9.0) == []
    assert proposals(asked(Reading(snap="exact")), 9.0) == []
    assert proposals(opened, -1.0) == []


@pytest.mark.parametrize("seed", range(30))
def test_a_level_cuts_the_defects_at_a_gap(seed: int) -> None:
    rng = random.Random(seed)
    defects = [exp(rng.uniform(log(1e-7), log(1e-2))) for _ in range(rng.randint(3, 60))]
    for level in proposed_levels(defects, 1e-2):
        accepted = [d for d in defects if d <= TOLERANCE * level]
        others = [d for d in defects if d > TOLERANCE * level] + [1e-2]
        assert len(accepted) >= 3
        assert min(others) >= 1.25 * max(accepted)


def test_no_level_is_proposed_without_near_relations() -> None:
    assert proposed_levels([], 1e-2) == []
    assert proposed_levels([0.0, 1e-6, 2e-6], 1e-2) == []


def test_a_loop_that_nearly_closes_gives_a_noise_level() -> None:
    """Nothing else about this sheet nearly holds; its loops close because of lengths on a grid."""
    result = exactfold.count(turned(noisy(SHEETS["tiling"], 1e-9)))
    assert isinstance(result, Decomposition)
    assert (result.status, result.known.rigid) == (UNDECIDED, PROVED)
    proposal = result.proposal
    assert proposal is not None
    assert proposal.noise == pytest.approx(1e-9)
    assert proposal.distance < 1e-8
    assert isinstance(proposal.answer, Decomposition)
    assert proposal.answer.true == {1: 2}
    assert proposal.others == (pytest.approx(1e-10),)
