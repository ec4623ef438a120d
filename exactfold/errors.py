"""Every exception of exactfold: one class for each kind of cause; the message names the cause.

All exceptions derive from `ExactfoldError`. `InputError` means that the input is at fault (exit
code 3 on the command line). If a vertex, edge or face is to blame, its index is an attribute of the
error.
"""

from __future__ import annotations

from collections.abc import Sequence


class ExactfoldError(Exception):
    """The base class of all errors that exactfold raises on purpose."""


class InputError(ExactfoldError):
    """The input is at fault; nothing was written."""


class UsageError(ExactfoldError):
    """The call asks for something that does not exist or does not apply (exit code 2).

    Examples are an unknown study, numbers of rows that do not fit the sizes, and mountain-valley
    letters that do not fit the folds.
    """


class SolverError(ExactfoldError):
    """A solver failed, or its result is malformed or false; the input is in order.

    Examples are points of the wrong shape, a parametrisation or a dual space that does not satisfy
    its system, and an answer of msolve that cannot be read.
    """


# --- numbers -------------------------------------------------------------------------------------


class NumberError(InputError, ValueError):
    """A text, NaN, Infinity or another object is not a rational number."""


class FloatRefusedError(NumberError, TypeError):
    """A binary float was given, but an exact number is needed."""


# --- files ---------------------------------------------------------------------------------------


class UnreadableFileError(InputError):
    """A file does not exist or cannot be read.

    If a text is neither a file nor the name of an example, the message lists the names.
    """


class UnwritableFileError(InputError):
    """An output file cannot be written."""


class FoldError(InputError):
    """A reader does not accept a FOLD file.

    Coordinates are irrational or not in one plane, or faces have more than three sides, or edges
    cross, are cut, or are not a side of a face.
    """


class NotFoldError(FoldError):
    """A file is not JSON or is cut off, or its JSON does not have the structure of a FOLD file."""


class MissingCoordinatesError(FoldError):
    """`vertices_coords` is absent, or a vertex has no coordinates."""


class StaleExactCoordinatesError(FoldError):
    """`vertices_exactfold:coords` contradicts `vertices_coords`: another program moved a vertex."""


class FoldedStateError(FoldError):
    """The coordinates are those of a folded state, but a crease pattern is needed."""


class TooLargeError(InputError):
    """A file exceeds a limit; the message names the limit, and the number in the file."""


class UnknownFormatError(InputError):
    """A file has none of the formats that exactfold reads; the message lists these formats."""


class MalformedDrawingError(InputError):
    """A file of a known format does not contain readable lines of a crease pattern.

    Lines are damaged, or there are none, or a crease is curved: panels between curved creases
    cannot be rigid.
    """


class SeveralSheetsError(InputError):
    """A drawing has several sheets and none was chosen, or the chosen sheet does not exist.

    `sheets` is the number of sheets to choose from, and `known` says which they are; 0 if another
    choice was made.
    """

    def __init__(self, message: str, sheets: int = 0, known: str = "") -> None:
        super().__init__(message)
        self.sheets = sheets
        self.known = known


class CertificateFormatError(InputError):
    """A file is not a certificate of a known format and version."""


class BoundaryHeightsError(InputError):
    """Boundary heights cannot be used; `vertices` are the vertices to blame.

    A boundary vertex has no height, or other vertices have one, or a height is not a number, or all
    heights lie in one plane. In the last case the sheet is flat, unless there are angle deficits.
    """

    def __init__(self, message: str, vertices: Sequence[int] = ()) -> None:
        super().__init__(message)
        self.vertices = tuple(vertices)


class PointsError(InputError):
    """A file of points for `exactfold certify` does not fit the system."""


class BadDriveError(InputError):
    """Folds or angles cannot be driven; `folds` are the folds to blame."""

    def __init__(self, message: str, folds: Sequence[tuple[int, int]] = ()) -> None:
        super().__init__(message)
        self.folds = tuple(folds)


