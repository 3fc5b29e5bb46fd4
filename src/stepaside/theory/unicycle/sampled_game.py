"""Simulation of games with sampled, delayed steering.

Turning rates are held between samples, as for the humanoids, which replan
once per step (Sec. III-E) and walk along an arc in between (Sec. III-B).
Perception may be delayed. The arcs between samples have a closed form.
"""

from collections import deque
from dataclasses import dataclass
from math import ceil, floor

import numpy as np
from numpy.typing import NDArray

from ...core.brief_repr import brief_repr
from ...core.errors import check_not_negative, check_positive
from ...core.poses import Pose, arc
from .. import laws
from .relative_coordinates import RelativeStart
from .unicycle_game import Game

Array = NDArray[np.float64]
_PARTS = 16  # samples per arc for the closest approach


@dataclass(frozen=True, slots=True)
class SampledRun:
    """Simulated game with held turning rates.

    Attributes:
        times: Sampling times, in [s]. Shape (n + 1,).
        states: r [m], a, psi [rad] at those times. Shape (n + 1, 3).
        pursuer: Poses (x, y [m], theta [rad]) of the pursuer in its first
            frame.
            Shape (n + 1, 3).
        evader: Poses of the evader there. Shape (n + 1, 3).
        turning_rates: Rates of pursuer and evader decided at each sample,
            in [rad/s]. Shape (n, 2).
        sides: Side decided at each sample. Shape (n,).
        closest_distance: Closest approach over 16 samples of every arc, in
            [m].
        captured: Whether the distance fell to the capture distance.
    """

    __repr__ = brief_repr

    times: Array
    states: Array
    pursuer: Array
    evader: Array
    turning_rates: Array
    sides: NDArray[np.int64]
    closest_distance: float
    captured: bool


def choose_turning(
    game: Game, start: RelativeStart, side: int
) -> tuple[float, float, int]:
    """Return the turning rates of both players, in [rad/s], and the side.

    The side is 0 if none has been chosen.
    """
    _, a, psi = start.wrapped()
    if side == 0 or not game.keeps_side:
        side = laws.update_side(side, psi, game.hysteresis)
    error = laws.evasion_heading(psi, side, game.angle)
    turn = laws.saturated_rate if game.saturated else laws.proportional_rate
    aim = laws.pursuit_heading(a)
    return (
        laws.proportional_rate(aim, game.pursuer.gain),
        turn(error, game.evader.gain),
        side,
    )


def _drive(
    game: Game,
    pursuer: Pose,
    evader: Pose,
    turns: tuple[float, float],
    span: float,
) -> tuple[Pose, Pose, float]:
    """Move both players along arcs; also return the least distance [m]."""
    times = span * np.arange(1, _PARTS + 1) / _PARTS
    ends, ways = [], []
    for pose, speed, turn in (
        (pursuer, game.pursuer.speed, turns[0]),
        (evader, -game.evader.speed, turns[1]),
    ):
        along = arc(speed * times, 0.0, turn * times)
        ends.append(pose.compose(Pose(*along[-1].tolist())))
        ways.append(pose.transform_points(along[:, :2]))
    closest = float(np.hypot(*(ways[1] - ways[0]).T).min())
    return ends[0], ends[1], closest


def simulate_sampled(
    game: Game,
    start: RelativeStart,
    duration: float,
    sample_time: float,
    *,
    delay: float = 0.0,
    capture_distance: float = 1e-6,
) -> SampledRun:
    """Simulate one game with turning rates held between samples.

    Args:
        game: Parameters of the game.
        start: Initial relative coordinates.
        duration: Time after which the game ends, in [s].
        sample_time: Sampling period, in [s].
        delay: Age of a perception when it takes effect, in [s]. Before the
            first one does, both players drive straight.
        capture_distance: Distance at which the game ends, in [m].
    """
    check_positive(duration, "duration", "s")
    check_positive(sample_time, "sample_time", "s")
    check_not_negative(delay, "delay", "s")
    check_positive(capture_distance, "capture_distance", "m")
    (pursuer, evader), side = start.poses(), 0
    whole = floor(delay / sample_time + 1e-12)
    late = max(0.0, delay - whole * sample_time)
    count = ceil(duration / sample_time - 1e-9)
    whole = min(whole, count)  # longer delays outlast the game
    # Rates in effect before and after the change within a period.
    queue = deque([(0.0, 0.0)] * (whole + 1))
    poses_p, poses_e, states = [pursuer], [evader], [start.wrapped()]
    rates, sides = [], []
    closest, captured = start.distance, start.distance <= capture_distance
    for _ in range(count):
        if captured:
            break
        turn_p, turn_e, side = choose_turning(
            game, RelativeStart(*states[-1]), side
        )
        rates.append((turn_p, turn_e))
        queue.append(rates[-1])
        sides.append(side)
        old = queue.popleft()
        for turns, span in ((old, late), (queue[0], sample_time - late)):
            if span > 0.0:
                pursuer, evader, least = _drive(
                    game, pursuer, evader, turns, span
                )
                closest = min(closest, least)
        captured = closest <= capture_distance
        poses_p.append(pursuer)
        poses_e.append(evader)
        states.append(RelativeStart.from_world(pursuer, evader).wrapped())
    return SampledRun(
        sample_time * np.arange(len(states), dtype=np.float64),
        np.array(states),
        np.array(poses_p),
        np.array(poses_e),
        np.array(rates).reshape(-1, 2),
        np.array(sides, dtype=np.int64),
        closest,
        captured,
    )
