"""Blocks on a dask.distributed cluster: the same file, whatever happens to the workers."""

from __future__ import annotations

import json
import socket
import subprocess
import sys
from contextlib import suppress
from pathlib import Path

import pytest
from typer.testing import CliRunner

from exactfold import random_square
from exactfold.app.cli import app
from exactfold.branches.certificates.blocks import block_line
from exactfold.branches.counting import on_dask as engine_module
from exactfold.branches.counting import pools
from exactfold.branches.counting.branch_blocks import BranchBlocks
from exactfold.branches.counting.on_dask import dask_engine, prove_block
from exactfold.branches.counting.stream import stream_branches
from exactfold.errors import ClusterError, PackageMissingError, WorkerDiedError
from exactfold.pattern import write_fold
from exactfold.pattern.data import example_path

TWO = example_path("two-vertex")

KILLED = """
import logging, os, signal, sys
from distributed import Client, LocalCluster
from exactfold import random_square
from exactfold.branches.counting import branch_blocks, engines, stream
from exactfold.branches.counting.on_dask import dask_engine
from exactfold._support.processes import worker_environment

def kill(stage, done, total):
    dones.append(done)
    if done == 16 * 4:
        os.kill(next(iter(observer.run(os.getpid).values())), signal.SIGKILL)

if __name__ == "__main__":
    branch_blocks.BLOCK = 16
    pattern, dones = random_square(9, seed=1), []
    with worker_environment():
        local = stream.stream_branches(pattern, sys.argv[1])
        with (
            LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None,
                         silence_logs=logging.CRITICAL) as cluster,
            Client(cluster.scheduler_address) as observer,
            dask_engine(cluster.scheduler_address) as engine,
        ):
            result = stream.stream_branches(pattern, sys.argv[2], progress=kill, engine=engine)
    print(dones == list(range(16, 513, 16)))
    print(result.status, result.distinct, result.steps == local.steps, result.exact == local.exact)
"""

LOST = """
import logging, os, sys
import dask
from distributed import Client, LocalCluster, WorkerPlugin
from exactfold import random_square
from exactfold.errors import WorkerDiedError
from exactfold.branches.counting import branch_blocks, engines, stream
from exactfold.branches.counting.on_dask import dask_engine

class Deadly(WorkerPlugin):
    def setup(self, worker):
        branch_blocks.BranchBlocks.prove = lambda self, index: os._exit(1)

def failed(progress):
    try:
        with dask_engine(cluster.scheduler_address) as engine:
            stream.stream_branches(
                pattern, sys.argv[1], progress=progress, engine=engine, resume=True
            )
    except WorkerDiedError as error:
        print(str(error).partition(";")[0])

if __name__ == "__main__":
    branch_blocks.BLOCK = 16
    pattern = random_square(9, seed=1)
    with (
        dask.config.set({"distributed.scheduler.allowed-failures": 0}),
        LocalCluster(n_workers=1, threads_per_worker=1, dashboard_address=None,
                     silence_logs=logging.CRITICAL) as cluster,
    ):
        with Client(cluster.scheduler_address) as observer:
            observer.register_plugin(Deadly())
        failed(None)
    with LocalCluster(processes=False, threads_per_worker=1, dashboard_address=None,
                      silence_logs=logging.CRITICAL) as cluster:
        failed(lambda *_: cluster.close())
    result = stream.stream_branches(pattern, sys.argv[1], resume=True)
    print(result.status, result.resumed > 0)
"""


def script(folder: Path, text: str, *arguments: Path) -> list[str]:
    """The lines printed by a script in a process of its own, as workers are started anew."""
    path = folder / "run.py"
    path.write_text(text)
    command = [sys.executable, str(path), *map(str, arguments)]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr
    return run.stdout.splitlines()


@pytest.mark.slow
def test_killed_workers_lose_nothing_and_nothing_is_counted_twice(tmp_path: Path) -> None:
    pytest.importorskip("distributed")
    one, two = tmp_path / "one.txt", tmp_path / "two.txt"
    assert script(tmp_path, KILLED, one, two) == ["True", "proved 512 True True"]
    assert one.read_bytes() == two.read_bytes()


@pytest.mark.slow
def test_a_deadly_block_and_a_lost_scheduler_leave_a_file_to_resume(tmp_path: Path) -> None:
    pytest.importorskip("distributed")
    path = tmp_path / "c.txt"
    killed, lost, resumed = script(tmp_path, LOST, path)
    assert killed == "a block killed worker after worker"
    assert lost == "the scheduler is lost"
    assert resumed == "proved True"


