"""Signals of a robot that only close records have."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from ..control.scheme import ControlScheme
from ..core.entries import to_entries
from ..core.poses import Pose
from ..locomotion.locomotion import Phase
from ..locomotion.maneuver_walk import ManeuverWalk
from ..planning import Foot
from ..sim.simulated_robot import SimulatedRobot


def close_samples(
    robot: SimulatedRobot, scheme: ControlScheme, frame: Pose
) -> dict[str, Any]:
    """Return the signals of a robot at this instant, by name.

    The frame is that of its odometry in the world.
    """
    stance, walk = robot.stance, scheme.locomotion.maneuvers
    found = robot.signals(scheme.joint_targets) | {
        "velocity": stance.velocity,
        "tilt": stance.tilt,
        "phase": (list(Phase).index(scheme.phase),),
    }
    return found if walk is None else found | _walk(robot, walk, frame)


def _walk(
    robot: SimulatedRobot, walk: ManeuverWalk, frame: Pose
) -> dict[str, Any]:
    """Return foot states, references and estimates in the world."""
    stance, state = robot.stance, walk.balance.state
    step = walk.step(robot.world.time)
    foot = step.swing.other
    estimate: tuple[float, ...] = (np.nan,) * 8
    if state is not None:
        turned = Pose(0.0, 0.0, frame.theta)
        estimate = (
            *frame.compose(Pose(*state.com, 0.0))[:2],
            *turned.compose(Pose(*state.velocity, 0.0))[:2],
            *frame.compose(Pose(*state.zmp, 0.0))[:2],
            *state.tilt,
        )
    (x, y, _), (u, v) = robot.truth.position_com_in_world, stance.velocity
    eta = walk.gait.eta
    single = step.walking and step.remaining > 0.0
    return {
        "sole": stance.left_sole if foot is Foot.LEFT else stance.right_sole,
        "support": (foot.value, single, *frame.compose(step.support)),
        "heading_reference": (walk.balance.planned_heading + frame.theta,),
        "estimate": estimate,
        "dcm": (x + u / eta, y + v / eta),
    }


def strategy_numbers(scheme: ControlScheme) -> Iterator[tuple[str, float]]:
    """Yield name and value of the numbers of a strategy."""
    walk = scheme.locomotion.maneuvers
    sighting, memory = scheme.sighting, scheme.decisions.memory
    if sighting is not None:
        yield "sighting_bearing_rad", sighting.bearing
        yield "sighting_distance_m", sighting.distance
    if walk is not None and walk.plan is not None:
        yield "desired_heading_rad", walk.plan.bearing
    entries = to_entries(memory)
    for name, value in entries.items() if isinstance(entries, dict) else ():
        if isinstance(value, bool | int | float):
            yield f"memory_{name}", float(value)
