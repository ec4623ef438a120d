"""Every exception of exactfold, one class per cause.

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
    """The call asks for something that does not exist or does not apply (exit code 2)."""


class LettersError(UsageError):
    """Mountain-valley letters that do not fit the folds: too many or few, unknown, on no fold."""


class NoLettersError(UsageError):
    """Letters of a file are asked for, and none of its folds is a mountain or a valley."""


class BadCandidatesError(UsageError):
    """A solver returned something other than a set of finite points of the right shape."""


# --- numbers -------------------------------------------------------------------------------------


class NumberError(InputError):
    """A number could not be accepted."""


class FloatRefusedError(NumberError, TypeError):
    """A binary float was given where an exact number is needed."""


class NotANumberError(NumberError, ValueError):
    """Text, NaN, Infinity or another object that is not a rational number."""


# --- files ---------------------------------------------------------------------------------------


class UnreadableFileError(InputError):
    """A file does not exist or cannot be read."""


class UnknownPatternError(UnreadableFileError):
    """Text that is neither a file nor the name of an example; the message lists the names."""


class UnwritableFileError(InputError):
    """An output path cannot be written."""


class NotJSONError(InputError):
    """The file is not JSON, or is cut off."""


class FoldError(InputError):
    """Base class: the file is JSON but not a FOLD file this reader accepts."""


class NotFoldError(FoldError):
    """JSON without the structure of a FOLD file."""


class MissingCoordinatesError(FoldError):
    """`vertices_coords` is absent, or a vertex has no coordinates."""


class OffPlaneError(FoldError):
    """Three-component coordinates that do not lie in one plane z = constant."""


class StaleExactCoordinatesError(FoldError):
    """`vertices_exactfold:coords` contradicts `vertices_coords`: another program moved a vertex."""


class NonTriangularFaceError(FoldError):
    """A face with more than three sides."""


class CrossingEdgesError(FoldError):
    """Two edges of the file cross, or a vertex lies inside an edge."""


class IrrationalCoordinatesError(FoldError):
    """A file whose coordinates have square roots, where rational ones are needed."""


class DanglingEdgeError(FoldError):
    """An edge that is not a side of any face."""


class CutEdgeError(FoldError):
    """An edge between two faces that the file declares a cut or a boundary."""


class TooLargeError(InputError):
    """A file asks for more than a limit; the message names the limit, and what the file has."""


class UnknownFormatError(InputError):
    """A file in no format that is read; the message lists those that are."""


class MalformedDrawingError(InputError):
    """A file of a known format whose lines cannot be understood."""


class EmptyDrawingError(InputError):
    """A drawing without any line of a crease pattern."""


class CurvedCreaseError(InputError):
    """A crease that is not straight: panels between curved creases cannot be rigid."""


class FoldedStateError(FoldError):
    """The coordinates of a folded state where a crease pattern is needed."""


class CertificateFormatError(InputError):
    """The file is not a certificate of a known format and version."""


class BadTorquesError(InputError):
    """A file of torques that is not an object of numbers by crease."""


class BadRimError(InputError):
    """Heights of the border that cannot be taken; `vertices` are those to blame."""

    def __init__(self, message: str, vertices: Sequence[int] = ()) -> None:
        super().__init__(message)
        self.vertices = tuple(vertices)


class RimVertexError(BadRimError, UsageError):
    """A boundary vertex without a height, or a height of something that is no boundary vertex."""


class RimHeightError(BadRimError, NumberError):
    """A height of a boundary vertex that is not a number."""


class BadDriveError(InputError):
    """Folds or angles that cannot be driven; `folds` are those to blame."""

    def __init__(self, message: str, folds: Sequence[tuple[int, int]] = ()) -> None:
        super().__init__(message)
        self.folds = tuple(folds)


class BadCurvatureError(InputError):
    """Angle deficits that cannot be taken; `vertices` are those to blame."""

    def __init__(self, message: str, vertices: Sequence[int] = ()) -> None:
        super().__init__(message)
        self.vertices = tuple(vertices)


class ClusterError(InputError):
    """A cluster that does not answer, has no workers, or workers that cannot do the work."""


class ForeignJournalError(InputError):
    """A file to be resumed belongs to another pattern or version, or is of another kind."""


class JournalInUseError(InputError):
    """Another run is writing the file; this one has left it alone."""


# --- studies -------------------------------------------------------------------------------------


class UnknownStudyError(UsageError):
    """No study has this name; the message lists those that there are."""


class RowNumbersError(UsageError):
    """Numbers of rows of a study that cannot be read, or that do not fit the sizes asked for."""


class UnknownRowError(InputError):
    """A journal of a study has no row, or more than one, whose name begins like this."""


class ForeignRowsError(ForeignJournalError):
    """A journal holds the rows of another study, or of another version of it."""


class BrokenRowsError(InputError):
    """A file is not the journal of a study, or is damaged, or holds a row that was changed."""


class RowFailedError(ExactfoldError):
    """Rows of a study ended with an error; all others were written."""


class StudyPartsMissingError(ExactfoldError):
    """Matplotlib, pandas or pyarrow, optional parts of studies, is not installed."""


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
    """Vertices or triangles of the wrong shape: not pairs, not triples, an index out of range."""


class DuplicateVertexError(PatternError):
    """Two vertices at the same point."""


class IsolatedVertexError(PatternError):
    """A vertex that belongs to no triangle."""


class DegenerateFaceError(PatternError):
    """A triangle of zero area or with a repeated vertex."""


class MixedOrientationError(PatternError):
    """Some triangles are clockwise and some counter-clockwise."""


class OverlapError(PatternError):
    """Faces overlap, or the boundary of the sheet meets itself."""


class NonManifoldEdgeError(PatternError):
    """An edge on three or more faces."""


class NotADiskError(PatternError):
    """The faces do not form one disk."""


class DisconnectedError(NotADiskError):
    """Two or more separate sheets."""


class HoleError(NotADiskError):
    """A sheet with a hole."""


class PinchError(NotADiskError):
    """A vertex at which the sheet hangs together by a point only."""


class CollinearPointsError(PatternError):
    """Points that span no triangle."""


class NotACreasePatternError(PatternError):
    """An object of another program is not a flat sheet of triangles; the cause says why."""


class NotApplicableError(ExactfoldError):
    """A construction or method does not apply to this pattern; the message says why."""


class FlatRimError(BadRimError, NotApplicableError):
    """Heights of the border that lie in one plane: without angle deficits the sheet is flat."""


class NegativeDeficitError(BadCurvatureError, NotApplicableError):
    """A negative angle deficit: vertex signs do not name a shape then."""


class FlatVertexError(NotApplicableError):
    """A branch with a vertex that is proved flat is a multiple root: no curve is known there."""


class NotProvedAtTheFlatStateError(NotApplicableError):
    """No tube was proved from the flat state, or not which branch it belongs to."""


class NotCountedError(NotApplicableError):
    """The sheet is in order, but of a kind whose branches are not listed or named (exit code 4)."""


class NotTriangulatedError(NotCountedError):
    """A sheet with larger panels or irrational coordinates, where triangles are needed."""


class NoInteriorVertexError(NotCountedError):
    """A pattern without interior vertices has no curvature equation and no branches to count."""


class TooManyRivalsError(NotCountedError):
    """A sheet with more branches than torques for one of them can be compared on."""


class UnprovedRivalsError(NotCountedError):
    """A branch cannot be compared with all others, as not all are proved or told apart."""


class NotFollowedError(NotApplicableError):
    """A sheet that is not followed: a branch that is not simple, or no mode that truly folds."""


class NotDrivenError(NotFollowedError):
    """No branch was found on which the driven folds `folds` start in their ratio."""

    def __init__(self, message: str, folds: Sequence[tuple[int, int]] = ()) -> None:
        super().__init__(message)
        self.folds = tuple(folds)


class UndecidedBranchError(ExactfoldError):
    """A branch that is not proved was to be exported (exit code 4)."""


# --- the exact engine ----------------------------------------------------------------------------


class SeveralSheetsError(InputError):
    """A drawing holds several sheets and none was chosen, or one that is not there was."""


class TooManyModesError(ExactfoldError):
    """A search for the motions of a sheet of panels was given up; the message says where."""


class ParametrisationError(ExactfoldError):
    """A parametrisation does not satisfy its system: an error of the solver, not of the input."""


class MsolveMissingError(ExactfoldError):
    """msolve, an optional part, is not installed."""


class MsolveFailedError(ExactfoldError):
    """msolve crashed, took too long, or gave an answer that is not understood or not true."""


class DualSpaceError(ExactfoldError):
    """A dual space does not prove what it claims; the message says which condition fails."""


# --- processes -----------------------------------------------------------------------------------


class WorkerDiedError(ExactfoldError):
    """A worker process was killed or ran out of memory; nothing that was written is lost."""


class NotEnoughMemoryError(WorkerDiedError):
    """Memory is limited, and there is not enough of it; nothing that was written is lost."""


class DaskMissingError(ExactfoldError):
    """dask.distributed, an optional part, is not installed."""


class PicturesMissingError(ExactfoldError):
    """CairoSVG, an optional part that writes PNG and PDF files, is not installed."""


class GltfMissingError(ExactfoldError):
    """pygltflib, an optional part that writes glTF files, is not installed."""


class PackageMissingError(ExactfoldError):
    """A package to which there is a bridge is not installed; the message says how to get it."""
