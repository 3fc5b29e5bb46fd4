"""Interrupt every long command by Ctrl-C; measure how soon it ends.

Each command is started as by a terminal, and interrupted after some processor
time: while it imports, starts, and works::

    python -m tools.fuzz.stopping
"""

import argparse
import os
import shutil
import signal
import subprocess
import sys
import tempfile
from pathlib import Path
from time import monotonic, sleep
from typing import Any, NamedTuple

from stepaside.games.duel import run_duel
from stepaside.games.duel_settings import DuelSettings
from stepaside.report.run_folder import write_run
from stepaside.robots.description import load_robot
from stepaside.studies.result_files import header, write_result

from .commands import FILES
from .groups import Worked, members, obey_ctrl_c

# Command lines that last, in a folder that holds what they read.
LONG = {
    "duel": "--duration=3000 --output=duel",
    "game": "game.toml --duration=3000 --output=game",
    "games": "game.toml --seeds=0:1000 --workers=2 --output=many",
    "duels": "--seeds=0:1000 --workers=2 --output=duels",
    "view": "--no-open --port=8761",
    "replay": "run --video=film.mp4 --speed=0.05",
    "walk": "--duration=3000 --output=walk",
    "study": "study.toml --workers=2 --output=study",
    "robustness": "--workers=2 --output=walks",
    "circle": "--starts=1000000",
    "map": "--grid=300 --distances=50",
    "bound": "--grid=200",
    "tournament": "--seeds=0:3000 --workers=2 --output=games",
    "rate": "look-ahead --games=3000 --workers=2",
    "serve": "--lola=evader=socket --wait=3000",
    "reproduce": "--workers=2 --output=claims",
    "robot check": "robot --workers=2",
    "robot tune": "robot --workers=2",
}
# Commands that end before a user would stop them.
SHORT = {
    "compare",
    "doctor",
    "export",
    "merge",
    "legs convert",
    "legs inspect",
    "page",
    "plan",
    "unicycles",
    "room",
    "robot init",
    "robot show",
}
# The first lets the robot rest before it ends; a second Ctrl-C lets it go
# limp. The other needs a network, and none comes with the package.
APART = {"play", "legs measure"}
MOMENTS = (0.4, 2.0, 4.0, 8.0)  # of processor time, in [s]
LONGEST = 40.0  # that is waited for a moment, in [s]
GIVEN_UP = 60.0  # that is waited for an end, in [s]


class Stopped(NamedTuple):
    """End of an interrupted command.

    Attributes:
        after_s: Processor time before the interruption.
        ended_s: Time until the command and its workers had ended.
        worked_s: Processor time of all of them after the interruption, which
            equals that time on an idle machine.
        status: Exit status, as a shell reports it.
        said: Last line of its output.
    """

    after_s: float
    ended_s: float
    worked_s: float
    status: int
    said: str


def stop(words: list[str], folder: Path, moment: float) -> Stopped:
    """Run a command in a copy of a folder, interrupt it, wait for its end."""
    with tempfile.TemporaryDirectory() as place:
        shutil.copytree(folder, place, dirs_exist_ok=True)
        return _stop(words, place, moment)


def _stop(words: list[str], folder: str, moment: float) -> Stopped:
    process = subprocess.Popen(
        [sys.executable, "-m", "stepaside", *words],
        cwd=folder,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    began, worked = monotonic(), Worked(process)
    while worked.until_now() < moment and monotonic() - began < LONGEST:
        sleep(0.02)
    if process.poll() is not None:
        assert process.stderr is not None
        raise SystemExit(f"{words} ended: {process.stderr.read()}")
    after, pressed = worked.until_now(), monotonic()
    os.killpg(process.pid, signal.SIGINT)
    try:
        _, said = process.communicate(timeout=GIVEN_UP)
        while any(members(process.pid)):
            sleep(0.01)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        process.communicate()
        raise SystemExit(f"{words} does not end") from None
    ended = monotonic() - pressed
    lines = said.replace("\r", "\n").strip().splitlines()
    return Stopped(
        after,
        ended,
        max(worked.until_its_end() - after, 0.0),
        status_of(process.returncode),
        lines[-1] if lines else "",
    )


def status_of(returned: int) -> int:
    """Return the exit status as a shell reports it.

    Python ends itself by the signal if the interrupt arrived while a compiled
    library called Python code.
    """
    return returned if returned >= 0 else 128 - returned


def prepare(folder: Path) -> None:
    """Create a run folder, a robot description, and the file of a game."""
    write_run(folder / "run", run_duel(DuelSettings(duration=20.0)))
    source = load_robot("nao").folder
    shutil.copytree(source, folder / "robot")
    shutil.copy(FILES["game"], folder / "game.toml")


def main() -> None:
    """Interrupt all commands, and write the result."""
    parser = argparse.ArgumentParser(
        prog="python -m tools.fuzz.stopping", description=__doc__
    )
    add = parser.add_argument
    add("--only", nargs="*", default=list(LONG), choices=list(LONG))
    add("--keep", type=Path, help="result to write")
    asked = parser.parse_args()
    obey_ctrl_c()
    rows: list[dict[str, Any]] = []
    with tempfile.TemporaryDirectory() as name:
        prepare(Path(name))
        for command in asked.only:
            words = [*command.split(), *LONG[command].split()]
            stops = [stop(words, Path(name), moment) for moment in MOMENTS]
            row = {"command": " ".join(words)}
            rows.append(row | {"stops": [each._asdict() for each in stops]})
            print(rows[-1], flush=True)
    if asked.keep:
        write_result(
            asked.keep,
            header(
                {"moments_s": list(MOMENTS)},
                modules=("cli", "core/signal_handling", "core/worker_pool"),
                command="python -m tools.fuzz.stopping --keep "
                f"docs/results/{asked.keep.name}",
            ),
            load=os.getloadavg()[0],
            cores=os.cpu_count(),
            rows=rows,
        )


if __name__ == "__main__":
    main()