@pytest.mark.slow
def test_a_local_cluster_by_command(tmp_path: Path) -> None:
    pytest.importorskip("distributed")
    fold, file = tmp_path / "p.fold", tmp_path / "c.txt"
    pattern = random_square(11, seed=1)
    write_fold(pattern, fold)
    command = [
        sys.executable,
        "-c",
        "from exactfold.app.cli import main; main()",
        "count",
        str(fold),
    ]
    options = ["--stream", str(file), "--dask", "local", "--workers", "1", "--json"]
    with socket.socket() as other:
        with suppress(OSError):  # the port of dask's dashboard is taken, by us or by others
            other.bind(("127.0.0.1", 8787))
            other.listen()
        run = subprocess.run([*command, *options], capture_output=True, text=True, check=False)
    assert (run.returncode, run.stderr) == (0, "")
    assert json.loads(run.stdout)["distinct"] == 2048
    stream_branches(pattern, tmp_path / "whole.txt")
    assert file.read_bytes() == (tmp_path / "whole.txt").read_bytes()


def test_a_scheduler_that_does_not_answer_is_bad_input(tmp_path: Path) -> None:
    pytest.importorskip("distributed")
    for address in ("tcp://127.0.0.1:1", "nonsense://x"):
        with pytest.raises(ClusterError, match="no scheduler"), dask_engine(address, timeout=0.2):
            raise AssertionError("no engine should be there")


@pytest.mark.parametrize("address", ["nonsense", "foo://x:1", "tcp://x", "host:99999", ""])
def test_an_address_that_cannot_be_read_is_bad_input_at_once(tmp_path: Path, address: str) -> None:
    """In a process of its own: the client that dask would make of it hangs at the end."""
    pytest.importorskip("distributed")
    command = [sys.executable, "-m", "exactfold", "count", str(example_path("random-8"))]
    command += ["--stream", str(tmp_path / "c.txt"), "--dask", address]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=60)
    assert done.returncode == 3
    assert done.stderr.startswith(f"exactfold: no scheduler at {address}: ")
    assert done.stderr.count("\n") == 1


def test_without_dask_the_extra_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(PackageMissingError, match=r"exactfold\[dask\]"), dask_engine("local"):
        raise AssertionError("no engine should be there")
    file = tmp_path / "c.txt"
    result = CliRunner().invoke(app, ["count", str(TWO), "--stream", str(file), "--dask", "local"])
    assert result.exit_code == 2
    assert "exactfold[dask]" in result.stderr
    assert not file.exists()


def test_a_task_is_a_block_and_knows_its_version(monkeypatch: pytest.MonkeyPatch) -> None:
    """Run here as a worker runs it: the tasks carry all they need, and no boxes go back."""
    branch_blocks = BranchBlocks.of(random_square(5, seed=1), 8)
    pattern = branch_blocks.problem.pattern
    spec = (engine_module.version("exactfold"), pattern.vertices, pattern.triangles, 8)
    for index in (3, 0):
        block, line = prove_block(spec, index)
        expected = branch_blocks.prove(index)
        assert line == block_line(expected)
        assert (block.index, block.steps, block.boxes.centers.size) == (index, expected.steps, 0)
    with pytest.raises(ClusterError, match="not other"):
        prove_block(("other", *spec[1:]), 0)


class StandIn:
    """What a pool needs of dask: tasks end in their order, and deaths blame their neighbours."""

    class KilledWorker(Exception):
        """A task was there whenever a worker died."""

    loop = None

    def __init__(self, deadly: int) -> None:
        self.deadly, self.tasks, self.bunches = deadly, [], []

    def nthreads(self) -> dict[str, int]:
        return {"one": 1}

    def submit(self, function: object, *args: object, pure: bool) -> Task:
        self.bunches.append(list(args[-1]))
        return Task(self, function, args)

    def as_completed(self, loop: object) -> StandIn:
        return self

    def add(self, task: Task) -> None:
        self.tasks.append(task)

    def __iter__(self) -> StandIn:
        return self

    def __next__(self) -> Task:
        if not self.tasks:
            raise StopIteration
        self.dying = any(self.deadly in task.jobs for task in self.tasks[:2])
        return self.tasks.pop(0)


class Task:
    """A task of it."""

    def __init__(self, client: StandIn, function: object, args: tuple[object, ...]) -> None:
        self.client, self.function, self.args, self.jobs = client, function, args, args[-1]

    def result(self) -> object:
        if self.client.dying:
            raise self.client.KilledWorker
        return self.function(*self.args)


def test_short_jobs_go_in_bunches_and_only_the_deadly_one_is_blamed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Jobs beside it, in its bunch or on the same worker, are run again, each by itself."""
    client = StandIn(40)
    monkeypatch.setitem(sys.modules, "distributed", client)
    found = dict(pools._on_cluster(client, lambda k: k**2, range(200)))
    assert isinstance(found.pop(40), WorkerDiedError)
    assert found == {k: k**2 for k in range(200) if k != 40}
    assert [len(bunch) for bunch in client.bunches[:5]] == [1, 1, 1, 2, 2]
    assert [40] in client.bunches
    assert sum(40 in bunch for bunch in client.bunches) == 2
    assert sum(map(len, client.bunches)) < 300
