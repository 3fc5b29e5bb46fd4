"""The template as it stands in the paper: a strategy drives a unicycle."""

from ...control.strategy_runner import StrategyRunner
from ...planning import GaitSettings
from ...strategies import Strategy
from ...theory import laws
from .velocity_body import REST, VelocityCommand, VelocityReport

MEMORY_TICK = 0.02  # of remembered poses, in [s]: some seconds are kept


class TemplateController:
    r"""Velocities :math:`(\pm \bar{v}, k \theta^*)`, eqs. (1) to (6).

    Attributes:
        moving: Whether the strategy wants motion.
    """

    def __init__(self, strategy: Strategy, gait: GaitSettings) -> None:
        """Begin with nobody seen yet.

        Args:
            strategy: From what is known to what is wanted.
            gait: Gives speed and gain of the template, and the time that
                rates are measured over.
        """
        self._decisions = StrategyRunner(strategy, gait, MEMORY_TICK)
        self._gait = gait
        self.moving = False

    def decide(self, report: VelocityReport) -> VelocityCommand:
        """What the template is told now.

        Args:
            report: What the robot says; rest is the answer to a report
                without a sighting.

        Raises:
            StrategyError: If the strategy gives no intent.
        """
        decisions, seen = self._decisions, report.sighting
        decisions.headings.note(report.time, report.pose.theta)
        decisions.templates.note(report.time, report.pose)
        if seen is None:
            self.moving = False
            return REST
        intent = decisions.decide(report.time, seen, moving=self.moving)
        self.moving = intent.walks
        if not intent.walks:
            return REST
        strategy, gait = decisions.strategy, self._gait
        law = (
            laws.saturated_rate
            if strategy.saturated
            else laws.proportional_rate
        )
        return VelocityCommand(
            strategy.direction.value * gait.speed * intent.speed_factor,
            law(intent.heading, gait.gain),
        )
