"""Asking the strategy of one robot, with what it remembers."""

from dataclasses import replace
from math import cos, pi, sin
from typing import Any

from ..core.poses import Pose, wrap_angle
from ..perception.measurement import Measurement, Sighting
from ..planning import Foot, GaitSettings
from ..planning.template_path import passed_beside
from ..strategies.foreign_code import ask
from ..strategies.knowledge import ON_THE_SPOT, Intent, Knowledge, Limits
from ..strategies.opponent_rates import FloorVelocity, SightRates
from ..strategies.strategy import Strategy
from .clearance.surroundings import OpenFloor, Surroundings
from .state_history import StateHistory
from .turn_calibration import TurnCalibration

QUICKENING = 0.25  # most that the pace changes from step to step


def next_pace(before: float, wanted: float, *, standing: bool) -> float:
    """Pace of the next step.

    Steps in less time need the CoM less far to the side. What the last step
    prepared for is made good by the correction of the next plan, which is
    a ZMP shift, and that has to stay well inside the sole.

    Args:
        before: Pace of the last step.
        wanted: Pace that is asked for.
        standing: Whether the robot stands: then nothing was prepared.
    """
    if standing:
        return wanted
    return min(max(wanted, before - QUICKENING), before + QUICKENING)


class StrategyRunner:
    """The strategy of a robot and its memory, from decision to decision.

    Attributes:
        strategy: From what the robot knows to what it wants.
        memory: What the strategy remembers.
        pace: Of the last step that was decided, see :class:`Intent`.
        headings: Past headings of the torso in odometry, in [rad], from
            which sightings count.
        templates: Past poses of the unicycle that stands for the body.
        turns: How much of its turns the body makes; None for all of them.
    """

    def __init__(
        self,
        strategy: Strategy,
        gait: GaitSettings,
        tick: float,
        surroundings: Surroundings | None = None,
    ) -> None:
        """Begin with nobody seen yet.

        Args:
            strategy: From what the robot knows to what it wants.
            gait: How it walks.
            tick: Control period, in [s].
            surroundings: What the robot knows of what stands around.
        """
        self._around = surroundings or OpenFloor()
        self.strategy = strategy
        self.memory: Any = strategy.begin()
        self.pace = 1.0
        self.headings: StateHistory[float] = StateHistory(tick)
        self.templates: StateHistory[Pose] = StateHistory(tick)
        self.turns: TurnCalibration | None = None
        self._step_duration = gait.step_duration
        self._spacing = gait.foot_spacing
        self._whom = 0
        self._forget()
        self._limits = Limits(
            gait.speed, gait.gain, gait.stride, gait.step_duration
        )

    def _forget(self) -> None:
        """Know nothing of how the other moves."""
        self._rates = SightRates(self._step_duration)
        self._drift = FloorVelocity(self._step_duration)

    def feel(self, measurement: Measurement, *, stands: bool) -> None:
        """Take in how the body turns, if that is to be learnt.

        Args:
            measurement: What the sensors give.
            stands: Whether the robot stands still.
        """
        if self.turns is not None:
            believed = self.templates.at(measurement.time).theta
            rate = float(measurement.gyro[2])
            self.turns.note(rate, believed, stands=stands)

    def adopt(self, strategy: Strategy) -> None:
        """Follow another strategy from the next decision on.

        Args:
            strategy: One of the same kind goes on with what is remembered;
                another kind begins anew.
        """
        if type(strategy) is not type(self.strategy):
            self.memory = strategy.begin()
        self.strategy = strategy

    def starts(
        self, now: float, seen: Sighting | None, turning: float = 0.0
    ) -> bool:
        """Whether a robot that stands is to walk.

        Who learns how much of a turn it makes stands for a while first.

        A robot that is to walk is asked again for the instant at which the
        step takes effect, and what it would remember of this time is
        forgotten.

        Args:
            now: Time of the decision, in [s].
            seen: What was seen last; None for nobody.
            turning: How it turns while it looks around before it begins:
                1 to the left, -1 to the right, 0 not at all.

        Raises:
            StrategyError: If the strategy gives no intent.
        """
        if self.turns is not None and not self.turns.rested:
            return False
        if seen is None:
            return turning != 0.0
        known = self._knowledge(now, seen, moving=False)
        intent, memory = ask(self.strategy, known, self.memory)
        if not intent.walks:
            self.memory = memory
        # The first steps of somebody tell little of where the way leads.
        return intent.walks and seen.settled

    def decide(
        self,
        now: float,
        seen: Sighting | None,
        turning: float = 0.0,
        stands: tuple[Pose, Foot] | None = None,
        *,
        moving: bool,
    ) -> Intent:
        """Ask what the robot wants, and remember it.

        Args:
            now: Time of the decision, in [s].
            seen: What was seen last; None for who looks around.
            turning: How that one turns: 1 to the left, -1 to the right.
            stands: Foot that has just landed, in odometry, and which it
                is; None for a body that is where its next step begins.
            moving: Whether it is under way.

        Raises:
            StrategyError: If the strategy gives no intent.
        """
        if seen is None:
            return Intent(turning * pi, ON_THE_SPOT)
        known = self._knowledge(now, seen, moving=moving)
        if moving and stands is not None:
            begins = passed_beside(*stands, self._spacing)
            there = self._around.frame.compose(begins)
            known = replace(known, begins=there)
        intent, self.memory = ask(self.strategy, known, self.memory)
        if self.turns is not None:
            intent = replace(intent, heading=self.turns.asked(intent.heading))
        self.pace = next_pace(self.pace, intent.pace, standing=not moving)
        if intent.pace != self.pace:
            intent = replace(intent, pace=self.pace)
        return intent

    def _knowledge(
        self, now: float, seen: Sighting, *, moving: bool
    ) -> Knowledge:
        """What is known, in the frame of the unicycle that saw.

        Line of sight and heading are of one instant: the foot that lands
        stands for a body that is half a step farther than the one that saw,
        and the torso looks where both feet do.
        """
        if seen.who != self._whom:
            # From one person to another nobody walks.
            self._whom = seen.who
            self._forget()
        template = self.templates.at(seen.time)
        sight = self.headings.at(seen.time) + seen.bearing
        rates = self._rates.note(seen.time, sight, seen.distance)
        place = template.compose(
            Pose(
                seen.distance * cos(sight - template.theta),
                seen.distance * sin(sight - template.theta),
                0.0,
            )
        )
        drift = self._drift.note(seen.time, place.x, place.y)
        if drift is not None:
            turned = Pose(0.0, 0.0, -template.theta)
            drift = turned.compose(Pose(*drift, 0.0))[:2]
        return Knowledge(
            now,
            wrap_angle(sight - template.theta),
            seen.distance,
            self._limits,
            rates.bearing_rate,
            rates.closing_speed,
            max(0.0, now - seen.time),
            self._around.frame.compose(template),
            moving,
            self._around.solids.shapes,
            drift,
            spread=seen.spread,
            blur=self._around.blur,
        )
