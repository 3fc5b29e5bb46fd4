"""Run the same duels on every executor, and kill a worker of each.

Every run must have the same records as one in a single process, also those
whose worker was killed: at once, or after the same command is started again::

    python tools/checks/executors.py pool dask scheduler mpi shards slurm

``dask`` starts a scheduler and two workers of its own; ``scheduler`` starts
the scheduler again as well. ``mpi`` needs ``mpiexec``, ``slurm`` a running
Slurm.
"""

import argparse
import json
import os
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path

from stepaside.studies.result_store import ResultStore

BIN = Path(sys.executable).parent
ROOT_RANKS = {
    "OMPI_ALLOW_RUN_AS_ROOT": "1",
    "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
}
MACHINE = {"wall_s"}  # values that depend on the machine
ENGINES = ("pool", "dask", "scheduler", "mpi", "shards", "slurm")
Kill = Callable[["subprocess.Popen[bytes]"], None]


class Check:
    """Duels of one length, in a folder.

    Attributes:
        folder: Folder of all outputs.
        words: Options of the command.
    """

    def __init__(self, folder: Path, seeds: int, duration: float) -> None:
        """Choose the duels."""
        self.folder = folder
        self.words = [f"--seeds=0:{seeds}", f"--duration={duration}"]

    def start(
        self, name: str, *options: str, prefix: tuple[str, ...] = ()
    ) -> "subprocess.Popen[bytes]":
        """Start the command with an output folder of a name."""
        before = prefix or (sys.executable, "-m")
        output = f"--output={self.folder / name}"
        return subprocess.Popen(
            [*before, "stepaside", "duels", *self.words, output, *options],
            stdout=subprocess.DEVNULL,
            env=os.environ | ROOT_RANKS,
        )

    def table(self, name: str) -> str:
        """Return the records of an output, without the machine's values."""
        store = ResultStore(self.folder / name / "records")
        rows = {
            key: {k: v for k, v in record.items() if k not in MACHINE}
            for key, record in sorted(store.read().items())
        }
        return json.dumps(rows, sort_keys=True)

    def count(self, name: str) -> int:
        """Return the number of records of an output."""
        return len(ResultStore(self.folder / name / "records").read())

    def compare(
        self, name: str, wanted: str, *options: str, **more: Kill
    ) -> None:
        """Run with and without a killed worker, and compare the records."""
        self._run(name, wanted, None, options)
        for how, kill in more.items():
            self._run(f"{name}-{how}", wanted, kill, options)

    def _run(
        self,
        name: str,
        wanted: str,
        kill: Kill | None,
        options: tuple[str, ...],
        prefix: tuple[str, ...] = (),
    ) -> None:
        process = self.start(name, *options, prefix=prefix)
        if kill is not None:
            while self.count(name) < 3 and process.poll() is None:
                time.sleep(0.1)
            kill(process)
        status, again = process.wait(), 0
        while status and again < 3:
            again += 1
            status = self.start(name, *options, prefix=prefix).wait()
        same = self.table(name) == wanted
        print(
            f"{name}: {'identical' if same else 'DIFFERENT'}, "
            f"{self.count(name)} records, started again {again} times",
            flush=True,
        )
        if status or not same:
            raise SystemExit(1)


def children(process: int) -> Iterator[tuple[int, str]]:
    """Yield number and command line of all descendants of a process."""
    for entry in Path("/proc").iterdir():
        if not entry.name.isdigit():
            continue
        try:
            parent = int(
                (entry / "stat").read_text().rpartition(")")[2].split()[1]
            )
            line = (entry / "cmdline").read_text().replace("\0", " ")
        except OSError:
            continue
        if parent == process:
            yield int(entry.name), line
            yield from children(int(entry.name))


def kill_child(word: str) -> Kill:
    """Return a function that kills a descendant with a word in its line."""

    def kill(process: "subprocess.Popen[bytes]") -> None:
        found = [pid for pid, line in children(process.pid) if word in line]
        os.kill(found[-1], signal.SIGKILL)

    return kill


