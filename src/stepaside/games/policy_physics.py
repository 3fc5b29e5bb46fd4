"""Physics of robots that all walk on learned legs."""

from collections.abc import Sequence
from dataclasses import replace

from ..locomotion.control_settings import LegsSettings
from ..locomotion.policy.policy_legs import load_policy
from ..robots.description import RobotDescription
from ..sim.body_settings import BodySettings
from ..sim.physics_settings import PhysicsSettings


def policy_physics(
    physics: PhysicsSettings,
    body: BodySettings,
    legs: Sequence[tuple[LegsSettings, RobotDescription]],
) -> PhysicsSettings:
    """Return physics settings whose tick is the period of the policies.

    With an ideal body nothing happens between two evaluations of a policy:
    the actuators apply its gains at every time step. One with delays or
    sensor errors keeps its tick.
    """
    if body.has_sensor_errors or not body.has_ideal_servos:
        return physics
    periods = {load_policy(*own)[0].period for own in legs}
    steps = min(periods) / physics.time_step
    if len(periods) > 1 or steps < 0.5 or abs(steps - round(steps)) > 1e-6:
        return physics
    return replace(physics, tick=round(steps) * physics.time_step)
