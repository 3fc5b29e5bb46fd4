"""Time the physics of many duels in one batch against one after the other.

All duels have one model and repeat the commands of a played duel, each from a
slightly different heading of its robots. ``mujoco.batch`` steps them on
threads; both ways give the same bits::

    python tools/benchmarks/batched_physics.py --duels 16
"""

from time import perf_counter

import mujoco
import numpy as np
from benchmark_options import ask, machine
from mujoco.batch import Batch

from stepaside.core.poses import Array
from stepaside.games.duel import Duel
from stepaside.games.duel_settings import DuelSettings
from stepaside.studies.result_files import header, write_result

DURATION = 4.0  # of the duels, in [s]
ROUNDS = 3


def measure_batch(duels: int, threads: int) -> dict[str, float | bool]:
    """Return simulated seconds per second of both ways, on the wall clock."""
    duel = Duel(DuelSettings(seed=1), recorded=False)
    world = duel.world
    model, data, physics = world.model, world.data, world.physics
    initial = mujoco.MjData(model)
    mujoco.mj_copyData(initial, model, data)
    commands: list[Array] = []
    for _ in range(round(DURATION / physics.tick)):
        duel.tick()
        commands.append(data.ctrl.copy())
    starts = initial.qpos + 1e-6 * np.arange(duels)[:, None]
    steps = physics.steps_per_tick
    alone = together = np.inf
    for _ in range(ROUNDS):
        begin = perf_counter()
        ends = []
        for qpos in starts:
            single = mujoco.MjData(model)
            mujoco.mj_copyData(single, model, initial)
            single.qpos[:] = qpos
            for command in commands:
                single.ctrl[:] = command
                mujoco.mj_step(model, single, nstep=steps)
            ends.append(single.qpos.copy())
        alone = min(alone, perf_counter() - begin)
        batch = Batch(model, nsim=duels, nthread=threads)
        state = np.empty(batch.nstate)
        mujoco.mj_getState(
            model, initial, state, mujoco.mjtState.mjSTATE_INTEGRATION
        )
        batch.state[:] = state
        positions, controls = batch.bind("qpos"), batch.bind("ctrl")
        positions[:] = starts
        begin = perf_counter()
        for command in commands:
            controls[:] = command
            batch.step(nstep=steps)
        together = min(together, perf_counter() - begin)
    return {
        "one_by_one_s_per_s": duels * DURATION / alone,
        "batch_s_per_s": duels * DURATION / together,
        "batch_over_one_by_one": alone / together,
        "equal": bool(np.array_equal(positions, np.array(ends))),
    }


def main() -> None:
    """Measure, write and print the results."""
    asked = ask(__doc__, "batched-physics.json")
    asked.add_argument("--duels", type=int, default=16)
    asked.add_argument("--threads", type=int, default=1)
    arguments = asked.parse_args()
    settings = {"duels": arguments.duels, "threads": arguments.threads}
    figures = measure_batch(arguments.duels, arguments.threads)
    head = header(settings | {"duration_s": DURATION})
    write_result(arguments.output, head, machine=machine(), figures=figures)
    for name, value in figures.items():
        print(f"{name}: {value:.3g}")


if __name__ == "__main__":
    main()
