"""Verification of tables by closed forms and by simulated games."""

from collections.abc import Callable, Mapping
from itertools import count
from math import pi, tau
from typing import Any

import numpy as np

from ...core.poses import Array, arc, rotate, wrap_angles
from ..unicycle.unicycle_game import MOVE_ASIDE, MOVE_BACK
from .table import ValueTable
from .two_cars import CarGame, car_poses

HELD = 8  # decisions for which a random evader holds its turn

Evader = Callable[[Array], Array]
"""Velocities ahead, left [m/s] and turning [rad/s], by poses. Shape (n, 3)."""
Pursuer = Callable[[Array, Array], Array]
"""The same of the pursuer, by poses and velocities of the evader."""


def play(
    starts: Array,
    evader: Evader,
    pursuer: Pursuer,
    *,
    period: float,
    duration: float,
    parts: int = 8,
    faces: bool = False,
    reacts: bool = False,
) -> Array:
    """Simulate games along exact arcs; return closest approaches, in [m].

    Starts are poses of the evader in the frame of the pursuer, shape (n, 3).
    The evader commits to velocities for a period, in whose parts the distance
    is measured, and in which a pursuer that ``reacts`` decides. An evader that
    ``faces`` is turned away from the pursuer when it decides.
    """
    poses = np.array(starts, dtype=np.float64)
    least: Array = np.hypot(poses[:, 0], poses[:, 1])
    step = period / parts
    for n in range(round(duration / step)):
        if n % parts == 0:
            if faces:
                poses[:, 2] = np.arctan2(poses[:, 1], poses[:, 0])
            chosen = evader(poses)
            answer = pursuer(poses, chosen)
        elif reacts:
            answer = pursuer(poses, chosen)
        own, other = arc(*step * chosen.T), arc(*step * answer.T)
        x, y, theta = poses.T
        moved, turned = rotate(own[:, 0], own[:, 1], theta), other[:, 2]
        x, y = x + moved[0] - other[:, 0], y + moved[1] - other[:, 1]
        x, y = rotate(x, y, -turned)
        poses = np.column_stack([x, y, theta + own[:, 2] - turned])
        least = np.minimum(least, np.hypot(x, y))
    return least


def barrier_offsets(table: ValueTable, poses: Array, capture: float) -> Array:
    """Return how far the barrier of a table is from states, in [m].

    Offsets are those in the pursuer's plane, to first order; positive
    inside what can be captured by the table. The poses, shape (n, 3), are
    on the barrier of a capture distance in [m].
    """
    step = table.grid.spacing * np.eye(3)[:2]
    rises = [table.value(poses + d) - table.value(poses - d) for d in step]
    slope = np.hypot(*rises) / (2.0 * table.grid.spacing)
    off: Array = (capture - table.value(poses)) / np.maximum(slope, 1e-3)
    return off


def differences(coarse: ValueTable, fine: ValueTable) -> Array:
    """Return absolute differences at the nodes of a coarser table, in [m]."""
    x, y, theta = coarse.grid.axes()
    poses = np.stack(np.meshgrid(x, y, theta, indexing="ij"), axis=-1)
    errors: Array = np.abs(fine.value(poses) - coarse.values)
    return errors


def compare_evaders(
    game: CarGame, table: ValueTable, evaders: Mapping[str, Evader | None],
    starts: Array,
) -> list[dict[str, Any]]:  # fmt: skip
    """Simulate evaders from the same starts and compare them with a table.

    Games take the time of a turn at the slowest rate of the game. An
    evader gives velocities by poses; None stands for that of the table.

    Returns:
        For each: name, mean closest approach, its share of the mean value,
        mean of closest approach less value, 95th percentile of its
        magnitude, largest shortfall and largest excess, in [m].
    """
    expected, rows = table.value(starts), []
    period = game.period(table.grid.spacing)
    twists, reacts = game.evader_twists, game.pursuer_gain > 0.0

    def optimal(poses: Array) -> Array:
        chosen: Array = twists[table.best_motion(poses)]
        return chosen

    for name, evader in evaders.items():
        held = period if evader is None else period / 4.0

        def pursuer(poses: Array, _: Array, step: float = held / 8.0) -> Array:
            if reacts:
                return game.law(poses, step)
            turns: Array = game.pursuer_twists[table.decisions(poses)[:, 1]]
            return turns

        closest = play(
            starts,
            optimal if evader is None else evader,
            pursuer,
            period=held,
            duration=tau / game.rate,
            reacts=reacts,
        )
        off = closest - expected
        rows.append(
            {
                "name": name,
                "closest": float(closest.mean()),
                "over_bound": float(closest.mean() / expected.mean()),
                "mean_error": float(off.mean()),
                "most": float(np.quantile(np.abs(off), 0.95)),
                "below": float(max(-off.min(), 0.0)),
                "above": float(max(off.max(), 0.0)),
            }
        )
    return rows


def fixed_angle_evader(game: CarGame, angle: float) -> Evader:
    """Return the evader of eq. (4) with an angle and the side behind it.

    Its gain is the pursuer's, or reaches the limit at an error of pi.
    """
    gain = game.pursuer_gain or game.evader_turn / pi

    def steer(poses: Array) -> Array:
        psi = wrap_angles(np.arctan2(poses[:, 1], poses[:, 0]) - poses[:, 2])
        turn = gain * (psi + np.where(psi < 0.0, angle, -angle))
        return driven(game, turn)

    return steer


def reference_evaders(game: CarGame) -> dict[str, Evader | None]:
    """Return the optimal evader and others for comparison, by name."""
    random, limit = np.random.default_rng(0), game.evader_turn
    calls, turns = count(), list[Array]()

    def wander(poses: Array) -> Array:
        if next(calls) % HELD == 0:
            turns[:] = [random.choice([-limit, 0.0, limit], len(poses))]
        return driven(game, turns[0])

    return {
        "optimal": None,
        "move aside": fixed_angle_evader(game, MOVE_ASIDE),
        "move back": fixed_angle_evader(game, MOVE_BACK),
        "straight on": lambda poses: driven(game, np.zeros(len(poses))),
        "random": wander,
    }


def driven(game: CarGame, turn: Array) -> Array:
    """Return velocities of the evader with turning rates, within limits."""
    turn = np.clip(turn, -game.evader_turn, game.evader_turn)
    speed = np.full_like(turn, game.evader_speed)
    return np.column_stack([speed, 0.0 * turn, turn])


def draw_starts(near: float, far: float, count: int, seed: int = 0) -> Array:
    """Draw poses of any bearings, uniform in distance. Shape (count, 3)."""
    low, high = [near, -pi, -pi], [far, pi, pi]
    states = np.random.default_rng(seed).uniform(low, high, (count, 3))
    return car_poses(*states.T)
