"""The progress line on a terminal, made with rich; loaded when there is progress to show."""

from __future__ import annotations

import sys
from datetime import timedelta

from rich.console import Console
from rich.progress import BarColumn, Progress, ProgressColumn, Task, TextColumn
from rich.text import Text

LARGEST = 1 << 31
"""Larger totals are scaled to 1, because rich converts numbers to C integers."""


class TimeColumn(ProgressColumn):
    """The time left if the total is known, otherwise the time since the stage began."""

    def render(self, task: Task) -> Text:
        """The time in whole seconds."""
        if task.total is None:
            return Text(str(timedelta(seconds=int(task.elapsed or 0))))
        left = task.time_remaining
        return Text("" if left is None else f"{timedelta(seconds=int(left))} left")


class Display:
    """A line on the console of stderr that shows the current stage; closing removes the line."""

    def __init__(self, console: Console) -> None:
        self.progress = Progress(
            TextColumn("{task.description}"),
            BarColumn(),
            TextColumn("{task.fields[count]}"),
            TimeColumn(),
            console=console,
            transient=True,
            redirect_stdout=sys.stdout.isatty(),  # otherwise output must not go to stderr
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
        if total > LARGEST:  # too large for the C integers that rich uses
            part, total = done / total, 1
        self.progress.update(task, completed=part, total=total or None, count=count)

    def close(self) -> None:
        """Remove the line."""
        self.progress.stop()