class DaskCluster:
    """Scheduler and two workers, each a process."""

    def __init__(self, stack: ExitStack) -> None:
        """Start them; they end with the stack."""
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            self.port = free.getsockname()[1]
        self.address = f"tcp://127.0.0.1:{self.port}"
        self._stack = stack
        self.scheduler = self._start(
            "scheduler", "--port", str(self.port), "--no-dashboard"
        )
        self.workers = self._start_workers()

    def _start_workers(self) -> "list[subprocess.Popen[bytes]]":
        return [
            self._start(
                *("worker", self.address, "--nthreads", "1"),
                *("--no-dashboard", "--death-timeout", "60"),
            )
            for _ in range(2)
        ]

    def _start(self, *words: str) -> "subprocess.Popen[bytes]":
        process = subprocess.Popen(
            [BIN / "dask", *words],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            cwd=tempfile.mkdtemp(),
        )
        self._stack.callback(process.wait)
        self._stack.callback(process.terminate)
        return process

    def kill_worker(self, _: object) -> None:
        """Kill the process that a nanny watches."""
        kill_child("python")(self.workers[0])

    def restart_scheduler(self, _: object) -> None:
        """Kill the scheduler, and start it and workers again."""
        self.scheduler.kill()
        self.scheduler.wait()
        self.scheduler = self._start(
            "scheduler", "--port", str(self.port), "--no-dashboard"
        )
        self.workers = self._start_workers()


def shards(check: Check, wanted: str) -> None:
    """Run four shards, kill one and start it again; merge all."""
    names = [f"shard-{number}" for number in range(1, 5)]
    for number, name in enumerate(names, 1):
        options = (f"--shard={number}/4", "--workers=1")
        process = check.start(name, *options)
        if number == 2:
            while check.count(name) < 2 and process.poll() is None:
                time.sleep(0.1)
            process.kill()
        if process.wait():
            check.start(name, *options).wait()
    parts = [str(check.folder / name) for name in names]
    words = [sys.executable, "-m", "stepaside", "merge", *parts]
    subprocess.run(
        [*words, "--output", str(check.folder / "merged")],
        check=True,
        stdout=subprocess.DEVNULL,
    )
    same = check.table("merged") == wanted
    print(f"shards merged: {'identical' if same else 'DIFFERENT'}", flush=True)
    if not same:
        raise SystemExit(1)


def cancel_job(_: object) -> None:
    """Kill the processes of one Slurm job."""
    jobs = subprocess.run(
        ["squeue", "--noheader", "--states=R", "--format=%i"],
        capture_output=True,
        text=True,
        check=True,
    ).stdout.split()
    subprocess.run(["scancel", "--signal=KILL", "--full", jobs[0]], check=True)


def main() -> None:
    """Run the checks."""
    parser = argparse.ArgumentParser(
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("engines", nargs="+", choices=ENGINES)
    parser.add_argument("--seeds", type=int, default=40)
    parser.add_argument("--duration", type=float, default=2.0)
    asked = parser.parse_args()
    folder = Path(tempfile.mkdtemp())
    check = Check(folder, asked.seeds, asked.duration)
    try:
        check.start("one", "--workers=1").wait()
        wanted = check.table("one")
        for engine in asked.engines:
            _check_engine(check, engine, wanted)
    finally:
        shutil.rmtree(folder)


def _check_engine(check: Check, engine: str, wanted: str) -> None:
    if engine == "pool":
        spawned = kill_child("spawn_main")
        check.compare("pool", wanted, "--workers=2", killed=spawned)
    elif engine in ("dask", "scheduler"):
        with ExitStack() as stack:
            cluster = DaskCluster(stack)
            option = f"--executor=dask:{cluster.address}"
            if engine == "dask":
                killed = cluster.kill_worker
                check.compare("dask", wanted, option, killed=killed)
            else:
                check._run(
                    "scheduler", wanted, cluster.restart_scheduler, (option,)
                )
    elif engine == "mpi":
        mpiexec = shutil.which("mpiexec", path=f"{BIN}:{os.environ['PATH']}")
        assert mpiexec, "mpi needs mpiexec"
        prefix = (mpiexec, "--oversubscribe", "-n", "3", sys.executable)
        prefix = (*prefix, "-m", "mpi4py.futures", "-m")
        option = ("--executor=mpi",)
        check._run("mpi", wanted, None, option, prefix)
        rank = kill_child("mpi4py.futures")
        check._run("mpi-killed", wanted, rank, option, prefix)
    elif engine == "shards":
        shards(check, wanted)
    else:
        options = ("--executor=slurm", "--workers=2")
        check.compare("slurm", wanted, *options, killed=cancel_job)


if __name__ == "__main__":
    main()
