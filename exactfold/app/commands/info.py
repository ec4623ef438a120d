"""`exactfold info`: reports facts about a sheet that are known without solving."""

from __future__ import annotations

import json
from typing import TypedDict

from exactfold.app import report
from exactfold.app.options.patterns import InfoOptions
from exactfold.app.shell.patterns import read_any
from exactfold.app.shell.shell import Bar, name_of
from exactfold.branches.counting.motion_facts import (
    DecomposedFactsDocument,
    PanelFactsDocument,
    panel_facts,
)
from exactfold.design.panels.vertex.document import VerticesSummary
from exactfold.design.panels.vertex.vertices import vertices
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.opening import has_branches, panels
from exactfold.rigidity.facts import PatternFacts, PatternFactsDocument, pattern_facts


class VertexKeys(TypedDict):
    """What is known of the vertices, each by itself."""

    vertices: VerticesSummary


class BranchesFactsDocument(PatternFactsDocument, VertexKeys):
    """The facts of a sheet that has branches; keys for sheets of panels are null."""

    panels: None
    field: None
    flat_folds: None
    free_folds: None
    parts: None
    expected: str


class DecomposedInfoDocument(DecomposedFactsDocument, VertexKeys):
    """The facts of a triangulated sheet whose motions are decomposed."""


class PanelInfoDocument(PanelFactsDocument, VertexKeys):
    """The facts of a sheet of rigid panels; keys for triangulated sheets are null."""


def show_info(asked: InfoOptions) -> None:
    """Print the facts of a sheet. Raises the errors of `read_any`.

    If `count` decomposes the motions of a triangulated sheet, both its facts as a triangulated
    sheet and its facts as a sheet of panels are printed.
    """
    name, exact = name_of(asked.file), asked.exact
    with Bar("reading") as bar:
        opened = read_any(asked.file, asked.reading, verbose=asked.verbose, doubted=asked.as_json)
        sheet, found = opened.sheet, vertices(opened)
        data: BranchesFactsDocument | DecomposedInfoDocument | PanelInfoDocument
        alone: VertexKeys = {"vertices": found.summary}
        if not isinstance(sheet, CreasePattern):
            motions = panel_facts(sheet)
            data = {**motions.to_dict(name), **alone}
            table = report.panels_info(motions, found, exact=exact)
        else:
            facts = pattern_facts(sheet, bar)
            both = None
            if has_branches(sheet):
                data = _of_branches(facts, alone, name)
            else:
                both = panel_facts(panels(sheet))
                expected = report.expectation(facts, both)
                data = {**facts.to_dict(name), **both.keys(), "expected": expected, **alone}
            table = report.info_report(facts, found, both, exact=exact)
    if asked.as_json:
        print(json.dumps(data))
    else:
        report.show(table)


def _of_branches(facts: PatternFacts, alone: VertexKeys, name: str) -> BranchesFactsDocument:
    return {
        **facts.to_dict(name),
        **alone,
        "panels": None,
        "field": None,
        "flat_folds": None,
        "free_folds": None,
        "parts": None,
        "expected": report.expectation(facts),
    }
