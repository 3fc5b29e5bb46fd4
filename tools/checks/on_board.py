r"""Play recorded measurements on a processor like a robot's.

A robot's processor is older than a desk's: NAO's Atom has no AVX. A duel's
worth of maneuvers is recorded here, once, from simulation; control then runs
on it where nothing of a simulator may be imported, and must ask for the same
joint targets:

    apt-get install qemu-user
    python tools/checks/on_board.py record /tmp/recorded.npz
    python tools/checks/on_board.py play /tmp/recorded.npz
    qemu-x86_64 -cpu Nehalem .venv/bin/python tools/checks/on_board.py play \
        /tmp/recorded.npz

Prints, as JSON: how far targets are from the recorded ones, top-level
packages that were imported, resident memory, the time from the start of the
process until control is ready, and the processor time of a tick; times under
emulation mean nothing. ``tools/checks/README.md`` holds what came out.
"""

import argparse
import json
import os
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np

SECONDS = 20.0
SEED = 7
ROLES = ("pursuer", "evader")
TICK = 0.012
ABSENT = ("mujoco", "scipy", "matplotlib", "cv2")
AMONG_TICKS = 0.99  # percentile of the tick times that is reported


def record(file: Path) -> None:
    """Record the measurements and joint targets of two robots."""
    from stepaside.games.game_settings import duel
    from stepaside.games.players import RobotPlayer
    from stepaside.games.recorded_game import RecordedGame
    from stepaside.locomotion.control_settings import STABILISED
    from stepaside.sim.body_settings import BODIES

    settings = duel(
        seed=SEED,
        duration=SECONDS,
        body=BODIES["delayed"],
        control=STABILISED,
    )
    world = RecordedGame(settings, recorded=False).in_physics
    rows: dict[str, list[Any]] = {role: [] for role in ROLES}
    for _ in range(round(SECONDS / TICK)):
        for player in world.players:
            assert isinstance(player, RobotPlayer)
            m = player.robot.read()
            targets = player.scheme.update(m).copy()
            player.robot.write(targets)
            seen = (np.nan,) * 3 if m.sighting is None else m.sighting[:3]
            sensed = (m.joint_positions, m.gyro, m.accelerometer)
            row = [m.time], *sensed, m.foot_forces, seen, targets
            rows[player.name].append(np.concatenate(row))
        world.step()
    kept = {role: np.array(rows[role]) for role in ROLES}
    np.savez_compressed(file, allow_pickle=False, **kept)


def play(file: Path) -> dict[str, Any]:
    """Run the controller on recorded measurements."""
    for name in ABSENT:
        sys.modules[name] = None  # type: ignore[assignment]
    from stepaside.drivers.scheme_factory import scheme_factory
    from stepaside.locomotion.control_settings import STABILISED
    from stepaside.perception.measurement import RobotState, Sighting
    from stepaside.planning import GaitSettings
    from stepaside.robots.description import load_robot
    from stepaside.strategies import Evasion, Pursuit

    make = scheme_factory(
        load_robot("nao"), GaitSettings(), STABILISED, tick=TICK
    )
    first = make(Pursuit())
    ready = age()
    minds = {"pursuer": first, "evader": make(Evasion())}
    found: dict[str, Any] = {"ready_s": ready, "resident_mb": resident()}
    worst, spent, walked = 0.0, [], 0
    with np.load(file, allow_pickle=False) as recorded:
        tables = {role: recorded[role] for role in ROLES}
    for role, mind in minds.items():
        joints = len(mind.joint_targets)
        for row in tables[role]:
            now, rest = float(row[0]), row[1:]
            encoders, rest = rest[:joints], rest[joints:]
            seen = rest[14:17]
            sighting = None if np.isnan(seen[0]) else Sighting(*seen.tolist())
            m = RobotState(
                now, encoders, rest[:3], rest[3:6], rest[6:14], sighting
            )
            clock = time.process_time()
            targets = mind.update(m)
            spent.append(time.process_time() - clock)
            worst = max(worst, float(np.abs(targets - rest[17:]).max()))
            walked += mind.begun is not None
    packages = {name.partition(".")[0] for name, m in sys.modules.items() if m}
    packages -= set(sys.stdlib_module_names) | {"__main__"}
    return found | {
        "greatest_difference_rad": worst,
        "ticks": len(spent),
        "steps_begun": walked,
        "tick_ms": 1e3 * float(np.median(spent)),
        "slow_tick_ms": 1e3 * float(np.quantile(spent, AMONG_TICKS)),
        "resident_at_the_end_mb": resident(),
        "packages": sorted(packages),
        "avx": has_avx(),
    }


def age() -> float:
    """Return the time since this process began, in [s]."""
    words = Path("/proc/self/stat").read_text().rpartition(")")[2].split()
    began = int(words[19]) / os.sysconf("SC_CLK_TCK")
    return float(Path("/proc/uptime").read_text().split()[0]) - began


def resident() -> float:
    """Return the resident memory, including an emulator's, in [MB]."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6


def has_avx() -> bool:
    """Return whether NumPy detects AVX on this processor."""
    from numpy._core._multiarray_umath import __cpu_features__

    return bool(__cpu_features__["AVX"])


def main() -> None:
    """Record or play."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("what", choices=("record", "play"))
    parser.add_argument("file", type=Path)
    options = parser.parse_args()
    if options.what == "record":
        record(options.file)
    else:
        print(json.dumps(play(options.file), indent=1))


if __name__ == "__main__":
    main()
