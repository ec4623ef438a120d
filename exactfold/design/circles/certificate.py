"""Certificates of lists of all assignments, for `exactfold.checker`."""

from __future__ import annotations

from exactfold._support.progress import Progress
from exactfold._support.verdict import PROVED
from exactfold.certificates.entries import Document
from exactfold.design.circles.assignment_list import AllAssignments
from exactfold.design.circles.covering import NotCoveredError, covering, verified
from exactfold.errors import NotApplicableError


def assignments_certificate(
    listed: AllAssignments, *, progress: Progress | None = None
) -> Document:
    """The proof of a list of all assignments, as a JSON object.

    The proof consists of points all round the circles (docs/any_border.md, The certificate of all
    assignments). It is found independently of the list and
    has to show the same list. Raises `NotApplicableError` for a list that is not proved, and if no
    such points are found.

    >>> from exactfold import checker
    >>> from exactfold.design.circles.circles import all_assignments
    >>> from exactfold.pattern.families import single_vertex
    >>> document = assignments_certificate(all_assignments(single_vertex(5)))
    >>> len(checker.check(document)["assignments"])
    20
    """
    if listed.status is not PROVED:
        raise NotApplicableError(
            f"this list is {listed.status}; only a list that is proved has a certificate"
        )
    try:
        points = listed.points or covering(listed.pattern, progress)
        document = verified(listed.pattern, points)
    except NotCoveredError as error:
        raise NotApplicableError(str(error)) from None
    if points.assignments != listed.assignments:
        raise AssertionError("two ways to list all assignments of a sheet differ")
    return document
