"""`exactfold check`: verifies a certificate, fast, and lists the branches in it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

from exactfold import checker
from exactfold.app.shell.shell import Bar, name_of, regular, said
from exactfold.app.verbs.checking import Checked, cores, judged, quickest
from exactfold.checker.core.kinds import Verified
from exactfold.errors import NotApplicableError

if TYPE_CHECKING:
    from exactfold.app.verbs.check_document import BranchWithAngles, CheckDocument
    from exactfold.branches.values.branch import Branch


def valid(
    path: Path,
    workers: int | None,
    as_json: bool,
    *,
    listed: bool = False,
    heights: bool = False,
) -> bool:
    """Print whether every claim of a file holds, and return it. Raises the errors of `check`.

    With `listed`, the branches of a certificate of all branches are printed, too; with `heights`,
    they are printed with the heights of the vertices and the angles of the folds.
    """
    branches: list[Branch] | None = None
    many = workers or cores()
    with Bar("checking"):
        if listed or heights:
            verdict, branches = verified_branches(path, many)
        else:
            with regular(path) as file:
                verdict = judged(said(path), lambda: checker.verify(file, many, quickest))
    if as_json:
        print(json.dumps(_document(path, verdict, branches, heights)))
        return bool(verdict)
    print(verdict.text)
    if branches is not None:
        from exactfold.app.report.listing import listing_report
        from exactfold.app.report.terminal import show

        show(listing_report(branches, heights=heights))
    return bool(verdict)


def verified_branches(path: Path, workers: int) -> tuple[Checked, list[Branch] | None]:
    """The verdict on a certificate of all branches, and its branches in the order of `count`.

    The file is read only once, so that exactly the verified branches are listed. They are None if a
    claim does not hold. Raises the errors of `check`, `CertificateFormatError` for other
    certificates, and `NotApplicableError` for too many branches.
    """
    from exactfold.branches.certificates.read import branches_of, read_listing
    from exactfold.branches.counting.by_theorem import IN_MEMORY
    from exactfold.branches.values.branch import Branch

    read = []

    def verify() -> Verified[Any]:
        read.append(read_listing(file))
        claims = checker.check(read[0], workers, quickest)
        if claims["real"] > 1 << IN_MEMORY:
            raise NotApplicableError(
                f"{claims['real']} branches are too many to list here, though every claim holds; "
                "`exactfold.branches.read_branches` reads them one by one"
            )
        return claims

    with regular(path) as file:
        verdict = judged(said(path), verify)
    if not verdict:
        return verdict, None
    return verdict, sorted(branches_of(read[0]), key=Branch.sort_key)


def _document(
    path: Path, verdict: Checked, branches: list[Branch] | None, heights: bool
) -> CheckDocument:
    """The object that `check --json` prints."""
    document = verdict.to_dict(name_of(path))
    if branches is None:
        return document
    from exactfold.app.report.listing import angles_of

    if heights:
        bent: list[BranchWithAngles] = [
            {**branch.entry(), "angles": angles_of(branch)} for branch in branches
        ]
        return {**document, "branches": bent}
    return {**document, "branches": [branch.entry() for branch in branches]}
