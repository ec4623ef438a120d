"""Every exception of exactfold: one class for each kind of cause, which its message names.

All derive from `ExactfoldError`. `InputError` means that the input is at fault (exit code 3 on the
command line); where a vertex, edge or face is to blame, its indices are attributes of the error.
"""

from __future__ import annotations

from collections.abc import Sequence


class ExactfoldError(Exception):
    """Base class of every error raised on purpose by exactfold."""


class InputError(ExactfoldError):
    """The input is at fault; nothing was written."""


class UsageError(ExactfoldError):
    """The call asks for something that does not exist or does not apply (exit code 2).

    Such as an unknown study, numbers of rows that do not fit the sizes, or mountain-valley letters
    that do not fit the folds.
    """


class SolverError(ExactfoldError):
    """A solver failed, or what it returned is malformed or does not hold; the input is in order.

    Such as points of the wrong shape, a parametrisation or a dual space that does not satisfy its
    system, or an answer of msolve that is not understood.
    """


# --- numbers -------------------------------------------------------------------------------------


class NumberError(InputError, ValueError):
    """Text, NaN, Infinity or another object that is not a rational number."""


class FloatRefusedError(NumberError, TypeError):
    """A binary float was given where an exact number is needed."""


# --- files ---------------------------------------------------------------------------------------


class UnreadableFileError(InputError):
    """A file does not exist or cannot be read.

    For text that is neither a file nor the name of an example the message lists the names.
    """


class UnwritableFileError(InputError):
    """An output path cannot be written."""


class FoldError(InputError):
    """A FOLD file that this reader does not accept.

    Coordinates off the plane or irrational, faces with more than three sides, edges that cross, are
    no side of a face, or are cut.
    """


class NotFoldError(FoldError):
    """A file that is not JSON or is cut off, or JSON without the structure of a FOLD file."""


class MissingCoordinatesError(FoldError):
    """`vertices_coords` is absent, or a vertex has no coordinates."""


class StaleExactCoordinatesError(FoldError):
    """`vertices_exactfold:coords` contradicts `vertices_coords`: another program moved a vertex."""


class FoldedStateError(FoldError):
    """The coordinates of a folded state where a crease pattern is needed."""


class TooLargeError(InputError):
    """A file asks for more than a limit; the message names the limit, and what the file has."""


class UnknownFormatError(InputError):
    """A file in no format that is read; the message lists those that are."""


class MalformedDrawingError(InputError):
    """A file of a known format without lines of a crease pattern that can be understood.

    Lines are damaged, there are none, or a crease is curved: panels between curved creases cannot
    be rigid.
    """


class SeveralSheetsError(InputError):
    """A drawing holds several sheets and none was chosen, or one that is not there was."""


class CertificateFormatError(InputError):
    """The file is not a certificate of a known format and version."""


class BadRimError(InputError):
    """Heights of the border that cannot be taken; `vertices` are those to blame.

    A boundary vertex has none, they belong to other vertices, they are not numbers, or they lie in
    one plane: without angle deficits the sheet is flat then.
    """

    def __init__(self, message: str, vertices: Sequence[int] = ()) -> None:
        super().__init__(message)
        self.vertices = tuple(vertices)


class BadDriveError(InputError):
    """Folds or angles that cannot be driven; `folds` are those to blame."""

    def __init__(self, message: str, folds: Sequence[tuple[int, int]] = ()) -> None:
        super().__init__(message)
        self.folds = tuple(folds)


class BadCurvatureError(InputError):
    """Angle deficits that cannot be taken; `vertices` are those to blame.

    They are not numbers, belong to no interior vertex, or are negative: vertex signs do not name a
    shape then.
    """

    def __init__(self, message: str, vertices: Sequence[int] = ()) -> None:
        super().__init__(message)
        self.vertices = tuple(vertices)


class ClusterError(InputError):
    """A cluster that does not answer, has no workers, or workers that cannot do the work."""


class ForeignJournalError(InputError):
    """A file to be resumed or read belongs to another pattern, study or version, or is damaged.

    It may also be of another kind, that is no journal.
    """


class JournalInUseError(InputError):
    """Another run is writing the file; this one has left it alone."""


# --- studies -------------------------------------------------------------------------------------


class RowFailedError(ExactfoldError):
    """Rows of a study ended with an error; all others were written."""


# --- patterns ------------------------------------------------------------------------------------


class PatternError(InputError):
    """The vertices and triangles are not a flat triangulated disk.

    Attributes `vertices`, `edges` and `faces` hold the indices to blame (possibly empty).
    """

    def __init__(
        self,
        message: str,
        *,
        vertices: Sequence[int] = (),
        edges: Sequence[tuple[int, int]] = (),
        faces: Sequence[int] = (),
    ) -> None:
        super().__init__(message)
        self.vertices = tuple(vertices)
        self.edges = tuple(edges)
        self.faces = tuple(faces)


class MalformedPatternError(PatternError):
    """Vertices or triangles that make no list of corners.

    They are not pairs or not triples, an index is out of range, two vertices lie at the same point,
    a vertex belongs to no triangle, or the points span no triangle.
    """


class DegenerateFaceError(PatternError):
    """A triangle of zero area or with a repeated vertex."""


class OverlapError(PatternError):
    """Faces overlap, some of them clockwise, or the boundary of the sheet meets itself."""


class NotADiskError(PatternError):
    """The faces do not form one disk.

    An edge lies on three or more faces, the sheet has a hole, or it hangs together at a vertex by a
    point only.
    """


class DisconnectedError(NotADiskError):
    """Two or more separate sheets."""


class NotApplicableError(ExactfoldError):
    """A construction or method does not apply to this pattern; the message says why."""


class FlatVertexError(NotApplicableError):
    """A branch with a vertex that is proved flat is a multiple root: no curve is known there."""


class NotProvedAtTheFlatStateError(NotApplicableError):
    """No tube was proved from the flat state, or not which branch it belongs to."""


class NotCountedError(NotApplicableError):
    """The sheet is in order, but of a kind whose branches are not listed or named (exit code 4).

    It has larger panels or irrational coordinates where triangles are needed, no interior vertex,
    or more branches than torques for one of them can be compared on.
    """


class NotFollowedError(NotApplicableError):
    """A sheet that is not followed: a branch that is not simple, or no mode that truly folds.

    Or no branch was found on which the driven folds `folds` start in their ratio.
    """

    def __init__(self, message: str, folds: Sequence[tuple[int, int]] = ()) -> None:
        super().__init__(message)
        self.folds = tuple(folds)


class UndecidedBranchError(ExactfoldError):
    """A branch that is not proved was to be exported, followed or compared (exit code 4).

    Torques for a branch need all others proved, too, and told apart from it.
    """


class TooManyModesError(ExactfoldError):
    """A search for the motions of a sheet of panels was given up; the message says where."""


# --- processes and packages ----------------------------------------------------------------------


class WorkerDiedError(ExactfoldError):
    """A worker process was killed or ran out of memory; nothing that was written is lost."""


class NotEnoughMemoryError(WorkerDiedError):
    """Memory is limited, and there is not enough of it; nothing that was written is lost."""


class PackageMissingError(ExactfoldError):
    """An optional package or program is not installed; the message says how to get it."""
