"""The checker in a page: its source, a certificate, and the address of a Python for browsers."""

from __future__ import annotations

import base64
import io
import re
import zipfile
from functools import cache
from pathlib import Path
from typing import Final, TypedDict
from urllib.parse import urlsplit

import exactfold.checker
from exactfold.errors import UsageError

MOST_BYTES: Final = 32 << 20
"""Of a certificate in a page."""
_ADDRESS: Final = re.compile(r"[\w./:~%-]+")
_TIME: Final = (1980, 1, 1, 0, 0, 0)


class PageChecker(TypedDict):
    """What a page needs to verify a certificate."""

    certificate: str
    source: str
    """The files of the checker, as a zip archive in base64."""
    pyodide: str
    """The folder of Pyodide: relative to the page, or the address of a copy; it ends with "/"."""


def page_checker(certificate: str, pyodide: str) -> PageChecker:
    """The checker for a page that contains a certificate.

    `pyodide` is the folder of Pyodide beside the page, or the address of a copy (https or http).
    Raises `UsageError` for other addresses, and for certificates of more than 32 MB.

    >>> page_checker("{}", "pyodide")["pyodide"]
    'pyodide/'
    """
    if len(certificate) > MOST_BYTES:
        raise UsageError(
            f"--with-checker: the certificate has more than {MOST_BYTES >> 20} MB; write it with "
            "`exactfold count --certificate` and verify it with `exactfold check`"
        )
    policy_source(pyodide)
    return {
        "certificate": certificate,
        "source": _source(),
        "pyodide": pyodide if pyodide.endswith("/") else f"{pyodide}/",
    }


def policy_source(pyodide: str) -> str:
    """Where a content security policy must allow the page to get Pyodide from.

    >>> policy_source("pyodide/"), policy_source("https://example.org/a/pyodide")
    ("'self'", 'https://example.org')
    """
    parts = urlsplit(pyodide)
    if not _ADDRESS.fullmatch(pyodide) or parts.scheme not in ("", "http", "https"):
        raise UsageError(
            f"--with-checker: {pyodide!r} is no folder beside the page and no http or https address"
        )
    if not parts.scheme and (parts.netloc or ":" in pyodide):
        raise UsageError(f"--with-checker: {pyodide!r}: begin an address with https://")
    return f"{parts.scheme}://{parts.netloc}" if parts.scheme else "'self'"


@cache
def _source() -> str:
    folder = Path(exactfold.checker.__file__).parent
    archive = io.BytesIO()
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as out:
        for file in sorted(folder.rglob("*.py")):
            entry = zipfile.ZipInfo(file.relative_to(folder).as_posix(), _TIME)
            out.writestr(entry, file.read_bytes(), zipfile.ZIP_DEFLATED)
    return base64.b64encode(archive.getvalue()).decode("ascii")
