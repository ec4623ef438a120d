"""Stand-alone checker of exactfold certificates: believes nothing, needs the standard library only.

    python exactfold/checker CERTIFICATE [WORKERS]
    python -m exactfold.checker CERTIFICATE [WORKERS]
    python -m zipapp exactfold/checker -o checker.pyz; python checker.pyz CERTIFICATE [WORKERS]

rebuild the sheet and its curvature forms from the vertices and triangles in the file by code of
their own, and verify every claim. The folder alone is enough. Exit code 0: every claim holds. 1:
some claim is not supported, or the file is not finished. 3: not a certificate. 70: a worker process
died, memory is short, or a defect of this program; nothing is known of the file.

Eleven kinds of certificates are told apart by what is in the file: listings of all branches
(`listing`, docs/certificate.md), compact ones with one root for each sign vector (`compact`,
docs/compact-certificate.md), proofs of one branch (`branch`, docs/branch.md), which are checked by
formulas of their own, all halves of branches with given mountains and valleys (`letters`,
docs/assignment.md), whether rigid panels start to fold with them (`panel_letters`,
docs/assignment.md), all assignments of a sheet with five corners (`assignments`, docs/circles.md),
the pieces of a sheet with more than four (`pieces`, docs/certificate.md), all motions of a sheet of
rigid panels (`panels`, docs/certificate.md), the true motion along one branch (`motion`,
docs/motion.md), one of rigid panels (`panel_motion`, docs/panel_motion.md), and the loops of true
motions through the flat state (`motion_loops`, docs/motions.md).
Each theory has the `Kind` of its certificates beside what it checks; `command` has the table of them,
`limits` how much one file may ask for.

Floating point is used to choose the matrices and weights of Krawczyk's and of Newton's test, which
may be any, and nowhere else.
Modules import each other relatively, and nothing else of exactfold, so that they run under any
name; none is named like a module of the standard library, as their folder is on the import path
when it is run.
"""

TYPE_CHECKING = False  # as in typing, which takes a while to load
if TYPE_CHECKING:
    from .command import check, is_compact, load, main, summary, verify
    from .core.reading import CertificateError, FormatError

__all__ = [
    "CertificateError",
    "FormatError",
    "check",
    "is_compact",
    "load",
    "main",
    "summary",
    "verify",
]


def __getattr__(name: str) -> object:
    """A public name, loaded where it is used: whoever writes certificates needs one kind only."""
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    if name.endswith("Error"):
        from .core import reading as home
    else:
        from . import command as home  # type: ignore[no-redef]
    found: object = getattr(home, name)
    globals()[name] = found
    return found
