"""Compare the social forces of people with those of PySocialForce.

It draws scenes of people at random and compares the accelerations. The force
in groups is left out: that of PySocialForce, after pedsim_ros, takes every
member for one in the middle of its group. Needs
the PyPI package PySocialForce 1.1.2 in an environment with numba and scipy::

    python tools/checks/social_force.py
"""

import logging

import numpy as np
import pysocialforce
from pysocialforce import forces

from stepaside.sim.crowd_motion import (
    desired_force,
    obstacle_force,
    social_force,
)

SCENES, PEOPLE = 200, 5
OTHERS_HALF_TURN = np.pi  # beyond it PySocialForce does not wrap an angle


def compare(generator: np.random.Generator) -> tuple[dict[str, float], int]:
    """Return the largest differences in one scene, in [m/s^2].

    Returns:
        Difference by force, and the number of pairs left out because
        PySocialForce does not wrap the angle between two directions.
    """
    state = np.zeros((PEOPLE, 6))
    state[:, :2] = generator.uniform(-3.0, 3.0, (PEOPLE, 2))
    state[:, 2:4] = generator.uniform(-1.4, 1.4, (PEOPLE, 2))
    state[:, 4:6] = generator.uniform(-6.0, 6.0, (PEOPLE, 2))
    unwrapped = 0
    worst = {"social": 0.0, "desired": 0.0, "obstacle": 0.0}
    for i in range(PEOPLE):
        for j in range(PEOPLE):
            if i == j:
                continue
            pair = pysocialforce.Simulator(state[[i, j]])
            model = forces.SocialForce()
            model.init(pair, pair.config)
            other = model.get_force()[0]
            offset = state[i, :2] - state[j, :2]
            relative = state[i, 2:4] - state[j, 2:4]
            own = social_force(tuple(offset), tuple(relative), 0.0)
            along = offset / np.hypot(*offset) - 2.0 * relative
            angle = np.arctan2(*along[::-1]) - np.arctan2(*offset[::-1])
            if abs(angle) > OTHERS_HALF_TURN:
                unwrapped += 1
                continue
            gap = np.abs(np.array(own) - other).max()
            worst["social"] = max(worst["social"], float(gap))
    scene = pysocialforce.Simulator(state)
    model = forces.DesiredForce()
    model.init(scene, scene.config)
    desired = model.get_force()
    for i in range(PEOPLE):
        place, goal = state[i, :2], state[i, 4:6]
        speed = float(scene.peds.max_speeds[i])
        own = desired_force(
            tuple(goal - place), tuple(state[i, 2:4]), speed, 0.1
        )
        gap = np.abs(np.array(own) - desired[i]).max()
        worst["desired"] = max(worst["desired"], float(gap))
    for i in range(PEOPLE):
        walled = pysocialforce.Simulator(state[[i]], obstacles=[])
        radius = walled.peds.agent_radius
        away = generator.uniform(0.05, 0.39)  # where it acts there
        angle = generator.uniform(-np.pi, np.pi)
        outward = np.array([np.cos(angle), np.sin(angle)])
        model = forces.ObstacleForce()
        model.init(walled, walled.config)
        point = state[i, :2] - (away + radius) * outward
        walled.get_obstacles = lambda point=point: [point[None]]
        own = obstacle_force(tuple(outward), float(away))
        gap = np.abs(np.array(own) - model.get_force()[0]).max()
        worst["obstacle"] = max(worst["obstacle"], float(gap))
    return worst, unwrapped


def main() -> None:
    """Compare scenes and print the largest differences."""
    logging.disable(logging.CRITICAL)
    generator = np.random.default_rng(1)
    found = [compare(generator) for _ in range(SCENES)]
    for name in found[0][0]:
        most = max(worst[name] for worst, _ in found)
        print(f"{name}: largest difference {most:.2g} m/s^2")
    left_out = sum(number for _, number in found)
    print(f"pairs without a wrapped angle, left out: {left_out}")


if __name__ == "__main__":
    main()
