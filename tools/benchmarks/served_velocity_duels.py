"""Run served duels of robots with their own walking controller.

Players send velocities over ROS 2 topics or NAOqi calls.
"""

import os
import socket
from argparse import Namespace
from pathlib import Path
from time import sleep
from typing import Any

from benchmark_options import ask
from served_processes import Ready, play_out, write_rows

ROLES = ("pursuer", "evader")
DUELS = (  # interface, body, whether in lockstep
    ("ros2", "delayed", True),
    ("ros2", "delayed", False),
    ("ros2", "hardware", False),
    ("naoqi", "delayed", False),
    ("naoqi", "hardware", False),
)
FIRST_PORT = 29559
DOMAIN = 77  # ROS 2 domain that nothing else uses


def places(way: str) -> dict[str, str]:
    """Return the address of each robot."""
    if way == "ros2":
        return {role: f"/{role}" for role in ROLES}
    return {
        role: f"tcp://127.0.0.1:{FIRST_PORT + i}"
        for i, role in enumerate(ROLES)
    }


def naoqi_ready(world: Any, folder: Path) -> None:
    """Wait until the last robot listens."""
    while world.poll() is None:
        with socket.socket() as probe:
            if probe.connect_ex(("127.0.0.1", FIRST_PORT + 1)) == 0:
                return
        sleep(0.1)


def topics_ready(world: Any, folder: Path) -> None:
    """Do nothing: over topics, early clients wait by themselves."""


READY: dict[str, Ready] = {"naoqi": naoqi_ready, "ros2": topics_ready}


def played(
    arguments: Namespace,
    way: str,
    body: str,
    lock_step: bool,
    by: str = "velocity",
) -> dict[str, Any]:
    """Run one duel over one interface, by velocities or another command."""
    offers, players = [], []
    offer = f"--{way}-joints" if by == "joints" else f"--{way}"
    for role, place in places(way).items():
        offers += [offer, f"{role}={place}"]
        players.append(["--role", role, "--robot", f"{way}:{place}"])
        players[-1] += ["--sim-time"] * lock_step
        players[-1] += ["--interface", by] * (by != "velocity")
    found = play_out(arguments, body, lock_step, offers, players, READY[way])
    return {"way": way, **found}


def main() -> None:
    """Run every interface with every body, in lockstep and in real time."""
    parser = ask(__doc__, "served-velocities.json")
    parser.add_argument("--seed", type=int, default=7)
    parser.add_argument("--duration", type=float, default=120.0)
    arguments = parser.parse_args()
    os.environ["ROS_DOMAIN_ID"] = str(DOMAIN)
    write_rows(arguments, (played(arguments, *duel) for duel in DUELS))


if __name__ == "__main__":
    main()
