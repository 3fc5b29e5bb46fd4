"""Run served duels of robots with their own walking controller.

Players send velocities over ROS 2 topics.
"""

import os
from argparse import Namespace
from pathlib import Path
from typing import Any

from benchmark_options import ask
from served_processes import play_out, write_rows

ROLES = ("pursuer", "evader")
DUELS = (  # body, whether in lockstep
    ("delayed", True),
    ("delayed", False),
    ("hardware", False),
)
DOMAIN = 77  # ROS 2 domain that nothing else uses


def topics_ready(world: Any, folder: Path) -> None:
    """Do nothing: over topics, early clients wait by themselves."""


def played(arguments: Namespace, body: str, lock_step: bool) -> dict[str, Any]:
    """Run one duel."""
    offers, players = [], []
    for role in ROLES:
        offers += ["--ros2", f"{role}=/{role}"]
        players.append(["--role", role, "--robot", f"ros2:/{role}"])
        players[-1] += ["--sim-time"] * lock_step
    found = play_out(arguments, body, lock_step, offers, players, topics_ready)
    return {"way": "ros2", **found}


def main() -> None:
    """Run every body, in lockstep and in real time."""
    parser = ask(__doc__, "served-velocities.json")
    parser.add_argument("--seed", type=int, default=7)
    parser.add_argument("--duration", type=float, default=120.0)
    arguments = parser.parse_args()
    os.environ["ROS_DOMAIN_ID"] = str(DOMAIN)
    write_rows(arguments, (played(arguments, *duel) for duel in DUELS))


if __name__ == "__main__":
    main()
