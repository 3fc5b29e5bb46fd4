"""Commands ended at a random moment, and started again."""

import json
import os
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator, Mapping
from functools import cache
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory
from time import monotonic, sleep
from typing import Any, NamedTuple

from stepaside.core.atomic_output import DRAFT
from stepaside.core.errors import StepAsideError
from stepaside.games.outcome import Outcome
from stepaside.games.run_archive import load_run
from stepaside.studies.duel_record import digest_of
from stepaside.studies.result_store import parse_line

from .case import Case
from .groups import Worked

SIGNALS = (signal.SIGKILL, signal.SIGTERM, signal.SIGINT)
STOPS = 2.0  # limit of processor time to end after Ctrl-C, in [s]
GIVEN_UP = 100.0  # time after which a command counts as hanging, in [s]


class Trial(NamedTuple):
    """Command to be ended.

    Attributes:
        words: Arguments of Python.
        result: Returns the reproducible result in a folder.
    """

    words: tuple[str, ...]
    result: Callable[[Path], Any]


def _duel(folder: Path) -> Any:
    run = load_run(folder / "out", "duel")
    if run.outcome is Outcome.INTERRUPTED:
        (folder / "out").rename(folder / "cut-short")
        return None
    return digest_of(run)


def _json(*path: str, name: str) -> Callable[[Path], Any]:
    def read(folder: Path) -> Any:
        value = json.loads((folder / "out" / name).read_text())
        for key in path:
            value = value[key]
        return value

    return read


def _bytes(name: str) -> Callable[[Path], Any]:
    return lambda folder: (folder / name).read_bytes()


MAIN = ("-m", "stepaside")
WALKS = "--kind=unevenness --method=open-loop --seeds=1 --workers=2"
TRIALS: Mapping[str, Trial] = {
    "duel": Trial(
        (*MAIN, "duel", "--seed=3", "--duration=0.4", "--output=out"),
        _duel,
    ),
    "map": Trial(
        (
            *(*MAIN, "map", "--grid=8", "--distances=2"),
            *("--figure=map.png", "--overwrite"),
        ),
        _bytes("map.png"),
    ),
    "duels": Trial(
        (
            *(*MAIN, "duels", "--seeds=0:2", "--duration=0.3"),
            *("--workers=1", "--output=out"),
        ),
        _json("summary", name="summary.json"),
    ),
    "robustness": Trial(
        (*MAIN, "robustness", *WALKS.split(), "--output=out"),
        _json("survival", name="survival.json"),
    ),
    "reproduce": Trial(
        ("-m", "tools.fuzz.short_reproduce", "out"),
        _json("rows", name="claims.json"),
    ),
}


# How often each is tried: those more that are soon through.
TURNS = {"duel": 3, "map": 3, "duels": 1, "robustness": 1, "reproduce": 1}


def moment_cases(random: Random, _: Path) -> Iterator[Case]:
    """Yield commands ended at random and started again, without end."""
    while True:
        (name,) = random.choices(list(TURNS), list(TURNS.values()))
        sign = random.choice(SIGNALS)
        yield moment_case(name, sign, random.random())


def moment_case(name: str, sign: signal.Signals, part: float) -> Case:
    """Return a command that is ended after a fraction of its duration."""
    trial = TRIALS[name]

    def run(folder: Path) -> str:
        wanted, lasts = undisturbed(name)
        ended = _end(trial, folder, sign, part * lasts)
        return (
            ended
            or unwhole(folder, killed=sign is signal.SIGKILL)
            or _again(trial, folder, wanted)
        )

    title = f"{name} ended by {sign.name} after {100 * part:.0f} %"
    return Case(f"{name} ended by {sign.name}", title, run, 300.0)


@cache
def undisturbed(name: str) -> tuple[Any, float]:
    """Return the result and duration in [s] of an uninterrupted command."""
    with TemporaryDirectory() as folder:
        began = monotonic()
        start(TRIALS[name], Path(folder)).communicate()
        return TRIALS[name].result(Path(folder)), monotonic() - began


def start(trial: Trial, folder: Path) -> "subprocess.Popen[str]":
    """Start a command as a new process group, as a terminal does."""
    root = Path(__file__).parents[2]
    paths = [str(root / "src"), str(root)]
    return subprocess.Popen(
        [sys.executable, *trial.words],
        cwd=folder,
        env={
            **os.environ,
            "PYTHONPATH": os.pathsep.join(paths),
            "TMPDIR": str(folder),
        },
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )


def _end(
    trial: Trial, folder: Path, sign: signal.Signals, after: float
) -> str:
    """Start and end a command; return what is wrong with its end."""
    process = start(trial, folder)
    worked = Worked(process)
    try:
        process.communicate(timeout=after)
        return ""  # it was through before
    except subprocess.TimeoutExpired:
        pass
    before = worked.until_now()
    if sign is signal.SIGINT:  # Ctrl-C reaches all of a terminal's group
        os.killpg(process.pid, sign)
    else:
        process.send_signal(sign)
    began = monotonic()
    try:
        _, said = process.communicate(timeout=GIVEN_UP)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        process.communicate()
        return f"hang: it went on for {GIVEN_UP:g} s, or its workers did"
    if sign is not signal.SIGKILL:
        if "Traceback" in said and "stepaside" in said:  # not Python's own
            return f"traceback: {said[-600:]!r}"
        work = worked.until_its_end() - before
        if work > STOPS:
            return f"hang: it worked for {work:.1f} s more"
    while _alive(process.pid) and monotonic() - began < GIVEN_UP:
        sleep(0.05)
    return "workers are left" if _alive(process.pid) else ""


def _alive(group: int) -> bool:
    try:
        os.killpg(group, 0)
    except ProcessLookupError:
        return False
    return True


def unwhole(folder: Path, *, killed: bool) -> str:
    """Return which file is incomplete, or an empty string."""
    for file in folder.rglob("*"):
        if DRAFT in str(file):
            if not killed:
                return f"leftovers: {file.name}"
        elif file.suffix == ".json":
            try:
                json.loads(file.read_text())
            except ValueError:
                return f"not whole: {file.name}"
        elif file.suffix == ".jsonl":
            lines = file.read_bytes().splitlines()
            if not killed and not all(map(parse_line, lines)):
                return f"not whole: {file.name}"
        elif file.suffix == ".png":
            raw = file.read_bytes()
            if raw[:4] != b"\x89PNG" or raw[-8:-4] != b"IEND":
                return f"not whole: {file.name}"
    return ""


def _again(trial: Trial, folder: Path, wanted: Any) -> str:
    """Start the command again; return what is wrong with its result."""
    try:
        if trial.result(folder) == wanted:
            return ""  # it was through before
    except (OSError, StepAsideError, KeyError):
        pass
    _, said = start(trial, folder).communicate()
    left = [f.name for f in folder.rglob(f"{DRAFT}*")]
    if left:
        return f"leftovers: {left}"
    try:
        found = trial.result(folder)
    except (OSError, StepAsideError, KeyError) as error:
        return f"no result: {error}: {said[-500:]!r}"
    return "" if found == wanted else "another result"
