"""Selection of the tests for each fault, and their execution."""

import json
import os
import signal
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from . import reach, trial
from .faults import Fault
from .mention import Index
from .runner import Job, numba_cache, run_jobs
from .source import Source
from .tree import Tree, digest, files_of

# Paths below src/stepaside/ with compiled functions, or with their inputs.
COMPILED = (
    "theory/unicycle/",
    "theory/bound/",
    "theory/laws.py",
    "strategies/search/",
)


def record_reach(
    root: Path, trees: list[Tree], tests: list[str], out: Path
) -> dict[str, reach.Reach]:
    """Record what tests reach, once per version of tests and code.

    Args:
        root: Tree with the package and its tests.
        trees: Scratch copies of the tree.
        tests: Test files, relative to the tree.
        out: Folder of the records.

    Returns:
        What the tests of each file reach.
    """
    helpers = [
        file
        for file in files_of(root)
        if file.parts[0] == "src"
        or (file.parts[0] == "tests" and not file.match("tests/test_*.py"))
    ]
    common = digest(root, [f for f in helpers if "mutation" not in f.parts])
    paths = {}
    for file in tests:
        mark = f"{common}-{digest(root, [Path(file)])}"
        paths[file] = out / f"reach-{Path(file).stem}-{mark}.json"

    def jobs() -> Iterator[Job]:
        for file, path in paths.items():
            if not path.exists():

                def work(
                    tree: Tree, file: str = file, path: Path = path
                ) -> None:
                    numba_cache(tree, fresh=False)
                    reach.record(tree.path, file, path)

                yield Job(file, lambda tree: None, work)

    for job, tree, _ in run_jobs(jobs(), trees):
        log = tree.path.with_suffix(".log").read_text(encoding="utf-8")
        last = log.strip().splitlines()[-1:] or ["no word"]
        print(f"reach of {job.name}: {last[0]}", flush=True)
    return {file: reach.load(path) for file, path in paths.items()}


def try_faults(
    faults: list[Fault],
    texts: Mapping[str, str],
    index: Index,
    trees: list[Tree],
    cap: float,
) -> Iterator[dict[str, Any]]:
    """Run the tests that reach each fault.

    Args:
        faults: Faults to try.
        texts: Text of each file.
        index: Index from lines to tests.
        trees: Scratch copies of the tree.
        cap: Maximum processor time of the tests of one fault, in [s].

    Yields:
        Record of each fault as its trial ends.
    """
    chosen = {
        fault.key: trial.choose(
            index.tests(fault), index.times, cap, index.near(fault)
        )
        for fault in faults
    }
    by_key = {fault.key: fault for fault in faults}
    for fault in faults:
        if not chosen[fault.key]:
            yield _row(fault, "unreached", "")

    def jobs() -> Iterator[Job]:
        for fault in faults:
            if chosen[fault.key]:
                yield job_of(
                    fault, texts[fault.file], index, chosen[fault.key]
                )

    for job, tree, status in run_jobs(jobs(), trees):
        note = tree.path.with_suffix(".note").read_text(encoding="utf-8")
        yield _row(by_key[job.name], *verdict(note, status))


def job_of(fault: Fault, text: str, index: Index, chosen: list[str]) -> Job:
    """Return the job that tries one fault.

    Args:
        fault: Fault to apply.
        text: Text of its file.
        index: Index from lines to tests.
        chosen: Tests to run.
    """

    def prepare(tree: Tree) -> None:
        # A process that dies early must not leave the previous verdict.
        note = tree.path.with_suffix(".note")
        note.write_text("before the first test", encoding="utf-8")
        tree.change(fault.file, Source(text).apply(fault.edit))

    def work(tree: Tree) -> None:
        anew = is_compiled(fault.file)
        numba_cache(tree, fresh=anew)
        times = {test: index.times[test] for test in chosen}
        spare = trial.COMPILING if anew else trial.SPARE
        note = tree.path.with_suffix(".note")
        trial.run(tree.path, times, note, spare, index.near(fault))

    return Job(fault.key, prepare, work)


def is_compiled(file: str) -> bool:
    """Return whether machine code may depend on a file of the package."""
    return file.removeprefix("src/stepaside/").startswith(COMPILED)


def verdict(note: str, status: int) -> tuple[str, str]:
    """Return the outcome of a trial, and the test that detected the fault.

    Args:
        note: Output of :func:`.trial.run`.
        status: Wait status of its process.
    """
    if note.startswith("{"):
        found = json.loads(note)
        if found["red"]:
            return "killed", found["red"]
        if found["status"] not in trial.RAN:
            return "killed", f"pytest ended with {found['status']}"
        return "survived", ""
    if os.WIFSIGNALED(status) and os.WTERMSIG(status) == signal.SIGXCPU:
        return "timeout", note
    return "killed", f"{note} (the process ended)"


def _row(fault: Fault, outcome: str, test: str) -> dict[str, Any]:
    return {
        "key": fault.key,
        "file": fault.file,
        "line": fault.line,
        "operator": fault.operator,
        "before": fault.before,
        "after": fault.after,
        "outcome": outcome,
        "test": test,
    }
