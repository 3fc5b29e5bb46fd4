"""Measure the errors of the odometry of served robots.

    python -m tools.checks.served_odometry

walks simulated robots with hardware-like bodies for 20 s at six velocities
and prints the errors that ``drivers/ros2_server.py`` rests on.
"""

from collections.abc import Callable
from math import hypot

import numpy as np

from stepaside.core.poses import Array, Pose
from stepaside.games.duel_settings import (
    PLAYERS,
    DuelSettings,
    StartSettings,
)
from stepaside.games.physics_world import RemoteControl
from stepaside.games.recorded_game import RecordedGame
from stepaside.games.velocity_walker import VelocityWalker
from stepaside.locomotion.zmp.control_settings import STABILISED
from stepaside.sim.body_settings import BODIES
from stepaside.strategies.velocity_set import BodyVelocity

DURATION, SEEDS = 20.0, range(1, 6)
COMMANDS = (
    (0.073, 0.0), (-0.073, 0.0), (0.073, 0.11), (-0.073, -0.11), (0.0, 0.15),
    (0.04, -0.11),
)  # fmt: skip


def walked(seed: int, first: int) -> list[Array]:
    """Walk two robots at two commands.

    Returns:
        Rows for each: odometry (x, y, heading), truth in odometry likewise,
        and commanded velocities. Shape (ticks, 8).
    """
    settings = DuelSettings(
        seed=seed,
        start=StartSettings(4.0, 3.14, 3.14),
        body=BODIES["hardware"],
        control=STABILISED,
    )
    remote = RemoteControl(balances=True, ideal_sight=True)
    world = RecordedGame(
        settings, remote=dict.fromkeys(PLAYERS, remote)
    ).in_physics
    robots = [p for p in world.players if isinstance(p, VelocityWalker)]
    rows: list[list[list[float]]] = [[] for _ in robots]
    for _ in range(round(DURATION / world.physics.tick)):
        for number, robot in enumerate(robots):
            forward, turn = COMMANDS[first + number]
            robot.command(BodyVelocity(forward, 0.0, turn))
            robot.tick()
            rows[number].append(compared(robot))
        world.step()
    return [np.array(each) for each in rows]


def compared(robot: VelocityWalker) -> list[float]:
    """Return odometry, truth and velocity of a robot now."""
    x, y = robot.truth.position_reference_in_world
    heading = robot.truth.heading_in_world
    truth = robot.frame.inverse().compose(Pose(x, y, heading))
    pose = robot.scheme.templates.at(robot.robot.world.time)
    return [*pose, *truth, *robot.scheme.velocity]


def rms(values: list[float]) -> float:
    """Return the root mean square."""
    return float(np.sqrt(np.mean(np.square(values))))


def errors(rows: Array) -> tuple[float, ...]:
    """Return path, turn, and errors of position, heading and velocities."""
    for column in (2, 5):
        rows[:, column] = np.unwrap(rows[:, column])
    x, y, heading, u, v, true = (rows[-1] - rows[0])[:6]
    samples = rows[::80, :2]  # about a gait cycle apart
    path = float(np.hypot(*np.diff(samples, axis=0).T).sum())
    speed = np.gradient(rows[:, 3:6], DURATION / len(rows), axis=0)
    c, s = np.cos(rows[:, 5]), np.sin(rows[:, 5])
    forward = c * speed[:, 0] + s * speed[:, 1] - rows[:, 6]
    lateral = c * speed[:, 1] - s * speed[:, 0]
    turning = speed[:, 2] - rows[:, 7]
    sizes = (rms(list(each)) for each in (forward, lateral, turning))
    return path, heading, hypot(u - x, v - y), true - heading, *sizes


def main() -> None:
    """Print the errors at each command, over all seeds."""
    print("forward  turn   path   turned  position  heading  v_x  v_y  w_z")
    print("[m/s]  [rad/s]  [m]    [rad]     [m]      [rad]    (rms)")
    report: Callable[[float], str] = "{:8.3f}".format
    for first in range(0, len(COMMANDS), 2):
        runs = [walked(seed, first) for seed in SEEDS]
        for number in range(2):
            found = [errors(run[number]) for run in runs]
            values = [rms([each[i] for each in found]) for i in range(7)]
            command = COMMANDS[first + number]
            print(*(report(value) for value in (*command, *values)))


if __name__ == "__main__":
    main()
