"""Time whole duels against the bare physics of the same motion.

Bare physics repeats the commands of a duel tick by tick from the same initial
state. It is measured twice: with everything that the models contain, as a
program around ``mj_step`` would, and as duels run it, without geoms that only
serve images and with sensors computed once per control tick.
"""

from collections.abc import Sequence
from time import process_time

import mujoco
import numpy as np

from stepaside.core.errors import ConfigurationError
from stepaside.core.poses import Array
from stepaside.games.game_settings import GameSettings
from stepaside.games.game_settings import duel as make_duel
from stepaside.games.recorded_game import RecordedGame
from stepaside.locomotion.control_settings import STABILISED
from stepaside.sim.body_settings import BODIES

CAMERA_DUEL = 5.0  # simulated time of a duel with cameras, in [s]


def measure_duel(duration: float = 60.0, rounds: int = 3) -> dict[str, float]:
    """Return the times of duels with ideal and hardware-like bodies.

    Args:
        duration: Simulated time, in [s].
        rounds: Interleaved repetitions, of which the fastest counts.
    """
    figures = _measure_duel(duration, rounds)
    hardware = make_duel(
        seed=1, body=BODIES["hardware"], control=STABILISED, duration=duration
    )
    spent = min(
        _play(RecordedGame(hardware), duration)[0] for _ in range(rounds)
    )
    return figures | {"hardware_real_time_factor": duration / spent}


def measure_camera_duel() -> dict[str, float]:
    """Return the speed of a duel with cameras; nothing without OpenCV."""
    settings = make_duel(seed=1, senses="cameras", duration=CAMERA_DUEL)
    try:
        duel = RecordedGame(settings)
    except ConfigurationError:
        return {}
    spent, _ = _play(duel, CAMERA_DUEL)
    duel.world.close()
    return {"camera_duel_real_time_factor": CAMERA_DUEL / spent}


def _measure_duel(duration: float, rounds: int) -> dict[str, float]:
    """Return real-time factors, ratios to mj_step, and control tick."""
    settings = make_duel(seed=1, duration=duration)
    best = {name: np.inf for name in ("duel", "bare", "stepped", "control")}
    for _ in range(rounds):
        duel = RecordedGame(settings)
        spent, commands = _play(duel, duration)
        times = {"duel": spent, "control": _control_time(settings)}
        for name, rendered in (("bare", True), ("stepped", False)):
            world = RecordedGame(
                settings, recorded=False, rendered=rendered
            ).in_physics
            model, data = world.model, world.data
            start = process_time()
            for command in commands:
                data.ctrl[:] = command
                if rendered:
                    own = settings.physics
                    steps = round(own.tick / own.time_step)
                    mujoco.mj_step(model, data, nstep=steps)
                else:
                    world.step()
            times[name] = process_time() - start
            if not np.array_equal(data.qpos, duel.in_physics.data.qpos):
                raise SystemExit("the bare run took another way")
        best = {name: min(best[name], times[name]) for name in best}
    return {
        "duel_s": duration,
        "real_time_factor": duration / best["duel"],
        "bare_physics_real_time_factor": duration / best["bare"],
        "duel_over_bare_physics": best["duel"] / best["bare"],
        "physics_over_bare_physics": best["stepped"] / best["bare"],
        "duel_over_physics": best["duel"] / best["stepped"],
        "control_tick_us": 1e6 * best["control"],
    }


def _play(
    duel: RecordedGame, duration: float
) -> tuple[float, Sequence[Array]]:
    """Return the processor time of a duel, in [s], and all its commands."""
    data, commands = duel.in_physics.data, []
    ticks = round(duration / duel.in_physics.physics.tick)
    start = process_time()
    for _ in range(ticks):
        if duel.ended is not None:  # by its last tick it may have
            raise SystemExit("the duel ended early")
        duel.tick()
        commands.append(data.ctrl.copy())
    return process_time() - start, commands


def _control_time(settings: GameSettings) -> float:
    """Return the mean time to read, plan, move and write of a robot, in [s].

    Plans are included: it is an average over ticks, most of which only follow
    a plan.
    """
    duel = RecordedGame(settings)
    spent, count = 0.0, 0
    for _ in range(5000):
        start = process_time()
        for player in duel.in_physics.players:
            player.tick()
        spent += process_time() - start
        count += 2
        duel.in_physics.step()
    return spent / count
