"""Processes of served duels: one for the simulation, one for each player.

Real time requires free cores at every tick. As root, the processes are
given real-time priority, which the result states.
"""

import json
import os
import subprocess
import sys
from argparse import Namespace
from collections.abc import Callable, Iterable
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from benchmark_options import machine

from stepaside.studies.result_files import header, write_result

PRIORITY = 10  # priority of the real-time scheduler; the lowest is 1
RUN = "from stepaside.cli.main import main; main()"
URGENT = os.geteuid() == 0
Ready = Callable[[Any, Path], None]
"""Waits until a world, a process in a folder, can be met."""


def start(words: list[str], folder: Path) -> Any:
    """Start one stepaside process."""
    program = [sys.executable, "-c", RUN, *words]
    if URGENT:
        program = ["chrt", "-f", str(PRIORITY), *program]
    return subprocess.Popen(
        program, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL
    )


def play_out(
    arguments: Namespace,
    body: str,
    lock_step: bool,
    offers: list[str],
    players: Iterable[list[str]],
    ready: Ready,
) -> dict[str, Any]:
    """Run one duel.

    Args:
        arguments: Parsed arguments with seed and duration.
        body: Body preset of both robots.
        lock_step: Whether the simulation waits for its players.
        offers: Arguments with the address of each robot.
        players: Arguments of each player.
        ready: Waits for the server.

    Returns:
        Row of the result.
    """
    words = ["serve", "--body", body, "--json", *offers]
    words += ["--seed", str(arguments.seed)]
    words += ["--duration", str(arguments.duration)]
    words += ["--lockstep"] * lock_step
    with TemporaryDirectory() as text:
        folder = Path(text)
        world = start(words, folder)
        ready(world, folder)
        driving = [start(["play", *each], folder) for each in players]
        printed, _ = world.communicate()
        for player in driving:
            player.communicate(timeout=60.0)
    return row_of(body, lock_step, json.loads(printed))


def row_of(
    body: str, lock_step: bool, found: dict[str, Any]
) -> dict[str, Any]:
    """Return the stored values of a duel."""
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


def write_rows(arguments: Namespace, rows: Iterable[dict[str, Any]]) -> None:
    """Print duels as they end, and write them."""
    kept = []
    for row in rows:
        print(json.dumps(row), flush=True)
        kept.append(row)
    settings = {
        "seed": arguments.seed,
        "duration_s": arguments.duration,
        "real_time_priority": URGENT,
    }
    head = header(settings)
    write_result(arguments.output, head, rows=kept, machine=machine())
