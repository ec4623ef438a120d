"""Public names are promised: none goes without a line in the CHANGELOG."""

import re
from pathlib import Path

import pytest
import rooms

HERE = Path(__file__)
PROMISED = HERE.with_name("public_names.txt")
CHANGELOG = HERE.parents[2] / "CHANGELOG.md"


def removed_names(changelog: str) -> set[str]:
    """The names in code in the sections "Removed" of a changelog."""
    sections = re.split(r"^##+ ", changelog, flags=re.MULTILINE)
    removed = (text for text in sections if text.startswith("Removed"))
    return {name for text in removed for name in re.findall(r"`([\w.]+)`", text)}


def broken(promised: set[str], there: set[str], changelog: str) -> set[str]:
    """The promised names that are gone and that the changelog does not say to be removed."""
    removed = removed_names(changelog)
    return {name for name in promised - there if not {name, f"exactfold.{name}"} & removed}


def test_no_promised_name_is_gone_in_silence():
    promised = set(PROMISED.read_text().split())
    assert broken(promised, set(rooms.public()), CHANGELOG.read_text()) == set()


def test_the_list_has_every_public_name():
    """A new name is added to the list, in the order of the alphabet; so it is promised."""
    listed = PROMISED.read_text().split()
    assert listed == sorted(listed)
    assert set(rooms.public()) <= set(listed)


@pytest.mark.parametrize(
    ("changelog", "gone"),
    [
        ("## [2.0]\n### Added\n- `solve.old` is new\n", {"solve.old"}),
        ("## [2.0]\n### Removed\n- `solve.old`: use `solve.new`\n### Added\n", set()),
        ("## [2.0]\n### Removed\n- `exactfold.solve.old`\n", set()),
        ("## [2.0]\n### Removed\n- old names of solve\n", {"solve.old"}),
    ],
)
def test_a_name_that_goes_needs_a_line_under_removed(changelog, gone):
    assert broken({"solve.old", "solve.new"}, {"solve.new"}, changelog) == gone
