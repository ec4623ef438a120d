"""`forcing_set`: the fewest folds whose letters force those of all others."""

from __future__ import annotations

from collections.abc import Mapping

from exactfold._support.verdict import PROVED
from exactfold.design.circles.assignment_list import AllAssignments
from exactfold.design.panels.panel_assignments import PanelAssignments, PartLetters
from exactfold.design.refutations.asked import by_fold
from exactfold.design.refutations.forcing import Forcing, forcing_folds, least_of_all
from exactfold.errors import NotApplicableError
from exactfold.pattern.crease_pattern import Edge


def forcing_set(
    listed: AllAssignments | PanelAssignments, letters: Mapping[Edge, str] | str | None = None
) -> Forcing:
    """A least set of folds whose letters leave no choice to the letters of all other folds.

    `listed` are all assignments of a sheet, and `letters` one of them: only this assignment has
    its letters at the folds of the set, and no smaller set has this property (Abel et al., Rigid
    origami vertices: conditions and forcing sets, J. Comput. Geom. 7, 2016). If `letters` is None,
    an assignment is taken that has a least set among all. All sets are examined, with integers
    only. Parts that move independently, and folds from boundary to boundary, add up. If some
    assignments are undecided, the set avoids them as well, and may be larger than necessary.

    Raises `NotApplicableError` if the assignments are not listed, there are none, the letters are
    not among them, or more than 20 folds move together; `UsageError` for letters that do not fit.

    >>> from exactfold.design import panel_assignments
    >>> found = forcing_set(panel_assignments("pinwheel-base"))
    >>> len(found.folds), found.at_least, found.status
    (3, 3, <Verdict.PROVED: 'proved'>)
    """
    parts = _one_part(listed) if isinstance(listed, AllAssignments) else listed.parts
    free: tuple[Edge, ...] = () if isinstance(listed, AllAssignments) else listed.free
    asked = None if letters is None else by_fold(listed.pattern.folds, letters)
    chosen = {fold: "M" if asked is None else asked[fold] for fold in free}
    folds, at_least = list(free), len(free)
    for part in parts:
        if part.reason:
            raise NotApplicableError(f"the assignments are not listed: {part.reason}")
        if not part.assignments:
            raise NotApplicableError("no assignment of M and V to all folds is proved to fold")
        if asked is None:
            text, places, lower = least_of_all(part.assignments, part.undecided)
        else:
            text = "".join(asked[fold] for fold in part.folds)
            if text not in part.assignments:
                raise NotApplicableError(
                    "these letters are not among the assignments that are proved to fold"
                )
            places, lower = forcing_folds(text, part.assignments, part.undecided)
        chosen |= dict(zip(part.folds, text, strict=True))
        folds += [part.folds[k] for k in places]
        at_least += lower
    return Forcing(dict(sorted(chosen.items())), tuple(sorted(folds)), at_least)


def _one_part(listed: AllAssignments) -> tuple[PartLetters, ...]:
    """The list of a sheet with five corners as one part, without the folds that are always flat."""
    texts = listed.assignments
    if listed.status is not PROVED:
        return (PartLetters((), (), (), listed.reason),)
    kept = [k for k in range(len(listed.pattern.folds)) if any(text[k] != "F" for text in texts)]
    folds = tuple(listed.pattern.folds[k] for k in kept)
    short = tuple("".join(text[k] for k in kept) for text in texts)
    return (PartLetters(folds, short, ()),)
