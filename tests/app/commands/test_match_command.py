"""`exactfold match` and what `count` says of the letters of a file: text, JSON, exit codes."""

import json

import pytest
from jsonschema import Draft202012Validator, ValidationError
from running import BAD_INPUT, INVALID, PROVED, UNDECIDED, USAGE, error_class, run

from exactfold import CreasePattern, random_square, schema
from exactfold.branches import count_branches, find_branch
from exactfold.design import match, nearest_branches
from exactfold.pattern import load, write_fold

TURNED = str.maketrans("MV", "VM")
CP = """1 0 0 4 0
1 4 0 4 4
1 4 4 0 4
1 0 4 0 0
{0} 0 0 1 2
{1} 4 0 1 2
{2} 4 4 1 2
{3} 0 4 1 2
"""


def valid(text, kind="match"):
    data = json.loads(text)
    Draft202012Validator(schema(kind)).validate(data)
    return data


@pytest.fixture
def drawn(tmp_path):
    """A file with the letters of the third branch of two-vertex, turned over."""
    pattern = load("two-vertex")
    branch = count_branches(pattern).branches[2]
    letters = {fold: x.translate(TURNED) for fold, x in branch.assignment.items()}
    write_fold(pattern, tmp_path / "drawn.fold", letters)
    return tmp_path / "drawn.fold"


@pytest.fixture
def wrong(tmp_path):
    write_fold(
        load("two-vertex"), tmp_path / "w.fold", dict.fromkeys(load("two-vertex").folds, "M")
    )
    return tmp_path / "w.fold"


# --- match ---------------------------------------------------------------------------------------


def test_the_letters_of_a_file(drawn):
    result = run("match", drawn)
    assert (result.exit_code, result.stderr) == (PROVED, "")
    lines = result.stdout.splitlines()
    assert lines[0].startswith("1 way to start folding has these mountains and valleys - PROVED (")
    signs = count_branches("two-vertex").branches[2].sign_text
    assert f"{signs}     -     " in result.stdout
    data = valid(run("match", drawn, "--json").stdout)
    assert (data["status"], data["nearest"], data["conflicts"]) == ("proved", None, {})
    (half,) = data["matches"]
    assert (half["side"], half["branch"]) == (-1, signs)
    assert half["assignment"] == data["letters"]
    turned = "".join("-0+"[s + 1] for _, s in sorted(half["vertex_signs"].items()))
    assert turned == signs.translate(str.maketrans("+-", "-+"))


@pytest.mark.slow
def test_the_printed_command_folds_to_the_letters(drawn, tmp_path):
    (half,) = valid(run("match", drawn, "--json").stdout)["matches"]
    side = "+" if half["side"] > 0 else "-"
    out = tmp_path / "o.fold"
    done = run(
        *("fold", drawn, "--signs", half["branch"], "--side", side),
        *("--until", "5deg", "--frames", 3, "-o", out),
    )
    assert done.exit_code == PROVED
    written = json.loads(out.read_text())
    last = written["file_frames"][-1]
    angles = dict(zip(map(tuple, written["edges_vertices"]), last["edges_foldAngle"], strict=True))
    letters = {
        f"{min(edge)}-{max(edge)}": "V" if angle > 0 else "M"
        for edge, angle in angles.items()
        if angle
    }
    assert letters == half["assignment"]


def test_letters_of_no_way(wrong):
    result = run("match", wrong)
    assert result.exit_code == INVALID
    text = " ".join(result.stdout.split())
    assert "no way to start folding has these mountains and valleys - PROVED" in text
    assert "vertex 4 can pop neither up (it has no valley) nor down (it has no valley)" in text
    data = valid(run("match", wrong, "--json").stdout)
    near = nearest_branches(match("two-vertex", "M" * 7))
    found = data["nearest"]
    assert (data["status"], data["matches"]) == ("proved", [])
    assert set(data["conflicts"]) == {"4", "5"}
    assert (found["status"], found["by"], found["complete"]) == ("proved", "list", True)
    assert found["distance"] == near.distance == len(found["branches"][0]["differences"])
    for half in found["branches"]:
        other = {x["fold"]: (x["wanted"], x["actual"]) for x in half["differences"]}
        assert other == {f: ("M", x) for f, x in half["assignment"].items() if x != "M"}
        assert f"{next(iter(other))} M->V" in text
    assert "Nearest: 1 crease to change - PROVED; none is nearer" in text


