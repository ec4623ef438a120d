"""exactfold: proven branch counts of triangulated origami near the unfolded state.

Given a flat triangulated sheet with rational coordinates, `count_branches` says in how many ways it
starts to fold, proves it, and tells the ways apart by vertex signs and mountain-valley assignments.

>>> import exactfold
>>> result = exactfold.count_branches("two-vertex")
>>> result
<BranchCount: proved, 4 branches, <CreasePattern: 2 interior and 4 boundary vertices>>
>>> [branch.sign_text for branch in result.branches]
['--', '-+', '+-', '++']

Here is what counting branches takes. The engines are in rooms of their own, such as
`exactfold.solve.groebner` and `exactfold.solve.krawczyk`; the documentation lists them all.
"""

from exactfold._support.lazy import attached as _attached

__version__ = "0.1.0"

__getattr__, __dir__ = _attached(__name__)