class BadCurvatureError(InputError):
    """Angle deficits cannot be used; `vertices` are the vertices to blame.

    A deficit is not a number, belongs to a vertex that is not interior, or is negative. For a
    negative deficit, vertex signs do not name a shape.
    """

    def __init__(self, message: str, vertices: Sequence[int] = ()) -> None:
        super().__init__(message)
        self.vertices = tuple(vertices)


class ClusterError(InputError):
    """A cluster does not answer, has no workers, or its workers cannot do the work."""


class ForeignJournalError(InputError):
    """A file to be continued or read belongs to another pattern, study or version, or is damaged.

    It may also be a file of another kind, which is not a journal.
    """


class JournalInUseError(InputError):
    """Another run is writing the file; this run did not change it."""


# --- studies -------------------------------------------------------------------------------------


class RowFailedError(ExactfoldError):
    """Rows of a study ended with an error; all other rows were written."""


# --- patterns ------------------------------------------------------------------------------------


class PatternError(InputError):
    """The vertices and triangles do not form a flat triangulated disk.

    The attributes `vertices`, `edges` and `faces` hold the indices to blame; they may be empty.
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
    """The vertices or triangles do not form a list of points and corners.

    Vertices are not pairs, triangles are not triples, an index is out of range, two vertices are at
    the same point, a vertex belongs to no triangle, or the points span no triangle.
    """


class DegenerateFaceError(PatternError):
    """A triangle has zero area or repeats a vertex."""


class OverlapError(PatternError):
    """Faces overlap, or some of them are clockwise, or the boundary of the sheet meets itself."""


class NotADiskError(PatternError):
    """The faces do not form one disk.

    An edge belongs to three or more faces, or the sheet has a hole, or parts of it hang together
    only by a vertex.
    """


class DisconnectedError(NotADiskError):
    """There are two or more separate sheets."""


class StuckPlatesError(PatternError):
    """Panels of this thickness cannot be made of a sheet, or stop it in the flat state.

    They would meet at a fold as soon as it turns, or nothing is left of a panel that is cut back
    from its folds.
    """


class NotPeriodicError(PatternError):
    """The faces of a cell and their translates do not cover the plane, each point once.

    The lattice vectors are parallel, an edge does not have one face on each side, or faces overlap.
    """


class NotApplicableError(ExactfoldError):
    """A construction or method does not apply to this pattern; the message says why."""


class FlatVertexError(NotApplicableError):
    """A vertex is proved flat on the branch, which is then a multiple root: no curve is known."""


class NotProvedAtTheFlatStateError(NotApplicableError):
    """No tube was proved from the flat state, or it was not proved to which branch it belongs."""


class NotCountedError(NotApplicableError):
    """The sheet is in order, but exactfold does not list or name its branches (exit code 4).

    Triangles are needed, but the sheet has larger panels or irrational coordinates; or it has no
    interior vertex; or it has too many branches to compare torques for one of them.
    """


class NotFollowedError(NotApplicableError):
    """A sheet cannot be followed: its branch is not simple, or no mode extends to a finite flex.

    It is also raised if no branch was found on which the driven `folds` start in the given ratio.
    """

    def __init__(self, message: str, folds: Sequence[tuple[int, int]] = ()) -> None:
        super().__init__(message)
        self.folds = tuple(folds)


class UndecidedBranchError(ExactfoldError):
    """A branch was to be exported, followed or compared, but is not proved (exit code 4).

    Torques for a branch also need proofs of all other branches, and that these differ from it.
    """


class TooManyModesError(ExactfoldError):
    """A search for the motions of a sheet of panels was stopped; the message says where."""


# --- processes and packages ----------------------------------------------------------------------


class WorkerDiedError(ExactfoldError):
    """A worker process was killed or ran out of memory; nothing that was written is lost."""


class NotEnoughMemoryError(WorkerDiedError):
    """Memory is limited, and there is not enough; nothing that was written is lost."""


class PackageMissingError(ExactfoldError):
    """An optional package or program is not installed; the message says how to install it."""