def test_letters_as_text_by_fold_and_in_a_file(tmp_path):
    path = tmp_path / "letters.txt"
    path.write_text("4-5 = M,\n0-4 = V\n")
    whole = "VUUUUUM"
    texts = [
        run("match", "two-vertex", "--letters", given, "--json").stdout
        for given in (whole, "0-4=V,5-4=M", f"@{path}")
    ]
    datas = [{k: v for k, v in valid(text).items() if k != "seconds"} for text in texts]
    assert datas[0] == datas[1] == datas[2]
    expected = match("two-vertex", {(0, 4): "V", (4, 5): "M"})
    assert len(datas[0]["matches"]) == len(expected.matches) > 1
    path.write_text("VUU UUU\nM\n")
    again = valid(run("match", "two-vertex", "--letters", f"@{path}", "--json").stdout)
    assert again["matches"] == datas[0]["matches"]


def test_a_drawing_of_lines(tmp_path):
    path = tmp_path / "one.cp"
    path.write_text(CP.format(2, 3, 2, 2))  # three mountains all round, and a valley
    result = run("match", path, "--json")
    data = valid(result.stdout)
    assert result.exit_code == PROVED
    assert sorted(data["letters"].values()) == ["M", "M", "M", "V"]
    assert [half["assignment"] for half in data["matches"]] == [data["letters"]]
    path.write_text(CP.format(2, 2, 2, 2))
    assert run("match", path).exit_code == INVALID


def test_little_time_is_undecided(tmp_path):
    path = tmp_path / "p.fold"
    write_fold(random_square(3, seed=4), path)
    result = run("match", path, "--letters", "4-5=M,5-6=V", "--most", 1)
    assert result.exit_code == UNDECIDED
    text = " ".join(result.stdout.split())
    assert "whether a way to start folding has these mountains and valleys is UNDECIDED" in text
    assert "open: --most N compares more" in text
    data = valid(run("match", path, "--letters", "4-5=M,5-6=V", "--most", 1, "--json").stdout)
    assert data["open_signs"]


@pytest.mark.slow
def test_the_nearest_found_is_not_called_the_nearest(tmp_path):
    path = tmp_path / "p.fold"
    branch = find_branch(random_square(14, seed=1), "+-" * 7)
    letters = dict(branch.assignment)
    for fold in branch.pattern.folds[::5]:
        letters[fold] = letters[fold].translate(TURNED)
    write_fold(branch.pattern, path, letters)
    result = run("match", path, "--tries", 1)
    assert result.exit_code == INVALID
    text = " ".join(result.stdout.split())
    assert "Nearest found:" in text
    assert "are enough is UNDECIDED" in text
    assert "none is nearer" not in text
    near = valid(run("match", path, "--tries", 1, "--json").stdout)["nearest"]
    assert (near["status"], near["by"], near["complete"]) == ("undecided", "search", False)
    assert near["at_least"] < near["distance"]


@pytest.mark.parametrize(
    ("letters", "message"),
    [
        ("MV", "2 letters for 7 folds"),
        ("MVVVVVVV", "8 letters for 7 folds"),
        ("", "0 letters for 7 folds"),
        ("MVXVMVM", "fold 1-5 has the letter 'X'"),
        ("mvvvmvm", "fold 0-4 has the letter 'm'"),
        ("0-5=M", "'0-5=M' names no fold"),
        ("0-4=", "fold 0-4 has the letter ''"),
        ("0-4=MV", "fold 0-4 has the letter 'MV'"),
        ("0-4=M,4-0=V", "fold 0-4 has two letters"),
    ],
)
def test_letters_that_do_not_fit(letters, message):
    result = run("match", "two-vertex", "--letters", letters, "--json")
    assert result.exit_code == USAGE
    assert message in result.stderr
    assert error_class(result) == "UsageError"


