"""A fold that closes on the arc to a branch point: proved, verified, and forged."""

import json
from fractions import Fraction
from functools import cache

import pytest

from exactfold import CreasePattern, checker
from exactfold._support.verdict import PROVED
from exactfold.branches import find_branch
from exactfold.motion import first_contact, follow_proved
from exactfold.motion.contacts.claims import certificate_with_contact
from exactfold.motion.contacts.contacts import ContactWatch

SIGNS = "--+--"
INNER = ["319/512 131/512", "95/128 23/64", "799/1024 861/1280", "483/512 431/512"]
INNER += ["1871/2560 171/256"]
FACES = "014 043 127 154 175 236 267 348 386 458 568 576"


@cache
def late():
    """The track to a branch point right before which a fold closes, and the certificate of this."""
    sheet = CreasePattern(
        [(0, 0), (1, 0), (1, 1), (0, 1), *(tuple(map(Fraction, row.split())) for row in INNER)],
        [tuple(map(int, face)) for face in FACES.split()],
    )
    track = follow_proved(find_branch(sheet, SIGNS))
    watch = ContactWatch()
    said = [watch(step) for step in track.steps]
    assert not any(said[:-1])  # clear up to the arc
    assert said[-1] == "the first contact"
    contact = watch.result(track)
    return track, contact, json.dumps(certificate_with_contact(track, contact))


@pytest.mark.slow
def test_the_contact_on_the_arc_is_that_on_tubes():
    track, contact, text = late()
    assert (contact.status, contact.event.kind, contact.event.folds) == (
        PROVED,
        "flat-fold",
        ((5, 8),),
    )
    assert track.branch_point.entry < contact.parameters[0] < contact.parameters[2] < 0
    other, same = first_contact(find_branch(track.pattern, SIGNS))
    assert other.branch_point is None
    assert same.event.folds == contact.event.folds
    low, high = contact.event.time
    first, last = same.event.time
    assert max(low, first) <= min(high, last)  # both hold the time
    assert max(high, last) < min(low, first) * (1 + 1e-5)
    claims = checker.check(json.loads(text))
    assert claims["node"] == {"flat": [7], "clear": False}
    assert Fraction(claims["contact"]["time"][0]) <= Fraction(low)
    assert (
        Fraction(high) <= Fraction(claims["contact"]["time"][1]) < Fraction(high) * 100001 / 10**5
    )
    assert ", the fold (5, 8) is closed by " in checker.summary(claims)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"to": 1}, 'the parameter "to" is out of range'),
        ({"from": "before"}, 'the parameter "from" is out of range'),
        ({"to": "from"}, "the fold of the contact is not proved to close"),
        ({"time": "99999/100000"}, "the contact may be later than claimed"),
    ],
)
def test_forged_contacts_on_the_arc(change, message):
    forged = json.loads(late()[2])
    found, claim = forged["evidence"]["contacts"], forged["claims"]["contact"]
    if change == {"from": "before"}:
        change = {"from": forged["evidence"]["node"]["entry"] - 1}
    elif change == {"to": "from"}:
        change = {"to": found["from"]}
    elif "time" in change:
        claim["time"][1] = str(Fraction(claim["time"][1]) * Fraction(change["time"]))
        change = {}
    found |= change
    with pytest.raises(checker.CertificateError, match=message):
        checker.check(forged)
