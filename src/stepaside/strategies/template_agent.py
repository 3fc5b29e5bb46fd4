"""Template of a player that knows all other players exactly."""

from collections.abc import Mapping
from math import atan2, cos, hypot, sin
from typing import NamedTuple

from ..arena import NO_OBSTACLES, ObstacleSet
from ..core.errors import StrategyError
from ..core.player_identity import PlayerIdentity
from ..core.poses import Pose, wrap_angle
from .decision_maker import DecisionMaker
from .knowledge import Intent, Knowledge, Limits, OtherPlayer
from .opponent_choice import choose_opponent
from .strategy import Strategy


class PlayerState(NamedTuple):
    """State of a player on the floor.

    Attributes:
        pose: Pose in the world.
        velocity: Velocity in the world, in [m/s].
    """

    pose: Pose
    velocity: tuple[float, float] = (0.0, 0.0)


class TemplateAgent(DecisionMaker):
    """Strategy of a template that knows the states of all others.

    Attributes:
        identity: Own identity.
    """

    identity: PlayerIdentity

    def __init__(
        self,
        strategy: Strategy,
        limits: Limits,
        identity: PlayerIdentity,
        *,
        target: str = "",
        obstacles: ObstacleSet = NO_OBSTACLES,
    ) -> None:
        """Begin without knowledge.

        Args:
            strategy: Strategy of the player.
            limits: Limits of its gait.
            identity: Its identity.
            target: Name of its target; empty for the nearest opponent.
            obstacles: Known obstacles, in the world.
        """
        super().__init__(strategy, limits)
        self.identity = identity
        self._target, self._obstacles = target, obstacles
        self._present = ""

    def decide(
        self,
        time: float,
        own: PlayerState,
        others: Mapping[PlayerIdentity, PlayerState],
        *,
        moving: bool,
    ) -> Intent | None:
        """Decide and store the memory; None if there is no other player.

        Args:
            time: Present time, in [s].
            own: Own state.
            others: States of all other players.
            moving: Whether the player is walking.

        Raises:
            StrategyError: If the strategy returns no intent.
        """
        known = tuple(
            _seen(identity, own.pose, state)
            for identity, state in others.items()
        )
        self._present = choose_opponent(
            self.identity,
            {other.identity: other.distance for other in known},
            target=self._target,
            present=self._present,
        )
        opponent = next(
            (o for o in known if o.identity.name == self._present), None
        )
        if opponent is None:
            return None
        knowledge = self._knowledge(time, own, opponent, known, moving)
        try:
            return self.evaluate(knowledge)
        except StrategyError as error:
            name = type(self.strategy).__name__
            raise StrategyError(f"strategy {name}: {error}") from error

    def _knowledge(
        self,
        time: float,
        own: PlayerState,
        opponent: OtherPlayer,
        others: tuple[OtherPlayer, ...],
        moving: bool,
    ) -> Knowledge:
        """Return the knowledge of a decision, in the frame of the pose."""
        theta = own.pose.theta
        u, v = own.velocity
        assert opponent.velocity is not None
        du = opponent.velocity[0] - (u * cos(theta) + v * sin(theta))
        dv = opponent.velocity[1] - (v * cos(theta) - u * sin(theta))
        x, y = opponent.position
        away = max(opponent.distance, 1e-9)
        return Knowledge(
            time,
            opponent.bearing,
            opponent.distance,
            self.limits,
            bearing_rate=(x * dv - y * du) / away**2,
            closing_speed=-(x * du + y * dv) / away,
            pose_in_map=own.pose,
            moving=moving,
            obstacles_in_map=self._obstacles,
            velocity=opponent.velocity,
            identity=self.identity,
            others=others,
        )


def _seen(
    identity: PlayerIdentity, pose: Pose, state: PlayerState
) -> OtherPlayer:
    """Return what is known of a player at a pose."""
    dx, dy = state.pose.x - pose.x, state.pose.y - pose.y
    c, s = cos(pose.theta), sin(pose.theta)
    u, v = state.velocity
    return OtherPlayer(
        identity,
        wrap_angle(atan2(dy, dx) - pose.theta),
        hypot(dx, dy),
        (u * c + v * s, v * c - u * s),
    )
