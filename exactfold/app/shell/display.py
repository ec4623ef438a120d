"""The line of progress on a terminal, with rich; loaded once there is something to show."""

from __future__ import annotations

import sys
from datetime import timedelta

from rich.console import Console
from rich.progress import BarColumn, Progress, ProgressColumn, Task, TextColumn
from rich.text import Text

LARGEST = 1 << 31
"""Totals beyond this are shown as parts of 1."""


class TimeColumn(ProgressColumn):
    """The time left where the total is known, else the time since the stage began."""

    def render(self, task: Task) -> Text:
        """Whole seconds."""
        if task.total is None:
            return Text(str(timedelta(seconds=int(task.elapsed or 0))))
        left = task.time_remaining
        return Text("" if left is None else f"{timedelta(seconds=int(left))} left")


class Display:
    """One line on the console of stderr for the stage under way, gone when it is closed."""

    def __init__(self, console: Console) -> None:
        self.progress = Progress(
            TextColumn("{task.description}"),
            BarColumn(),
            TextColumn("{task.fields[count]}"),
            TimeColumn(),
            console=console,
            transient=True,
            redirect_stdout=sys.stdout.isatty(),  # elsewhere what is printed must not come here
        )
        self.stage: tuple[str, bool] | None = None
        self.progress.start()

    def show(self, stage: str, done: int, total: int, note: str = "") -> None:
        """Show how far a stage has come; a total of 0 means that it is not known."""
        if (stage, bool(total)) != self.stage:  # a task never loses a total it once had
            for task in self.progress.task_ids:
                self.progress.remove_task(task)
            self.stage = (stage, bool(total))
            self.progress.add_task(stage, total=1 if total else None, count="")
        count = (f"{done}/{total}" if total else str(done or "")) + note
        task = self.progress.task_ids[0]
        part: float = done
        if total > LARGEST:  # rich turns numbers into those of C
            part, total = done / total, 1
        self.progress.update(task, completed=part, total=total or None, count=count)

    def close(self) -> None:
        """Take the line away."""
        self.progress.stop()
