"""`exactfold assignments` of rigid panels, and forcing sets."""

import json

from jsonschema import Draft202012Validator
from running import run

import exactfold


def test_all_assignments_of_panels_and_a_forcing_set():
    done = run("assignments", "pinwheel-base", "--forcing", "--json")
    data = json.loads(done.stdout)
    Draft202012Validator(exactfold.schema("assignments")).validate(data)
    assert (done.exit_code, data["status"], data["number"], data["at_most"]) == (
        0,
        "proved",
        12,
        12,
    )
    assert len(data["parts"][0]["assignments"]) == 12
    assert (len(data["forcing"]["folds"]), data["forcing"]["at_least"]) == (3, 3)
    assert "the letters of the file have no forcing set" in done.stderr
    shown = run("assignments", "pinwheel-base", "--forcing").stdout
    assert "12 of M and V to all folds that can fold" in shown
    assert "3 folds force them: 0-6, 1-7, 2-4; no smaller set does - PROVED" in shown
    assert all(text in shown for text in data["parts"][0]["assignments"])


def test_the_forcing_set_of_given_letters():
    first = json.loads(run("assignments", "fish-base", "--json").stdout)
    assert [part["folds"] for part in first["parts"]] == [
        ["0-4", "1-4", "2-4", "4-6"],
        ["0-5", "2-5", "3-5", "5-7"],
    ]
    letters = "0-4=M,1-4=V,2-4=M,4-6=M,0-5=V,2-5=V,3-5=M,5-7=V,0-2=V"
    data = json.loads(
        run("assignments", "fish-base", "--forcing", "--letters", letters, "--json").stdout
    )
    assert data["forcing"]["letters"]["0-2"] == "V"
    assert "0-2" in data["forcing"]["folds"]
    assert data["forcing"]["status"] == "proved"
    wrong = run("assignments", "fish-base", "--forcing", "--letters", letters.replace("V", "M"))
    assert "no forcing set: these letters are not among the assignments" in wrong.stderr


def test_a_list_of_panels_has_a_certificate(tmp_path):
    file = tmp_path / "list.json"
    run("assignments", "square-twist", "--forcing", "--certificate", file)
    claims = exactfold.check(file).claims
    assert (claims["number"], claims["forcing"]["folds"]) == (12, [[4, 5], [4, 7], [5, 6]])
    run("assignments", "map-fold", "--certificate", file)
    assert exactfold.check(file).claims["number"] == 0


def test_a_list_that_the_checker_does_not_find_has_no_certificate(tmp_path):
    file = tmp_path / "list.json"
    done = run("assignments", "hypar-2", "--certificate", file)
    said = "no certificate was written: the checker does not find the list again: the motions"
    assert said in " ".join(done.stderr.split())
    assert not file.exists()
