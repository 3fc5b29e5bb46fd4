"""Time duels on learned legs beside the bare physics of the same motion.

Duels are played one at a time and side by side, then their commands are given
to ``mj_step`` alone in the same process, one duel after the other and tick by
tick; all end in the same states. Times are those of the processor for each
control tick, the least of some rounds, so that other processes disturb
little::

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
    duels: Sequence[Duel], commands: Sequence[Sequence[Array]]
) -> tuple[Array, list[mujoco.MjData]]:
    """Give recorded commands to the physics alone, tick by tick.

    Args:
        duels: Duels at their begin, which are not changed.
        commands: Actuator commands of each tick of each duel.

    Returns:
        Processor time of each tick of all duels, in [s], and final states.
    """
    states = [mujoco.MjData(duel.world.model) for duel in duels]
    for duel, data in zip(duels, states, strict=True):
        mujoco.mj_copyData(data, duel.world.model, duel.world.data)
    worlds = [
        (duel.world.model, data, duel.world.physics.steps_per_tick)
        for duel, data in zip(duels, states, strict=True)
    ]
    times = []
    for row in zip(*commands, strict=True):
        times.append(thread_time())
        for (model, data, steps), command in zip(worlds, row, strict=True):
            data.ctrl[:] = command
            mujoco.mj_step(model, data, nstep=steps)
    return np.diff([*times, thread_time()]), states


def measure_round(
    games: Sequence[DuelSettings], duration: float
) -> tuple[Array, Array, Array, Array, bool]:
    """Return times of duels and of bare physics; whether all agree.

    Times are those of the processor for each tick, in [s]: of duels one at a
    time and side by side, then of the bare physics likewise.
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
    fresh = [Duel(game) for game in games]
    play_together(duels, [duration] * len(duels))
    together = np.diff(recorders[0].times)
    commands = [recorder.commands for recorder in recorders]
    bare = [
        play_bare([duel], [rows])
        for duel, rows in zip(fresh, commands, strict=True)
    ]
    bare_together, states = play_bare(fresh, commands)
    equal = all(
        np.array_equal(single.world.data.qpos, duel.world.data.qpos)
        and np.array_equal(data.qpos, duel.world.data.qpos)
        for single, duel, data in zip(alone, duels, states, strict=True)
    )
    times = np.array([times for times, _ in bare])
    return one, together, times, bare_together, equal


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
    one, together, bare, bare_together = (
        float(np.min(times, axis=0).sum())
        for times in list(zip(*rounds, strict=True))[:4]
    )
    played = asked.duels * asked.duration
    figures = {
        "one_at_a_time_s_per_s": played / one,
        "side_by_side_s_per_s": played / together,
        "bare_s_per_s": played / bare,
        "bare_side_by_side_s_per_s": played / bare_together,
        "one_at_a_time_over_bare": one / bare,
        "side_by_side_over_bare": together / bare_together,
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