def test_files_of_letters_that_cannot_be_read(tmp_path):
    missing = run("match", "two-vertex", "--letters", f"@{tmp_path / 'none'}", "--json")
    assert (missing.exit_code, error_class(missing)) == (BAD_INPUT, "UnreadableFileError")
    (tmp_path / "b").write_bytes(b"\xff\xfe")
    binary = run("match", "two-vertex", "--letters", f"@{tmp_path / 'b'}", "--json")
    assert (binary.exit_code, error_class(binary)) == (BAD_INPUT, "UnreadableFileError")
    (tmp_path / "short").write_text("MV")
    short = run("match", "two-vertex", "--letters", f"@{tmp_path / 'short'}")
    assert short.exit_code == USAGE
    assert f"{tmp_path / 'short'}: 2 letters for 7 folds" in short.stderr


def test_a_file_without_letters():
    result = run("match", "two-vertex", "--json")
    assert result.exit_code == USAGE
    assert error_class(result) == "UsageError"
    assert "the file assigns mountain or valley to no fold" in result.stderr


def test_a_sheet_with_three_corners_is_out_of_reach(tmp_path):
    path = tmp_path / "p.fold"
    write_fold(
        CreasePattern([(0, 0), (3, 0), (0, 3), (1, 1)], [(0, 1, 3), (1, 2, 3), (2, 0, 3)]), path
    )
    result = run("match", path, "--letters", "MVM", "--json")
    assert result.exit_code == UNDECIDED
    assert json.loads(result.stdout)["error"]["class"] == "NotCountedError"
    assert "exactfold: match needs a sheet that can fold" in result.stderr


def test_creases_that_cannot_fold_are_named():
    result = run("match", "flat-octahedron", "--letters", "4-7=M,7-8=V,0-4=M")
    assert result.exit_code == INVALID
    assert "- creases 4-7, 7-8 lie in triangulated triangles and stay flat" in result.stdout


def test_the_schema_refuses_what_is_not_documented(wrong):
    data = valid(run("match", wrong, "--json").stdout)
    near = data["nearest"]
    for key in data:
        with pytest.raises(ValidationError):
            valid(json.dumps({k: v for k, v in data.items() if k != key}))
    for more in ({"more": 1}, {"status": "refuted"}, {"nearest": {**near, "by": "luck"}}):
        with pytest.raises(ValidationError):
            valid(json.dumps({**data, **more}))


# --- count ---------------------------------------------------------------------------------------


def test_count_names_the_way_with_the_letters_of_its_file(drawn, wrong):
    text = run("count", drawn).stdout
    assert "\nway 3 (other side) has the mountains and valleys of the file\n" in text
    data = valid(run("count", drawn, "--json").stdout, "count")
    assert data["letters"] == {"status": "proved", "ways": [{"way": 3, "side": -1}]}
    none = valid(run("count", wrong, "--json").stdout, "count")
    assert none["letters"] == {"status": "proved", "ways": []}
    assert "no way has the mountains and valleys of the file" in run("count", wrong).stdout


def test_count_of_few_letters(tmp_path):
    pattern = load("two-vertex")
    write_fold(pattern, tmp_path / "few.fold", {(4, 5): "M"})
    found = valid(run("count", tmp_path / "few.fold", "--json").stdout, "count")["letters"]
    assert len(found["ways"]) == len(match(pattern, {(4, 5): "M"}).matches)
    assert (
        "have the mountains and valleys of the file" in run("count", tmp_path / "few.fold").stdout
    )


@pytest.mark.parametrize("pattern", ["two-vertex", "miura"])
def test_count_says_nothing_of_letters_where_there_are_none_or_no_list(pattern):
    result = run("count", pattern, "--json")
    assert valid(result.stdout, "count")["letters"] is None
    assert "of the file" not in run("count", pattern).stdout


def test_a_refutation_says_what_it_is_about() -> None:
    meaning = "This is about rigid panels that all move together, from the flat sheet."
    for more in (["pinwheel-base"], ["two-vertex", "--letters", "MMMMMMM"]):
        text = " ".join(run("match", *more).stdout.split())
        assert meaning in text
        assert "`exactfold vertices` says at which vertices Maekawa's and Kawasaki's" in text
    assert meaning not in " ".join(run("match", "miura").stdout.split())
