"""exactfold: in how many ways a crease pattern starts to fold, and which of them go on, proved.

    read       a crease pattern from a file, FOLD text, or by the name of a shipped pattern
    count      in how many ways it starts to fold, proved, with the ways
    branch     one way of a triangulated sheet, by vertex signs, letters or number
    decompose  the ways of a sheet whose panels stay rigid
    match      which ways have given mountains and valleys, or why none has
    vertices   which vertices fold with their letters, and what to change at the others
    flat       the flat-folded states of a sheet, with their layers, or why there is none
    actuate    torques that drive a sheet along one way and no other
    tolerance  how far vertices may move before the ways or their letters change
    follow     the motion along a way, in space
    prove      a motion proved, with its first contact
    loops      all motions that come back to the flat sheet, proved
    check      a certificate verified by the stand-alone checker
    draw       a sheet, a way, all ways or a motion as a picture
    view       a page that shows the sheet as it folds

Where a verb takes a sheet, any will do: what `read` takes, or what it returns. Every result has a
`status`, which is `PROVED`, `REFUTED` or `UNDECIDED`, a `reason` in words, and `to_dict()`, the
document that the command prints with --json. Where evidence can be written, `certificate()` makes
it.

>>> import exactfold
>>> result = exactfold.count("two-vertex")
>>> result
<BranchCount: proved, 4 branches, <CreasePattern: 2 interior and 4 boundary vertices>>
>>> [branch.sign_text for branch in result]
['--', '-+', '+-', '++']
>>> exactfold.follow(result, 3)
<Motion: branch +-, 60 frames to flat-fold at 3.01547>

Each engine is in a room of its own, such as `exactfold.solve.groebner` and
`exactfold.motion.follow_panels`; the documentation lists them all.
"""

from exactfold._support.lazy import attached as _attached

__version__ = "0.1.0"

__getattr__, __dir__ = _attached(__name__)
