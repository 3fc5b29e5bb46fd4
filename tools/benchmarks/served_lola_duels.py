"""Run served duels over LoLA: each body in lockstep and in real time."""

from pathlib import Path
from time import sleep
from typing import Any

from benchmark_options import ask
from served_processes import play_out, write_rows

PLAYERS = {"pursuer": "P", "evader": "E"}
DUELS = [
    (body, lock_step)
    for body in ("delayed", "hardware")
    for lock_step in (True, False)
]


def ready(world: Any, folder: Path) -> None:
    """Wait until the last channel exists."""
    last = folder / f"{PLAYERS['evader']}.ideal-sight"
    while not last.exists() and world.poll() is None:
        sleep(0.05)


def main() -> None:
    """Run each body in lockstep and in real time."""
    parser = ask(__doc__, "served-lola.json")
    parser.add_argument("--seed", type=int, default=7)
    parser.add_argument("--duration", type=float, default=120.0)
    arguments = parser.parse_args()
    offers = [f"--lola={name}={place}" for name, place in PLAYERS.items()]
    players = [
        ["--role", name, "--robot", f"lola:{place}"]
        for name, place in PLAYERS.items()
    ]
    write_rows(
        arguments,
        (
            play_out(arguments, body, lock_step, offers, players, ready)
            for body, lock_step in DUELS
        ),
    )


if __name__ == "__main__":
    main()
