"""Time duels on learned legs beside the bare physics of the same motion.

A recorded duel is played, then its commands are given to ``mj_step`` alone in
the same process; both end in the same state. Processor time, least of some
rounds::

    python tools/benchmarks/policy_duel_cost.py runs/g1 runs/policy.onnx
"""

from argparse import Namespace
from dataclasses import replace
from pathlib import Path
from time import thread_time

import mujoco
import numpy as np
from benchmark_options import ask, machine

from stepaside.core.poses import Array
from stepaside.games.duel import Duel
from stepaside.games.duel_settings import DuelSettings
from stepaside.games.robot_settings import with_legs, with_robot
from stepaside.studies.result_files import header, write_result

DURATION = 20.0  # of the duel, in [s]
ROUNDS = 5


def measure_cost(robot: str, network: str) -> dict[str, float | bool]:
    """Return simulated seconds per processor second of both ways."""
    settings = with_legs(with_robot(DuelSettings(), robot), network)
    settings = replace(settings, duration=DURATION, seed=7)
    played = bare = np.inf
    equal = True
    for _ in range(ROUNDS):
        duel = Duel(settings)
        world = duel.world
        data = mujoco.MjData(world.model)
        mujoco.mj_copyData(data, world.model, world.data)
        commands: list[Array] = []
        begin = thread_time()
        while world.time < DURATION:
            duel.tick()
            commands.append(world.data.ctrl.copy())
        played = min(played, thread_time() - begin)
        steps = world.physics.steps_per_tick
        begin = thread_time()
        for command in commands:
            data.ctrl[:] = command
            mujoco.mj_step(world.model, data, nstep=steps)
        bare = min(bare, thread_time() - begin)
        equal &= bool(np.array_equal(data.qpos, world.data.qpos))
        duel.close()
    return {
        "duel_s_per_s": DURATION / played,
        "bare_s_per_s": DURATION / bare,
        "duel_over_bare": played / bare,
        "equal": equal,
    }


def main() -> None:
    """Measure, write and print the results."""

    def name_of(given: Namespace) -> str:
        return f"policy-duel-cost-{given.network.stem}.json"

    parser = ask(__doc__, name_of)
    parser.add_argument("robot", type=Path)
    parser.add_argument("network", type=Path)
    asked = parser.parse_args()
    head = header({"duration_s": DURATION, "rounds": ROUNDS})
    figures = measure_cost(str(asked.robot), str(asked.network))
    write_result(asked.output, head, machine=machine(), figures=figures)
    for name, value in figures.items():
        print(f"{name}: {value:.3g}")


if __name__ == "__main__":
    main()
