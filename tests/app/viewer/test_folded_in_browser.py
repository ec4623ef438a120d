"""The sheet folded flat, in a real browser: states, why there is none, and motions to the end."""

import pytest

from exactfold.app.viewer import view_document, view_page

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def twist():
    return view_document("square-twist", name="square-twist", frames=9)


@pytest.fixture(scope="module")
def address(folder, browser, twist):
    path = folder / "square-twist.html"
    path.write_text(view_page(twist))
    return path.as_uri()


def lines(browser):
    """The letter of each fold that the crease pattern shows."""
    return browser.run(
        "Array.from(document.querySelectorAll('#pattern .fold .line:last-of-type'),"
        " (n) => n.getAttribute('class').split(' ')[1]).join('')"
    )


def test_states_are_shown_from_both_sides_and_the_pattern_has_their_letters(
    browser, address, twist
):
    browser.open(address)
    browser.click("#flat")
    states = twist["folded"]["sheets"][1]["stacks"]
    assert browser.text(".folded-state output") == "state 1"  # in which way 1 ends
    assert browser.run("document.querySelectorAll('.view').length") == 2
    for number in (1, 2, 3):
        layers = len(states[number]["layers"])
        assert browser.run("document.querySelectorAll('.view .layer').length") == 2 * layers
        assert browser.run("exactfold.view.folded.letters()") == states[number]["letters"]
        assert lines(browser) == states[number]["letters"]
        browser.click(".folded-next")
    browser.click("#mirror")
    assert browser.text(".folded-state output") == "state 2"
    browser.run("exactfold.store.set({way: 5, mirrored: false})")
    assert browser.text(".folded-state output") == "state 3"
    browser.click("#flat")
    assert browser.run("document.getElementById('folded').hidden")
    assert lines(browser) == twist["ways"][5]["letters"]
    assert browser.complaints() == []


def test_where_there_is_no_state_the_reasons_stand_below_a_picture(browser, address):
    browser.open(f"{address}#flat=1.3&way=1")
    assert browser.text(".folded-state output") == "state 3"  # kept in the address
    browser.run(
        "(() => { const which = document.querySelector('.folded-which'); which.value = 0;"
        " which.dispatchEvent(new Event('change')) })()"
    )
    assert browser.run("document.querySelectorAll('.folded-why li').length") == 4
    browser.until("document.querySelector('.folded-why img').naturalWidth > 100")
    assert "REFUTED" in browser.text(".folded-answer")
    assert browser.complaints() == []


def test_a_motion_plays_to_the_end_with_its_layers_apart(browser, address, twist):
    browser.open(address)
    browser.slide(1000)
    assert browser.text("#ending") == "folded flat"
    assert browser.text("#angle") == "180°"
    [layered] = [end["layered"] for end in twist["folded"]["ends"] if end["way"] == 0]
    assert browser.run("exactfold.positions()") == pytest.approx(layered, abs=1e-6)
    assert "Way 1 folds rigidly from the flat sheet to flat-folded state 1" in browser.text(
        "#facts"
    )
    browser.run("exactfold.store.set({way: 1})")  # it ends in a contact
    assert browser.text("#ending") == "first contact"
