"""Forged lists of all assignments of panels: for each refusing line one that it alone stops."""

from __future__ import annotations

import random
from typing import Any

import networkx as nx
import pytest
from forge import Document, beyond, given, refused, stopped, verified, with_one_key_more

from exactfold import checker
from exactfold.checker.letters import panels_listed
from exactfold.checker.letters.panels_listed import blocks_of
from exactfold.design.panels.listed_certificate import panel_assignments_certificate
from exactfold.design.panels.panel_assignments import panel_assignments
from exactfold.errors import NotApplicableError
from exactfold.pattern.families import hypar
from exactfold.pattern.panel_entries import panels_document


def listed(name: str = "flat") -> Document:
    """A fresh copy of a certificate."""
    return given(f"assignments-panels-{name}")


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("twist", "12 assignments of mountains and valleys to 12 folds; for one of them 3 folds"),
        ("bridge", "40 assignments of mountains and valleys to 8 folds; for one of them 4 folds"),
        ("flat", "4 assignments of mountains and valleys to 5 folds; for one of them 2 folds"),
    ],
)
def test_what_is_said(name: str, text: str) -> None:
    claims = verified(listed(name))
    assert claims.items() >= listed(name)["claims"].items()
    said = checker.summary(claims)
    assert said.startswith(f"VALID: the sheet of rigid panels starts to fold with exactly {text}")
    assert " force the others, and no smaller set does; sha256 " in said
    document = listed(name)
    document["claims"]["forcing"] = None
    assert "force" not in checker.summary(verified(document))


@pytest.mark.parametrize("seed", range(30))
def test_blocks_are_those_between_bridges(seed: int) -> None:
    graph = nx.gnp_random_graph(12, 0.2, seed=random.Random(seed))
    graph = graph.subgraph(nx.node_connected_component(graph, 0)).copy()
    near = {v: [*graph[v], 100 + v] for v in graph}
    blocks = blocks_of(near)
    graph.remove_edges_from(list(nx.bridges(graph)))
    assert sorted(map(sorted, blocks)) == sorted(map(sorted, nx.connected_components(graph)))
    assert all(block[v] == near[v] for block in blocks for v in block)


@pytest.mark.parametrize(
    ("place", "message"),
    [
        (("claims",), "claims: expected an object with the keys number parts free flat forcing"),
        (("claims", "parts", 0), "a part: expected an object with the keys folds assignments"),
        (("claims", "forcing"), "forcing: expected an object with the keys letters folds"),
    ],
)
def test_keys(place: tuple[str | int, ...], message: str) -> None:
    refused(with_one_key_more(listed(), place), message)


def test_all_assignments_are_listed_and_no_others() -> None:
    message = "there are 12 assignments of the part of fold 4-5, not those listed"
    for texts in (lambda all_: all_[1:], lambda all_: all_[::-1], lambda all_: [*all_, "M" * 12]):
        document = listed("twist")
        [part] = document["claims"]["parts"]
        part["assignments"] = texts(part["assignments"])
        stopped(document, message)
    refused(
        {**listed("twist"), "claims": listed("fish")["claims"]}, "parts does not have 1 entries"
    )


def test_folds_and_numbers_are_those_of_the_sheet() -> None:
    document = listed()
    [part] = document["claims"]["parts"]
    assert part["folds"] == [[0, 5], [2, 5], [3, 5], [4, 5]]
    part["folds"] = part["folds"][::-1]
    message = "the folds of a part are [[0, 5], [2, 5], [3, 5], [4, 5]], not those listed"
    stopped(document, message)
    for key, forged, right in (
        ("number", 8, 4),
        ("number", "4", 4),
        ("free", [], [[0, 2]]),
        ("flat", [], [[0, 6], [1, 6], [2, 6]]),
    ):
        document = listed()
        document["claims"][key] = forged
        stopped(document, f"claim {key} = {forged!a}, but it is {right!a}")


def test_motions_of_blocks_with_several_vertices_are_lines() -> None:
    sheet = panel_assignments(hypar(1)).pattern
    document = listed()
    document["pattern"] = panels_document(sheet)
    texts = panel_assignments(hypar(1)).parts[0].assignments
    document["claims"] = {"number": 32, "free": [], "flat": [], "forcing": None}
    document["claims"]["parts"] = [{"folds": [], "assignments": list(texts)}]
    document["claims"]["parts"][0]["folds"] = [list(fold) for fold in sheet.folds]
    refused(document, "the motions of the block of vertex 4 are not lines only")


def test_limits(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(panels_listed, "MOST_ASSIGNMENTS", 39)
    message = beyond("the assignments of a part", 40, 39, "MOST_ASSIGNMENTS")
    stopped(listed("bridge"), message)
    monkeypatch.setattr(panels_listed, "MOST_STEPS", 3)
    stopped(listed(), beyond("the letters tried at vertex 5", 4, 3, "LETTER_STEPS"))


def test_the_search_for_smaller_forcing_sets_is_not_endless(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(panels_listed, "MOST_STEPS", 2)
    message = beyond("the steps to a smaller forcing set", 3, 2, "LETTER_STEPS")
    stopped(listed("twist"), message)


def forcing(name: str, **changes: Any) -> Document:
    """A certificate with another claim of a forcing set."""
    document = listed(name)
    document["claims"]["forcing"] |= changes
    return document


def test_letters_are_forced_of_one_assignment() -> None:
    assert listed()["claims"]["forcing"] == {"letters": "MVFFVFVM", "folds": [[0, 2], [0, 5]]}
    for letters, fold, letter in (("MVMFVFVM", "0-6", "M"), ("UVFFVFVM", "0-2", "U")):
        said = f"fold {fold} has the letter {letter!a}, which cannot be"
        stopped(forcing("flat", letters=letters), said)
    refused(forcing("flat", letters="VFFVFVM"), "letters does not have 8 entries")
    folds = [[0, 2], [0, 5], [4, 5]]
    document = forcing("flat", letters="MVFFVFVV", folds=folds)
    stopped(document, "the letters that are forced are no assignment")


def test_folds_force_all_others() -> None:
    folds = listed("twist")["claims"]["forcing"]["folds"]
    stopped(forcing("twist", folds=folds[1:]), "the folds do not force all others")
    stopped(forcing("flat", folds=[[0, 5]]), "a free fold is not among those that force others")
    more = sorted([*listed()["claims"]["forcing"]["folds"], [0, 6]])
    stopped(forcing("flat", folds=more), "a fold that stays flat is among those that force others")


def test_no_smaller_set_forces_the_others() -> None:
    every = [[i, j] for i, j in listed("twist")["claims"]["parts"][0]["folds"]]
    stopped(forcing("twist", folds=every), "a smaller set of folds forces all others, too")
    with pytest.raises(checker.CertificateError):
        verified(forcing("twist", folds=every[:4]))


def test_a_list_that_is_not_found_again_has_no_certificate() -> None:
    with pytest.raises(NotApplicableError, match="the checker does not find the list again"):
        panel_assignments_certificate(panel_assignments(hypar(1)))
