"""Velocity control by the paper's template, a unicycle."""

from ...control.strategy_runner import StrategyRunner
from ...locomotion.locomotion import MotionRequest, template_velocity
from ...planning import GaitSettings
from ...strategies import Strategy
from ...strategies.velocity_set import VelocitySet
from .velocity_body import REST, VelocityCommand, VelocityReport

MEMORY_TICK = 0.02  # between poses stored for the strategy, in [s]


class TemplateController:
    r"""Controller with the velocities :math:`(\pm \bar{v}, k \theta^*)`.

    Equations (1) to (6) of the paper.

    Attributes:
        moving: Whether the newest intent is to walk.
    """

    def __init__(
        self,
        strategy: Strategy,
        gait: GaitSettings,
        velocities: VelocitySet | None = None,
    ) -> None:
        """Start without a sighting.

        Args:
            strategy: Function from knowledge to intent.
            gait: Gives speed and gain of the template, and the time over
                which rates are measured.
            velocities: Velocities of a robot that walks sideways; None for
                a unicycle. Strategies may then choose body velocities.
        """
        self._decisions = StrategyRunner(
            strategy, gait, MEMORY_TICK, velocities=velocities
        )
        self._gait = gait
        self.moving = False

    def decide(self, report: VelocityReport) -> VelocityCommand:
        """Return the velocity command for a report.

        Args:
            report: Newest report; without a sighting the command is zero.

        Raises:
            StrategyError: If the strategy does not return an intent.
        """
        decisions, sighting = self._decisions, report.sighting
        decisions.headings.note(report.time, report.pose.theta)
        decisions.templates.note(report.time, report.pose)
        if sighting is None:
            self.moving = False
            return REST
        intent = decisions.decide(report.time, sighting, moving=self.moving)
        self.moving = intent.walks
        strategy = decisions.strategy
        velocity = template_velocity(
            MotionRequest(intent, strategy.direction, strategy.saturated),
            self._gait,
        )
        return VelocityCommand(
            velocity.forward, velocity.turn, velocity.lateral
        )
