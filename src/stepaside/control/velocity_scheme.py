"""Control of a robot whose steps follow a velocity command."""

from math import pi
from typing import TYPE_CHECKING

from ..core.poses import Pose
from ..locomotion.locomotion import MotionRequest
from ..locomotion.maneuver_walk import ManeuverWalk, velocity_limits
from ..planning import Direction, Foot, GaitSettings
from ..strategies import Walk
from ..strategies.knowledge import STAND, Intent
from ..strategies.velocity_set import STILL, BodyVelocity
from .scheme import ControlScheme
from .sight_sources import MeasuredSight
from .strategy_runner import StrategyRunner

if TYPE_CHECKING:
    from ..locomotion.policy.policy_legs import PolicyWalk

SLOW = 1e-3  # speed [m/s] or turning rate [rad/s] that counts as zero
IN_PLACE = 1e-3  # speed factor of a turn on the spot


def limit_velocity(
    forward: float, turn: float, gait: GaitSettings
) -> tuple[float, float]:
    """Limit a driving velocity, in [m/s], and a turning rate, in [rad/s].

    Both are scaled alike to what a gait can walk, on the same path.
    """
    speed, rate = velocity_limits(gait)
    share = 1.0 / max(1.0, abs(forward) / speed, abs(turn) / rate)
    return share * forward, share * turn


def request_at_velocity(
    forward: float,
    turn: float,
    gait: GaitSettings,
    *,
    under_way: Direction | None,
) -> MotionRequest:
    """Return the request that walks at a velocity.

    A reversal of the direction under way halts the robot first.
    """
    forward, turn = limit_velocity(forward, turn, gait)
    speed, rate = velocity_limits(gait)
    direction = Direction.FORWARD if forward >= 0.0 else Direction.BACKWARD
    if abs(forward) < SLOW:
        direction = under_way or Direction.FORWARD
    rests = abs(forward) < SLOW and abs(turn) < SLOW
    if rests or under_way not in (None, direction):
        return MotionRequest(STAND, direction, saturated=False)
    share = max(IN_PLACE, min(1.0, abs(forward) / speed))
    return MotionRequest(
        Intent(pi * turn / rate, share), direction, saturated=False
    )


class VelocityScheme(ControlScheme):
    """Control of one robot whose steps follow a velocity command.

    Learned legs follow the command itself, also sideways.
    """

    def __init__(self, locomotion: "ManeuverWalk | PolicyWalk") -> None:
        """Begin standing."""
        decisions = StrategyRunner(Walk(0.0), locomotion.gait)
        super().__init__(decisions, locomotion, MeasuredSight())
        decisions.headings.note(0.0, locomotion.torso_heading)
        self._commanded = STILL
        self._under_way: Direction | None = None

    @property
    def velocity(self) -> BodyVelocity:
        """Velocity that it follows."""
        forward, _, turn = self._commanded
        if self.locomotion.maneuvers is None:
            return self.locomotion.velocities.nearest(self._commanded)
        forward, turn = limit_velocity(forward, turn, self.locomotion.gait)
        return BodyVelocity(forward, 0.0, turn)

    def command(self, velocity: BodyVelocity) -> None:
        """Walk at a velocity from the next tick on."""
        self._commanded = velocity

    def starts(self, now: float) -> bool:
        """Return whether a standing robot starts; see `.IntentSource`."""
        self._under_way = None
        return self._request().intent.walks

    def decide(
        self, now: float, support: Pose, side: Foot, *, moving: bool
    ) -> MotionRequest:
        """Return the step that follows the command; see `.IntentSource`."""
        request = self._request()
        if request.intent.walks:
            self._under_way = request.direction
        return request

    def _request(self) -> MotionRequest:
        velocity = self.velocity
        if self.locomotion.maneuvers is None:
            walks = velocity != STILL
            intent = Intent(velocity=velocity) if walks else STAND
            return MotionRequest(intent, Direction.FORWARD, saturated=False)
        return request_at_velocity(
            velocity.forward,
            velocity.turn,
            self.locomotion.gait,
            under_way=self._under_way,
        )
