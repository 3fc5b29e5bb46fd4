"""Time duels on learned legs beside the bare physics of the same motion.

Duels are played one at a time and side by side, then their commands are given
to ``mj_step`` alone in the same process; all end in the same states. Processor
time of each control tick, least of some rounds, so that other processes
disturb little::

    python tools/benchmarks/policy_duel_cost.py runs/g1 runs/policy.onnx
"""

from argparse import Namespace
from collections.abc import Sequence
from dataclasses import replace
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


class TickRecorder:
    """Match observer that records commands and processor times.

    Attributes:
        commands: Actuator commands of each tick.
        times: Processor time at the begin of each tick, in [s].
    """

    def __init__(self) -> None:
        """Begin without commands."""
        self.commands: list[Array] = []
        self.times: list[float] = []

    def before(self, match: Match) -> None:
        """Note the time."""
        self.times.append(thread_time())

    def acted(self, match: Match) -> None:
        """Copy the commands."""
        self.commands.append(match.world.data.ctrl.copy())

    def ended(self, match: Match, outcome: Outcome) -> None:
        """Note the time."""
        self.times.append(thread_time())


def play_bare(
    duel: Duel, data: mujoco.MjData, commands: list[Array]
) -> list[float]:
    """Give recorded commands to the physics alone; return times, in [s]."""
    model, steps = duel.world.model, duel.world.physics.steps_per_tick
    times = []
    for command in commands:
        times.append(thread_time())
        data.ctrl[:] = command
        mujoco.mj_step(model, data, nstep=steps)
    return [*times, thread_time()]


def measure_round(
    games: Sequence[DuelSettings], duration: float
) -> tuple[Array, Array, Array, bool]:
    """Return times one at a time, side by side and bare; whether all agree.

    Times are those of the processor for each tick, in [s].
    """
    clocks = [TickRecorder() for _ in games]
    alone = [
        Duel(game, (clock,)) for game, clock in zip(games, clocks, strict=True)
    ]
    for duel in alone:
        play_together([duel], [duration])
    one = np.diff([clock.times for clock in clocks])
    pool = NetworkPool()
    recorders = [TickRecorder() for _ in games]
    duels = [
        Duel(game, (recorder,), networks=pool)
        for game, recorder in zip(games, recorders, strict=True)
    ]
    states = []
    for duel in duels:
        states.append(mujoco.MjData(duel.world.model))
        mujoco.mj_copyData(states[-1], duel.world.model, duel.world.data)
    play_together(duels, [duration] * len(duels))
    together = np.diff(recorders[0].times)
    commands = [recorder.commands for recorder in recorders]
    bare = np.diff(
        [
            play_bare(*each)
            for each in zip(duels, states, commands, strict=True)
        ]
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
    parser.add_argument("--duels", type=int, default=8)
    parser.add_argument("--duration", type=float, default=10.0)
    parser.add_argument("--rounds", type=int, default=5)
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
    one, together, bare = (
        float(np.min(times, axis=0).sum())
        for times in list(zip(*rounds, strict=True))[:3]
    )
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
