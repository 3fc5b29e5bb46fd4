"""Time a whole duel against the bare physics of the same motion.

Measured twice: with the leg kinematics in Python, as on a robot, and as
machine code, as in long games and campaigns.
"""

from time import process_time

import mujoco
import numpy as np

from stepaside.games.duel import Duel
from stepaside.games.duel_settings import DuelSettings
from stepaside.robots.jit import JitPreference, prefer

OURS = ("real_time_factor", "duel_over_bare_physics", "control_tick_us")


def measure_duel(duration: float = 60.0) -> dict[str, float]:
    """Return the times of a duel in Python and as machine code."""
    plain = _measure_duel(duration)
    prefer(JitPreference.COMPILED)
    swift = _measure_duel(duration)
    return plain | {f"{name}_machine_code": swift[name] for name in OURS}


def _measure_duel(duration: float) -> dict[str, float]:
    """Return real-time factor, ratio to mj_step, and control tick.

    The bare run repeats the commands of the duel tick by tick from the same
    initial state, so that model, motion and contacts are the same.
    """
    settings = DuelSettings(seed=1, duration=duration)
    duel = Duel(settings)
    data, model = duel.world.data, duel.world.model
    bare = mujoco.MjData(model)
    mujoco.mj_copyData(bare, model, data)
    ticks = round(duration / settings.physics.tick)
    commands = np.empty((ticks, model.nu))
    start = process_time()
    for tick in range(ticks):
        if duel.tick() is not None:
            raise SystemExit("the duel ended early")
        commands[tick] = data.ctrl
    whole = process_time() - start
    start = process_time()
    for command in commands:
        bare.ctrl[:] = command
        mujoco.mj_step(model, bare, nstep=settings.physics.steps_per_tick)
    physics = process_time() - start
    if not np.array_equal(bare.qpos, data.qpos):
        raise SystemExit("the bare run went another way")
    return {
        "duel_s": duration,
        "real_time_factor": duration / whole,
        "bare_physics_real_time_factor": duration / physics,
        "duel_over_bare_physics": whole / physics,
        "control_tick_us": 1e6 * _control_tick(settings),
    }


def _control_tick(settings: DuelSettings) -> float:
    """Return the time to read, plan, move and write for one robot, in [s]."""
    duel = Duel(settings)
    spent, count = 0.0, 0
    for _ in range(5000):
        start = process_time()
        for player in duel.players:
            player.tick()
        spent += process_time() - start
        count += 2
        duel.world.step()
    return spent / count
