"""`exactfold info`: reports facts about a sheet that are known without solving."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

from exactfold.app import report
from exactfold.app.options.patterns import InfoOptions
from exactfold.app.shell.patterns import read_any
from exactfold.app.shell.shell import Bar, name_of
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.opening import has_branches, panels
from exactfold.rigidity.facts import PatternFacts, PatternFactsDocument, pattern_facts

if TYPE_CHECKING:
    from exactfold.branches.counting.motion_facts import (
        DecomposedFactsDocument,
        PanelFacts,
        PanelFactsDocument,
    )
    from exactfold.pattern.panel_pattern import PanelPattern


class BranchesFactsDocument(PatternFactsDocument):
    """The facts of a sheet that has branches; keys for sheets of panels are null."""

    panels: None
    field: None
    flat_folds: None
    free_folds: None
    parts: None
    expected: str


def show_info(asked: InfoOptions) -> None:
    """Print the facts of a sheet. Raises the errors of `read_any`.

    If `count` decomposes the motions of a triangulated sheet, both its facts as a triangulated
    sheet and its facts as a sheet of panels are printed.
    """
    name, exact = name_of(asked.file), asked.exact
    with Bar("reading") as bar:
        sheet = read_any(asked.file, asked.reading).sheet
        data: BranchesFactsDocument | DecomposedFactsDocument | PanelFactsDocument
        if not isinstance(sheet, CreasePattern):
            motions = _motions(sheet)
            data = motions.to_dict(name)
            table = report.panels_info(motions, exact=exact)
        else:
            facts = pattern_facts(sheet, bar)
            both = None
            if has_branches(sheet):
                data = _of_branches(facts, name)
            else:
                both = _motions(panels(sheet))
                expected = report.expectation(facts, both)
                data = {**facts.to_dict(name), **both.keys(), "expected": expected}
            table = report.info_report(facts, both, exact=exact)
    if asked.as_json:
        print(json.dumps(data))
    else:
        report.show(table)


def _motions(pattern: PanelPattern) -> PanelFacts:
    from exactfold.branches.counting.motion_facts import (
        panel_facts,  # imported here: sheets with branches do not need it
    )

    return panel_facts(pattern)


def _of_branches(facts: PatternFacts, name: str) -> BranchesFactsDocument:
    return {
        **facts.to_dict(name),
        "panels": None,
        "field": None,
        "flat_folds": None,
        "free_folds": None,
        "parts": None,
        "expected": report.expectation(facts),
    }
