"""Time duels on learned legs beside the bare physics of the same motion.

Duels are played one at a time and side by side, then their commands are given
to ``mj_step`` alone in the same process; all end in the same states. Processor
time, least of some rounds::

    python tools/benchmarks/policy_duel_cost.py runs/g1 runs/policy.onnx
"""

from argparse import Namespace
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from time import thread_time

import mujoco
import numpy as np
from benchmark_options import ask, machine

from stepaside.core.poses import Array
from stepaside.games.duel import Duel
from stepaside.games.duel_settings import DuelSettings
from stepaside.games.match import Match, play_together
from stepaside.games.outcome import Outcome
from stepaside.games.robot_settings import with_legs, with_robot
from stepaside.locomotion.policy.network_pool import NetworkPool
from stepaside.studies.result_files import header, write_result


class CommandRecorder:
    """Match observer that records the actuator commands of each tick."""

    def __init__(self) -> None:
        """Begin without commands."""
        self.commands: list[Array] = []

    def before(self, match: Match) -> None:
        """Do nothing."""

    def acted(self, match: Match) -> None:
        """Copy the commands."""
        self.commands.append(match.world.data.ctrl.copy())

    def ended(self, match: Match, outcome: Outcome) -> None:
        """Do nothing."""


def time_of(task: Callable[[], object]) -> float:
    """Return the processor time of a task, in [s]."""
    began = thread_time()
    task()
    return thread_time() - began


def play_bare(duel: Duel, data: mujoco.MjData, commands: list[Array]) -> None:
    """Give recorded commands to the physics alone."""
    model, steps = duel.world.model, duel.world.physics.steps_per_tick
    for command in commands:
        data.ctrl[:] = command
        mujoco.mj_step(model, data, nstep=steps)


def measure_round(
    games: Sequence[DuelSettings], duration: float
) -> tuple[float, float, float, bool]:
    """Return times one at a time, side by side and bare; whether all agree."""
    alone = [Duel(game) for game in games]
    one = sum(
        time_of(partial(play_together, [duel], [duration])) for duel in alone
    )
    pool = NetworkPool()
    recorders = [CommandRecorder() for _ in games]
    duels = [
        Duel(game, (recorder,), networks=pool)
        for game, recorder in zip(games, recorders, strict=True)
    ]
    states = []
    for duel in duels:
        states.append(mujoco.MjData(duel.world.model))
        mujoco.mj_copyData(states[-1], duel.world.model, duel.world.data)
    together = time_of(partial(play_together, duels, [duration] * len(duels)))
    bare = sum(
        time_of(partial(play_bare, *each))
        for each in zip(
            duels, states, [r.commands for r in recorders], strict=True
        )
    )
    equal = all(
        np.array_equal(single.world.data.qpos, duel.world.data.qpos)
        and np.array_equal(data.qpos, duel.world.data.qpos)
        for single, duel, data in zip(alone, duels, states, strict=True)
    )
    return one, together, bare, equal


def main() -> None:
    """Measure, write and print the results."""

    def name_of(given: Namespace) -> str:
        return f"policy-duel-cost-{given.network.stem}.json"

    parser = ask(__doc__, name_of)
    parser.add_argument("robot", type=Path)
    parser.add_argument("network", type=Path)
    parser.add_argument("--duels", type=int, default=16)
    parser.add_argument("--duration", type=float, default=10.0)
    parser.add_argument("--rounds", type=int, default=3)
    asked = parser.parse_args()
    settings = with_robot(DuelSettings(), str(asked.robot))
    settings = with_legs(settings, str(asked.network))
    games = [
        replace(settings, duration=asked.duration, seed=seed)
        for seed in range(1, asked.duels + 1)
    ]
    rounds = [
        measure_round(games, asked.duration) for _ in range(asked.rounds)
    ]
    one, together, bare, _ = np.min(rounds, axis=0).tolist()
    played = asked.duels * asked.duration
    figures = {
        "one_at_a_time_s_per_s": played / one,
        "side_by_side_s_per_s": played / together,
        "bare_s_per_s": played / bare,
        "one_at_a_time_over_bare": one / bare,
        "side_by_side_over_bare": together / bare,
        "equal": all(equal for *_, equal in rounds),
    }
    head = header(
        {
            "duels": asked.duels,
            "duration_s": asked.duration,
            "rounds": asked.rounds,
        }
    )
    write_result(asked.output, head, machine=machine(), figures=figures)
    for name, value in figures.items():
        print(f"{name}: {value:.3g}")


if __name__ == "__main__":
    main()
