"""Time our inverse kinematics against one that calls MuJoCo, in two duels.

The duels have the same seed. They and the bare physics of the same motion
alternate, fifty ticks each, in one process on one core::

    python tools/benchmarks/inverse_kinematics_timing.py --output legs.json
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from collections.abc import Callable
from time import process_time
from typing import Any
from unittest.mock import patch

import mujoco
import numpy as np
from benchmark_options import ask, machine
from mujoco_inverse_kinematics import MujocoLegs

from stepaside.core.poses import Array
from stepaside.games.duel import Duel
from stepaside.games.duel_settings import DuelSettings
from stepaside.games.walker import SimulatedPlayer
from stepaside.robots.leg_kinematics import LegKinematics
from stepaside.studies.result_files import header, write_result

CHUNK = 50  # ticks between two alternations
LEGS = "stepaside.control.scheme_builder.LegKinematics"
# Load compensation is the same on both sides, and left out.
LOAD = "stepaside.control.scheme_builder.LoadFeedforward"
KINDS: dict[str, Callable[..., Any]] = {
    "mujoco": MujocoLegs,
    "numbers": LegKinematics,
}


def _no_load(*_: Any, **__: Any) -> None:
    """Return no load compensation."""


class Side:
    """Duel with one kind of legs, and the bare physics of its motion."""

    def __init__(self, kind: str, settings: DuelSettings) -> None:
        """Place the robots at their initial poses."""
        with patch(LEGS, KINDS[kind]), patch(LOAD, _no_load):
            self.duel = Duel(settings)
        self.walkers = [
            p for p in self.duel.players if isinstance(p, SimulatedPlayer)
        ]
        world = self.duel.world
        self.model, self.data = world.model, world.data
        self.steps = world.physics.steps_per_tick
        self.bare = mujoco.MjData(self.model)
        mujoco.mj_copyData(self.bare, self.model, self.data)
        self.whole: list[float] = []
        self.physics: list[float] = []
        self.update: list[float] = []
        self.targets: list[Array] = []

    def play(self) -> None:
        """Run some ticks of the duel, then their bare physics."""
        commands = np.empty((CHUNK, self.model.nu))
        start = process_time()
        for tick in range(CHUNK):
            if self.duel.tick() is not None:
                raise SystemExit("the duel ended early")
            commands[tick] = self.data.ctrl
        self.whole.append(process_time() - start)
        start = process_time()
        for command in commands:
            self.bare.ctrl[:] = command
            mujoco.mj_step(self.model, self.bare, nstep=self.steps)
        self.physics.append(process_time() - start)
        if not np.array_equal(self.bare.qpos, self.data.qpos):
            raise SystemExit("the bare run went another way")

    def control(self) -> None:
        """Run some ticks, and time the control part of each."""
        spent = 0.0
        for _ in range(CHUNK):
            for walker in self.walkers:
                measured = walker.robot.read()
                start = process_time()
                targets = walker.scheme.update(measured)
                spent += process_time() - start
                walker.robot.write(targets)
            self.duel.world.step()
            self.targets.append(targets)
        self.update.append(spent / CHUNK / len(self.walkers))


def measure_legs(duration: float) -> dict[str, float]:
    """Return tick and duel times of both sides, and their ratios."""
    settings = DuelSettings(seed=1, duration=duration)
    turns = round(duration / settings.physics.tick / CHUNK)
    played = {kind: Side(kind, settings) for kind in KINDS}
    timed = {kind: Side(kind, settings) for kind in KINDS}
    for _ in range(turns):
        for kind in KINDS:
            played[kind].play()
            timed[kind].control()
    figures = {}
    for kind in KINDS:
        whole, bare = np.array([played[kind].whole, played[kind].physics])
        tick = np.array(timed[kind].update)
        figures[f"{kind}_update_us"] = 1e6 * float(np.median(tick))
        figures[f"{kind}_duel_over_bare"] = float(np.median(whole / bare))
    old, new = (np.array(timed[kind].update) for kind in KINDS)
    figures["update_numbers_over_mujoco"] = float(np.median(new / old))
    return figures


def main() -> None:
    """Measure, write and print the results."""
    asked = ask(__doc__, "legs.json")
    asked.add_argument("--duration", type=float, default=30.0)
    arguments = asked.parse_args()
    figures = measure_legs(arguments.duration)
    head = header({"seed": 1, "duration_s": arguments.duration})
    write_result(arguments.output, head, machine=machine(), figures=figures)
    for name, value in figures.items():
        print(f"{name}: {value:.3g}")


if __name__ == "__main__":
    main()
