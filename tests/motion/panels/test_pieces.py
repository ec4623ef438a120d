"""Pieces of motions of panels: what FLINT keeps for all threads at once."""

from threading import Event, Thread

from flint import arb_series, ctx

from exactfold.motion.panels.pieces import ORDER, capped


def test_series_have_all_their_terms_in_every_thread() -> None:
    """A thread that is done must not cut the series of another, whose last term would be 0."""
    before, inside, go_on = ctx.cap, Event(), Event()
    assert before < ORDER + 2
    found = []

    def other() -> None:
        with capped():
            inside.set()
            go_on.wait(60)
            found.append(float(arb_series([0, 1]).exp()[ORDER + 1].mid()) > 0)

    thread = Thread(target=other)
    with capped():
        thread.start()
        inside.wait(0.2)  # the other has to wait outside
    go_on.set()
    thread.join()
    assert found == [True]
    assert ctx.cap == before
