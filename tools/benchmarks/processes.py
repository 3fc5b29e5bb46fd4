"""Served duels: a world and two players, three processes each.

Real time needs cores that are free when a tick is due: as root the processes
are given real-time priority, which the result says.
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

from asking import machine

from stepaside.studies.code_version import PHYSICS
from stepaside.studies.result_files import header, write_result

PRIORITY = 10  # of the real-time scheduler; the least is 1
RUN = "from stepaside.cli.main import main; main()"
URGENT = os.geteuid() == 0
Ready = Callable[[Any, Path], None]
"""Waits until a world, a process in a folder, can be met."""


def start(words: list[str], folder: Path) -> Any:
    """Start one process of stepaside."""
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
    """Play one duel.

    Args:
        arguments: Have seed and duration.
        body: What both robots are like.
        lock_step: Whether the world waits for its players.
        offers: Words that say where the robots are offered.
        players: Words that say whom each player drives.
        ready: Waits for the world.

    Returns:
        What is kept of what the world printed.
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
    head = header(settings, modules=(*PHYSICS, "drivers"))
    write_result(arguments.output, head, rows=kept, machine=machine())
