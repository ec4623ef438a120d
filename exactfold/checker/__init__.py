"""Stand-alone checker of exactfold certificates: believes nothing, needs the standard library only.

    python exactfold/checker CERTIFICATE [WORKERS]
    python -m exactfold.checker CERTIFICATE [WORKERS]
    python -m zipapp exactfold/checker -o checker.pyz; python checker.pyz CERTIFICATE [WORKERS]

rebuild the sheet and its curvature forms from the vertices and triangles in the file by code of
their own, and verify every claim. The folder alone is enough. Exit code 0: every claim holds. 1:
some claim is not supported, or the file is not finished. 3: not a certificate. 70: a worker process
died, memory is short, or a defect of this program; nothing is known of the file.

A kind of certificate is one `Kind`, beside the theory that checks it; `command` has the table of
the eleven kinds. In `branches` are listings of all branches (`listing`, docs/certificate.md),
compact ones with one root for each sign vector (`compact`, docs/compact-certificate.md), proofs of
one branch (`branch`, docs/branch.md), which are checked by formulas of their own, and the pieces of
a sheet with more than four corners (`connected_components`, docs/any_border.md); in `panels` all
motions of a sheet of rigid panels (docs/certificate.md); in `letters` all halves of branches with
given mountains and valleys (`letters`), whether rigid panels start to fold with them (`panels`,
both in docs/assignment.md), and all assignments of a sheet with five corners (`assignments`,
docs/circles.md); in `motion` the true motion along one branch (docs/motion.md), the loops of true
motions through the flat state (`loops`, docs/motions.md), and the motion of rigid panels (`panels`,
docs/panel_motion.md). `core/limits.py` says how much one file may ask for.

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
