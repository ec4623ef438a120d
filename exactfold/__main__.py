"""`python -m exactfold` and the command `exactfold`: as little as can be before it is guarded."""

import gc
import os

try:
    import signal

    from exactfold.app.shell.guard import interrupted, supervised
except KeyboardInterrupt:
    os.write(2, b"exactfold: interrupted\n")
    os._exit(130)


_BETWEEN = 400_000
"""New objects between two searches for garbage: with 700 they are a tenth of a short command."""


def main() -> None:
    """Run the command line; an interruption or a shortage while it loads is no verdict either.

    Ctrl-C before these lines, while Python itself starts (its first 20 ms or so), is answered by
    Python: it ends without output or with a traceback.
    """
    loud = signal.getsignal(signal.SIGINT) is signal.default_int_handler
    if loud:
        signal.signal(signal.SIGINT, interrupted)

    gc.set_threshold(_BETWEEN)

    def run() -> None:
        from exactfold.app.cli import main as command_line

        if loud:
            signal.signal(signal.SIGINT, signal.default_int_handler)
        command_line()

    supervised(run)


if __name__ == "__main__":
    main()
