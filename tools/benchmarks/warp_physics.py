"""Time the physics of many duels on a GPU against processor cores.

All duels have one model and repeat the commands of a played duel, each with
slightly different joint angles at the beginning. MuJoCo Warp steps them on
the GPU, ``mujoco.batch`` on threads of the processor. Where the GPU is, only
``numpy``, ``mujoco`` and ``mujoco_warp`` are needed::

    python tools/benchmarks/warp_physics.py --record runs/warp
    python tools/benchmarks/warp_rates.py runs/warp --output measured.json
    python tools/benchmarks/warp_physics.py --measured measured.json
"""

import json
from pathlib import Path

import mujoco
import numpy as np
from benchmark_options import ask

from stepaside.core.atomic_output import atomic_draft
from stepaside.games.duel import Duel
from stepaside.games.duel_settings import DuelSettings
from stepaside.studies.result_files import header, write_result

DURATION = 4.0  # of the duels, in [s]
SEED = 1
STANDING = 0.7  # lowest height of a standing torso over that at the beginning


def record(folder: Path) -> None:
    """Write a model and the commands of a played duel.

    Raises:
        RuntimeError: If the commands alone do not repeat the duel.
    """
    duel = Duel(DuelSettings(seed=SEED), recorded=False)
    world = duel.world
    model, data, physics = world.model, world.data, world.physics
    kind = mujoco.mjtState.mjSTATE_INTEGRATION
    state = np.empty(mujoco.mj_stateSize(model, kind))
    mujoco.mj_getState(model, data, state, kind)
    roots = model.jnt_qposadr[model.jnt_type == mujoco.mjtJoint.mjJNT_FREE]
    height = float(data.qpos[roots + 2].min())
    commands = []
    for _ in range(round(DURATION / physics.tick)):
        duel.tick()
        commands.append(data.ctrl.copy())
    again = mujoco.MjData(model)
    mujoco.mj_setState(model, again, state, kind)
    for command in commands:
        again.ctrl[:] = command
        mujoco.mj_step(model, again, nstep=physics.steps_per_tick)
    if not np.array_equal(again.qpos, data.qpos):
        raise RuntimeError("the commands do not repeat the duel")
    folder.mkdir(parents=True, exist_ok=True)
    mujoco.mj_saveModel(model, str(folder / "duel.mjb"))
    with atomic_draft(folder / "duel.npz") as draft:
        with draft.open("wb") as file:
            np.savez(
                file,
                state=state,
                commands=np.array(commands),
                torsos=roots,
                standing=STANDING * height,
                steps=physics.steps_per_tick,
            )


def main() -> None:
    """Record a duel, or write the result of what was measured."""
    asked = ask(__doc__, "warp-physics.json")
    what = asked.add_mutually_exclusive_group(required=True)
    what.add_argument("--record", type=Path, metavar="FOLDER")
    what.add_argument("--measured", type=Path, metavar="FILE")
    arguments = asked.parse_args()
    if arguments.record is not None:
        record(arguments.record)
        return
    found = json.loads(arguments.measured.read_text(encoding="utf-8"))
    head = header(
        {"seed": SEED, "duration_s": DURATION},
        command="python tools/benchmarks/warp_physics.py "
        "--measured measured.json",
    )
    head["libraries"] = found.pop("libraries")  # of the machine with the GPU
    write_result(arguments.output, head, **found)


if __name__ == "__main__":
    main()
