"""Execution of a strategy in a template game, with its memory."""

from math import cos, sin
from typing import Any

from ..arena import Obstacle
from ..core.errors import StrategyError
from ..core.poses import Pose
from .foreign_code import ask
from .knowledge import Intent, Knowledge, Limits
from .opponent_rates import FloorVelocity, SightRates
from .strategy import Strategy


class TemplatePlayer:
    """Player of a template game.

    Attributes:
        strategy: Strategy of the player.
    """

    def __init__(
        self,
        strategy: Strategy,
        limits: Limits,
        period: float,
        solids: tuple[Obstacle, ...] = (),
        *,
        sees_velocity: bool = False,
    ) -> None:
        """Begin with nothing seen.

        Args:
            strategy: How it plays.
            limits: What its gait can do.
            period: Between two decisions, in [s].
            solids: What it knows of in the room.
            sees_velocity: Whether it is told how the other moves.
        """
        self.strategy = strategy
        self._memory: Any = strategy.begin()
        self._limits, self._solids = limits, solids
        self._rates = SightRates(period)
        self._drift = FloorVelocity(period) if sees_velocity else None
        self._moving = False

    def decide(
        self, time: float, pose: Pose, bearing: float, distance: float
    ) -> Intent:
        """Ask the strategy.

        Args:
            time: Now, in [s].
            pose: Own pose.
            bearing: Of the other, in [rad].
            distance: To the other, in [m].

        Raises:
            StrategyError: If the strategy gives no intent.
        """
        rates = self._rates.note(time, pose.theta + bearing, distance)
        known = Knowledge(
            time,
            bearing,
            distance,
            self._limits,
            rates.bearing_rate,
            rates.closing_speed,
            0.0,
            pose,
            self._moving,
            self._solids,
            velocity=self._velocity(time, pose, bearing, distance),
        )
        try:
            intent, self._memory = ask(self.strategy, known, self._memory)
        except StrategyError as error:
            name = type(self.strategy).__name__
            raise StrategyError(f"strategy {name}: {error}") from error
        self._moving = intent.walks
        return intent

    def _velocity(
        self, time: float, pose: Pose, bearing: float, distance: float
    ) -> tuple[float, float] | None:
        """Of the other, in the own frame, in [m/s]."""
        if self._drift is None:
            return None
        there = pose.compose(
            Pose(distance * cos(bearing), distance * sin(bearing), 0.0)
        )
        drift = self._drift.note(time, there.x, there.y)
        if drift is None:
            return None
        vx, vy, _ = Pose(0.0, 0.0, -pose.theta).compose(Pose(*drift, 0.0))
        return vx, vy
