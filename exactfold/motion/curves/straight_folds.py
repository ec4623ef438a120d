"""Branches that fold a sheet along one straight line; their motion is a rotation about the line."""

from __future__ import annotations

from exactfold.branches.values.branch import Branch
from exactfold.pattern.validate import orientation


def straight_fold(branch: Branch) -> tuple[int, ...]:
    """The vertices of the line along which a branch folds its sheet; empty if there is none.

    The folds that are not proved flat have to form a straight path from boundary to boundary. Then
    all faces on either side of the path stay in one plane. Turning one side about the line moves
    all faces rigidly, so there is exactly a motion for every angle (docs/motion.md, 13).
    Coordinates are compared exactly.

    >>> from exactfold.branches.counting.find import find_branch
    >>> [straight_fold(find_branch("flat-vertex", signs)) for signs in ("+0", "-+")]
    [(0, 4, 2), ()]
    """
    pattern = branch.pattern
    beside: dict[int, list[int]] = {}
    for (i, j), letter in branch.assignment.items():
        if letter != "F":
            beside.setdefault(i, []).append(j)
            beside.setdefault(j, []).append(i)
    ends = [v for v, others in beside.items() if len(others) == 1]
    if len(ends) != 2 or not set(ends) <= set(pattern.boundary):
        return ()
    path = [min(ends)]
    while others := [v for v in beside[path[-1]] if v not in path[-2:]]:
        if len(others) > 1 or len(path) > len(beside):
            return ()
        path.append(others[0])
    points, _ = pattern.integer_vertices
    first, last = points[path[0]], points[path[-1]]
    straight = all(orientation(first, points[v], last) == 0 for v in path)
    return tuple(path) if straight and len(path) == len(beside) else ()
