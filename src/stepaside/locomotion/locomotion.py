"""Interface between a controller that decides and one that walks."""

from typing import NamedTuple, Protocol

from ..core.poses import Pose
from ..planning import Direction, Foot, GaitSettings
from ..strategies.knowledge import Intent
from ..strategies.velocity_set import STILL, BodyVelocity
from ..theory import laws


class MotionRequest(NamedTuple):
    """Decision of a player, for its locomotion.

    Attributes:
        intent: Desired heading and speed, in the frame of the decision, or
            velocity, in that of the body.
        direction: Whether the body drives forward or backward.
        saturated: Whether it turns by (6) instead of (8).
    """

    intent: Intent
    direction: Direction
    saturated: bool


def template_velocity(
    request: MotionRequest, gait: GaitSettings
) -> BodyVelocity:
    """Return the desired velocity of the template.

    It is the desired body velocity, or that of the template unicycle, (3)
    and (8), or (6) if saturated.

    Args:
        request: Decision of the player.
        gait: Speed and steering gain of the template.
    """
    intent = request.intent
    if not intent.walks:
        return STILL
    if intent.velocity is not None:
        return intent.velocity
    speed = request.direction.value * gait.speed * intent.speed_factor
    law = laws.saturated_rate if request.saturated else laws.proportional_rate
    return BodyVelocity(
        speed * intent.pace, 0.0, law(intent.heading, gait.gain) * intent.pace
    )


class IntentSource(Protocol):
    """Decisions of a player, evaluated when its locomotion can use one."""

    def starts(self, now: float) -> bool:
        """Return whether a standing robot starts to walk.

        Args:
            now: Time of the decision, in [s].
        """

    def decide(
        self, now: float, support: Pose, side: Foot, *, moving: bool
    ) -> MotionRequest | None:
        """Decide on the next step.

        Args:
            now: Time at which the step begins, in [s].
            support: Pose of its support foot in odometry: the frame of the
                intent.
            side: Side of the support foot.
            moving: Whether the robot is walking.

        Returns:
            The decision; None if the opponent is lost: the robot halts.
        """
