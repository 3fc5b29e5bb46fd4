"""Play served duels of robots that walk by themselves: three processes each.

Players drive the robots by velocity, over ROS 2 topics or NAOqi calls. Real
time needs cores that are free when a tick is due: as root the processes are
given real-time priority, which the result says.
"""

import json
import os
import socket
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from time import sleep
from typing import Any

from asking import ask, machine
from served import row_of, start

from stepaside.studies.results import header, write_result
from stepaside.studies.version import PHYSICS

ROLES = ("pursuer", "evader")
DUELS = (  # language, body, whether in lock step
    ("ros2", "delayed", True),
    ("ros2", "delayed", False),
    ("ros2", "hardware", False),
    ("naoqi", "delayed", False),
    ("naoqi", "hardware", False),
)
FIRST_PORT = 29559
DOMAIN = 77


def places(way: str) -> dict[str, str]:
    """Where each robot is offered."""
    if way == "ros2":
        return {role: f"/{role}" for role in ROLES}
    return {
        role: f"tcp://127.0.0.1:{FIRST_PORT + i}"
        for i, role in enumerate(ROLES)
    }


def await_world(way: str, world: Any) -> None:
    """Wait until NAOqi listens; on topics who comes first waits."""
    while way == "naoqi" and world.poll() is None:
        with socket.socket() as probe:
            if probe.connect_ex(("127.0.0.1", FIRST_PORT + 1)) == 0:
                return
        sleep(0.1)


@contextmanager
def own_domain() -> Iterator[None]:
    """Meet nobody else on ROS 2 topics."""
    os.environ["ROS_DOMAIN_ID"] = str(DOMAIN)
    yield
    del os.environ["ROS_DOMAIN_ID"]


def played(
    way: str,
    body: str,
    seed: int,
    duration: float,
    *,
    lock_step: bool,
    urgent: bool,
) -> dict[str, Any]:
    """Play one duel, and return what the world printed."""
    words = ["serve", "--seed", str(seed), "--duration", str(duration)]
    words += ["--body", body, "--json", *(["--lockstep"] * lock_step)]
    for role, place in places(way).items():
        words += [f"--{way}", f"{role}={place}"]
    with TemporaryDirectory() as text, own_domain():
        folder = Path(text)
        world = start(words, folder, urgent=urgent)
        await_world(way, world)
        players = [
            start(
                [
                    *("play", "--role", role, "--robot", f"{way}:{place}"),
                    *(["--sim-time"] * lock_step),
                ],
                folder,
                urgent=urgent,
            )
            for role, place in places(way).items()
        ]
        printed, _ = world.communicate()
        for player in players:
            player.communicate(timeout=60.0)
    found: dict[str, Any] = json.loads(printed)
    return found


def main() -> None:
    """Play each language, each body, in each time."""
    parser = ask(__doc__, "driven.json")
    parser.add_argument("--seed", type=int, default=7)
    parser.add_argument("--duration", type=float, default=120.0)
    options = parser.parse_args()
    urgent = os.geteuid() == 0
    rows = []
    for way, body, lock_step in DUELS:
        found = played(
            way,
            body,
            options.seed,
            options.duration,
            lock_step=lock_step,
            urgent=urgent,
        )
        rows.append({"way": way, **row_of(body, lock_step, found)})
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
