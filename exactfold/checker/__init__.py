"""The stand-alone checker of exactfold certificates. It believes nothing that a file says.

It needs Python's standard library only. Each of these commands checks one file:

    python exactfold/checker CERTIFICATE [WORKERS]
    python -m exactfold.checker CERTIFICATE [WORKERS]
    python -m zipapp exactfold/checker -o checker.pyz; python checker.pyz CERTIFICATE [WORKERS]

The checker rebuilds the sheet and its curvature forms from the vertices and triangles in the file,
by code of its own, and verifies every claim. This folder alone is enough to run it. The exit code
is 0 if every claim holds; 1 if some claim is not supported, or the file is not finished; 2 if the
arguments are wrong; 3 if the file is not a certificate, or asks for more than the limits allow; 70
if a worker process died, memory is short, or this program has a defect. After 70 nothing is known
of the file.

A kind of certificate is one `Kind`, which stands beside the theory that checks it. `command` has
the table of the kinds:

  branches   all branches in one object (`listing`, docs/certificate.md); all branches line by line
             (`compact`, docs/certificate.md); one branch (`branch`, docs/branch.md), which
             is checked by formulas of its own; the pieces of a sheet with more than four corners
             (`connected_components`, docs/any_border.md); all branches and pleats of a periodic
             sheet (`periodic`, docs/tessellations.md);
  panels     all motions of a sheet of rigid panels (docs/certificate.md);
  letters    all rays with given mountains and valleys (`letters`), and whether rigid panels start
             to fold with given letters (`panels`), both in docs/assignment.md; all assignments of
             a sheet with five corners (`assignments`, docs/any_border.md);
  motion     the true motion along one branch (docs/motion.md); the loops of true motions through
             the flat state (`loops`, docs/motion.md, 11); the motion of rigid panels (`panels`,
             docs/motion.md, 18).

`core/limits.py` says how much one file may ask for.

Floating point only chooses the matrices and weights of Krawczyk's test and of Newton's test. These
tests are valid with any matrices and weights, so that no claim rests on floating point.

The modules import each other relatively and import nothing else of exactfold, so that they run
under any package name. No module has the name of a module of the standard library, because this
folder is on the import path when it is run.
"""

TYPE_CHECKING = False  # as in typing, which takes a while to load
if TYPE_CHECKING:
    from .command import check, load, main, summary, verify
    from .core.reading import CertificateError, FormatError

__all__ = [
    "CertificateError",
    "FormatError",
    "check",
    "load",
    "main",
    "summary",
    "verify",
]


def __getattr__(name: str) -> object:
    """Load a public name when it is first used.

    A program that writes certificates imports one kind only, and should not load all of them.
    """
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    if name.endswith("Error"):
        from .core import reading as home
    else:
        from . import command as home  # type: ignore[no-redef]
    value: object = getattr(home, name)
    globals()[name] = value
    return value
