"""Certificates of whether rigid panels start to fold with given letters (docs/assignment.md).

If they do not, case distinctions show it; each case ends in a contradiction (`panels_refuted`). If
they do, a motion of each part of the sheet shows it (`panels_motion`). The checker finds the flat
closure and the parts again. Numbers of the field are lists of their coefficients.

`refuted` and `tree` are read as those of `letters`. A refuted set has `signs`; `planes`, pairs of a
vertex and a vector; and `heights`, pairs of a vertex and the heights at the ends of its folds that
may fold, by the number of the neighbour. Steps, beside "split", "refuted" and "flat" (a fold with a
letter that the flat closure holds flat), are

- `["at", v]`: v rests, or moves on one side of one of its lines. Each way that fits the letters and
  the sides so far is a case, by these sides (-1 mountain, 0, 1 valley), neighbours by number;
- `["loop", [u, v, ...]]`: the densities do not fit round the loop; with an order behind it: the
  fold angles do not, at this order, which excludes true motions only;
- `["curved", v]`: v has at least four folds, all with one letter;
- `["vertex", v]`: v cannot have its letters, by the theorem of Abel et al.;
- `["spaces", [u, v, ...], [[[i, j], ...], ...]]`: the sets of folds exclude all spaces of motions
  of these vertices.

`motion` has an entry for each part, the part with the smallest vertex first: null at rest; `sides`,
a letter for each fold; or `densities` over 2^bits for each fold, the places of the `unknowns`, the
`inverse` of their derivatives over 2^shift, nearly, and the `radius` over 2^bits, with coordinates
over 2^unit. Conditions go vertex by vertex: x, y and K_v, in which the fold to the neighbour with
the smallest number is the first; for a straight pair only x or y. An entry of `flat` is a list of
pairs of a vertex and its vector; `densities` are the ends of folds with their densities in one
first-order motion.
"""

from __future__ import annotations

from typing import Any, TypedDict

from ..core.kinds import DocumentKind
from ..core.reading import counted, items, keys, keys_of, refusing, require
from ..sheets.panels import Near, connected, pair, read_panels
from .panels_motion import check_motion
from .panels_refuted import Cases
from .panels_together import check_never, check_together

_TRULY = {
    "proved": "and true motions begin like this",
    "refuted": "and no true motion begins like this",
    "undecided": "of true motions nothing is claimed",
}


class PanelLettersClaims(TypedDict):
    """The claims of a file (see `check`)."""

    letters: str
    starts: str
    truly: str
    together: list[list[int]]
    never: list[list[int]]


class VerifiedPanelLetters(PanelLettersClaims):
    """The verified claims, with the number of interior vertices and the digest of the pattern."""

    interior: int
    sha256: str


@refusing()
def check(data: dict[str, Any]) -> VerifiedPanelLetters:
    """Verify every claim of a loaded certificate; raises `CertificateError` at the first failure.

    Returns the claims and the SHA-256 of the pattern. The `letters` have one letter for each fold,
    in lexicographic order of the folds; "U" stands for any letter. `starts` says whether there is a
    motion to second order with these letters. `truly` says whether true motions begin like this;
    "undecided" claims nothing. The last two claims are about first-order motions in which no fold
    goes against its letter. The folds in `together` all follow their letters in one such motion,
    and the folds in `never` stay flat in every such motion. These are all folds with a letter for
    which the evidence shows it. If both lists are empty, they claim nothing.
    """
    claims, evidence = data["claims"], data["evidence"]
    keys(claims, keys_of(PanelLettersClaims), "claims")
    starts, truly, text = claims["starts"], claims["truly"], claims["letters"]
    require(starts in ("proved", "refuted"), f'"starts" is {starts!a}, not "proved" or "refuted"')
    require(truly in _TRULY, f'"truly" is {truly!a}, not "proved", "refuted" or "undecided"')
    names = ["flat", "densities", *(["motion"] if starts == "proved" else [])]
    if "refuted" in (starts, truly):
        names += ["refuted", "tree"]
    keys(evidence, " ".join(names), "evidence")
    sheet, digest = read_panels(data["pattern"])
    fits = isinstance(text, str) and len(text) == len(sheet.folds) and set(text) <= set("MVFU")
    require(fits, "the letters are not one of M, V, F, U for each fold")
    wanted = dict(zip(sheet.folds, text, strict=True))
    near = sheet.live(fold for fold, letter in wanted.items() if letter == "F")
    if starts == "proved":
        check_motion(sheet, near, wanted, evidence["motion"], true=truly == "proved")
    else:
        require(truly != "proved", "true motions are claimed, but no motion to second order")
    steps, densities = (items(evidence[key], key) for key in ("flat", "densities"))
    whole = check_never(sheet, near, wanted, claims["never"], steps)
    if "refuted" in (starts, truly):
        refuted = truly == "refuted"
        cases = Cases(sheet, near, wanted, true=starts == "proved", truly=refuted)
        few = cases.cover(items(evidence["refuted"], "refuted"), items(evidence["tree"], "tree"))
        decided = truly == "undecided" or few or _rests(near, claims["never"])
        require(
            decided,
            "the cases name several vertices, not all with at most four folds: true "
            "motions are open",
        )
    whole = check_together(sheet, near, wanted, claims["together"], densities) and whole
    listed = claims["together"] or claims["never"]
    complete = whole or not listed
    require(complete, "a fold that is shown to go together with others, or never, is not listed")
    proved: PanelLettersClaims = claims
    return {"sha256": digest, "interior": len(sheet.interior), **proved}


def _rests(near: Near, never: list[list[int]]) -> bool:
    """Whether some part has no fold that can move to first order; `never` is verified already.

    The terms of lowest order of a true motion are a motion to first order, and no fold goes against
    its letter there. So a part of which all folds are asked to fold, and never do, has no true
    motions with the letters.
    """
    still = {(i, j) for i, j in never}
    return any(
        all(pair(v, u) in still for v, around in group.items() for u in around)
        for group in connected(near)
    )


def summary(claims: VerifiedPanelLetters) -> str:
    """One line that states the verified claims."""
    text = claims["letters"]
    asked = counted(len(text) - text.count("U"), "letter", "letters")
    folds = counted(len(text), "fold", "folds")
    if not {"M", "V"} & set(text):
        return f"VALID: none of {folds} is asked to fold; sha256 {claims['sha256']}"
    answer = "starts" if claims["starts"] == "proved" else "does not start"
    together, never = len(claims["together"]), len(claims["never"])
    first = (
        f"; to first order {together} are proved to fold together, and {never} never to fold"
        if together + never
        else ""
    )
    return (
        f"VALID: the sheet of rigid panels {answer} to fold with the {asked} asked for on {folds}, "
        f"{_TRULY[claims['truly']]}{first}; sha256 {claims['sha256']}"
    )


PANEL_LETTERS = DocumentKind(
    format="exactfold letters on panels",
    versions=(1,),
    names="format version pattern claims evidence",
    claims=VerifiedPanelLetters,
    check=check,
    summary=summary,
)
"""Whether rigid panels start to fold with given mountains and valleys (docs/assignment.md)."""
