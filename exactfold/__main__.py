"""`python -m exactfold` and the command `exactfold`: as little as can be before it is guarded."""

import signal

from exactfold.commands.guard import interrupted, supervised


def main() -> None:
    """Run the command line; an interruption or a shortage while it loads is no verdict either."""
    supervised(_run)


def _run() -> None:
    loud = signal.getsignal(signal.SIGINT) is signal.default_int_handler
    if loud:
        signal.signal(signal.SIGINT, interrupted)
    from exactfold.cli import main as command_line

    if loud:
        signal.signal(signal.SIGINT, signal.default_int_handler)
    command_line()


if __name__ == "__main__":
    main()
