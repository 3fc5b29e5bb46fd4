"""Play served duels: a world and two players, three processes over LoLA.

Each body is played in lock step and in real time. Real time needs cores
that are free when a tick is due: as root the processes are given real-time
priority, which the result says.
"""

import json
import os
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from time import sleep
from typing import Any

from asking import ask, machine

from stepaside.studies.results import header, write_result
from stepaside.studies.version import PHYSICS

PLAYERS = {"pursuer": "P", "evader": "E"}
BODIES = ("delayed", "hardware")
PRIORITY = 10  # of the real-time scheduler; the least is 1
RUN = "from stepaside.cli import main; main()"


def start(words: list[str], folder: Path, *, urgent: bool) -> Any:
    """Start one process of stepaside."""
    program = [sys.executable, "-c", RUN, *words]
    if urgent:
        program = ["chrt", "-f", str(PRIORITY), *program]
    return subprocess.Popen(
        program, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL
    )


def played(
    body: str, seed: int, duration: float, *, lock_step: bool, urgent: bool
) -> dict[str, Any]:
    """Play one duel, and return what the world printed."""
    words = ["serve", "--seed", str(seed), "--duration", str(duration)]
    words += ["--body", body, "--json", *(["--lockstep"] * lock_step)]
    for name, place in PLAYERS.items():
        words += ["--lola", f"{name}={place}"]
    with TemporaryDirectory() as text:
        folder = Path(text)
        world = start(words, folder, urgent=urgent)
        last = folder / f"{PLAYERS['evader']}.ideal-sight"
        while not last.exists() and world.poll() is None:
            sleep(0.05)
        players = [
            start(
                ["play", "--role", name, "--robot", f"lola:{place}"],
                folder,
                urgent=urgent,
            )
            for name, place in PLAYERS.items()
        ]
        printed, _ = world.communicate()
        for player in players:
            player.communicate(timeout=60.0)
    found: dict[str, Any] = json.loads(printed)
    return found


def row_of(body: str, lock_step: bool, found: dict[str, Any]) -> Any:
    """What is kept of a duel."""
    keys = "outcome duration_s distance_m converged_at_s late_ticks".split()
    return {
        "body": body,
        "lock_step": lock_step,
        **{key: found[key] for key in [*keys, "unanswered_frames"]},
        "pursuer_radius_m": found["pursuer"]["radius_m"],
        "evader_radius_m": found["evader"]["radius_m"],
        "theory_radius_m": found["theory"]["radius_m"],
        "lateness_ms": found["lateness_ms"],
    }


def main() -> None:
    """Play each body both ways."""
    parser = ask(__doc__, "served.json")
    parser.add_argument("--seed", type=int, default=7)
    parser.add_argument("--duration", type=float, default=120.0)
    options = parser.parse_args()
    urgent = os.geteuid() == 0
    rows = []
    for body in BODIES:
        for lock_step in (True, False):
            found = played(
                body,
                options.seed,
                options.duration,
                lock_step=lock_step,
                urgent=urgent,
            )
            rows.append(row_of(body, lock_step, found))
            print(json.dumps(rows[-1]), flush=True)
    settings = {
        "seed": options.seed,
        "duration_s": options.duration,
        "real_time_priority": urgent,
    }
    head = header(settings, rooms=(*PHYSICS, "drivers"))
    write_result(options.output, head, rows=rows, machine=machine())


if __name__ == "__main__":
    main()
