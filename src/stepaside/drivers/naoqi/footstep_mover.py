"""Footstep commands to ALMotion."""

import logging
from collections.abc import Callable
from typing import Any

from ...planning import Foot, GaitSettings
from ..guardian_process import SessionLost
from ..velocity.footstep_commands import (
    FootCommand,
    StepLimits,
    plan_footsteps,
)
from ..velocity.velocity_body import REST, VelocityCommand
from .qi_session import answer_of
from .velocity_mover import PendingCall

LEGS = {Foot.LEFT: "LLeg", Foot.RIGHT: "RLeg"}
HORIZON = 3  # footsteps per command
MAX_REFUSALS = 5  # consecutive refusals after which the session ends
log = logging.getLogger(__name__)


class FootstepMover:
    """Mover by ``setFootSteps``, which replans when a step begins.

    The template of (7) and (8) starts beside the last footstep that the
    robot reports as unchangeable: replanning takes place at each step, as
    in Sec. III-E. Later footsteps of earlier plans are cleared.
    """

    def __init__(
        self,
        motion: Any,
        gait: GaitSettings,
        clock: Callable[[], float],
        limits: StepLimits | None = None,
    ) -> None:
        """Start without footsteps.

        Args:
            motion: The robot's ALMotion.
            gait: Gives stride, gain, foot spacing and step duration.
            clock: Time of this computer, in [s].
            limits: Limits of one step; NAO's by default.
        """
        self._motion, self._gait = motion, gait
        self._limits = limits or StepLimits()
        self._call = PendingCall(clock)
        self._commanded = REST
        self._query: Any = None  # pending call of getFootSteps
        self._sent_footsteps = False  # whether the last call sent footsteps
        self._planned_after: object = None
        self._refused = 0

    def command(self, velocity: VelocityCommand) -> None:
        """Command footsteps along the path of a velocity.

        Raises:
            SessionLost: If the robot cannot be reached, does not answer, or
                refuses all footsteps.
        """
        if velocity == REST:
            self._stop()
        elif self._is_free():
            self._commanded = velocity
            footsteps = self._reported_footsteps()
            if footsteps is not None:
                self._plan(velocity, *footsteps)

    def _stop(self) -> None:
        """Stop at once, and drop all pending footsteps."""
        is_stopped = self._commanded == REST and self._call.begun
        if is_stopped or not self._is_free():
            return
        self._commanded, self._planned_after = REST, None
        self._query, self._sent_footsteps = None, False
        self._call.send("stopMove", self._motion.stopMove(_async=True))

    def _is_free(self) -> bool:
        """Whether the last command has been answered."""
        reason = self._call.refusal() if self._sent_footsteps else ""
        if reason:
            # A step may have begun meanwhile, so that the plan did not fit.
            log.warning("footsteps refused: %s", reason)
            self._planned_after, self._sent_footsteps = None, False
            self._refused += 1
            if self._refused >= MAX_REFUSALS:
                raise SessionLost(
                    f"the robot refused {MAX_REFUSALS} footstep commands in "
                    f"a row: {reason}"
                )
            return True
        if not self._call.arrived:
            return False
        if self._sent_footsteps:
            self._refused = 0
        return True

    def _reported_footsteps(self) -> tuple[list[Any], list[Any]] | None:
        """Return the unchangeable and the changeable footsteps.

        None until the robot has reported them.
        """
        query = self._query
        if query is None:
            self._query = self._motion.getFootSteps(_async=True)
            return None
        if not query.isFinished():
            return None
        self._query = None
        answer = answer_of(query, "getFootSteps", within=0.0)
        try:
            _, fixed, changeable = answer
            return list(fixed), list(changeable)
        except (TypeError, ValueError) as error:
            raise SessionLost(
                f"getFootSteps must return three lists, got {answer!r:.60}"
            ) from error

    def _plan(
        self,
        velocity: VelocityCommand,
        fixed: list[Any],
        changeable: list[Any],
    ) -> None:
        """Send new footsteps, if a step of the last plan has begun."""
        last = _leg_and_pose(fixed[-1]) if fixed else None
        if changeable and last == self._planned_after:
            return
        left_supports = last is not None and last[0] == LEGS[Foot.LEFT]
        steps = plan_footsteps(
            velocity,
            self._gait,
            self._limits,
            first_foot=Foot.RIGHT if left_supports else Foot.LEFT,
            count=HORIZON,
        )
        self._planned_after, self._sent_footsteps = last, True
        call = self._motion.setFootSteps(
            *footstep_arguments(steps), True, _async=True
        )
        self._call.send("setFootSteps", call)


def footstep_arguments(
    steps: tuple[FootCommand, ...],
) -> tuple[list[str], list[list[float]], list[float]]:
    """Return the arguments of ``setFootSteps``: legs, poses and times."""
    return (
        [LEGS[step.foot] for step in steps],
        [list(step.pose) for step in steps],
        [step.time for step in steps],
    )


def _leg_and_pose(entry: Any) -> tuple[str, tuple[float, ...]]:
    """Return leg and relative pose of an entry of ``getFootSteps``."""
    try:
        leg, _, pose = entry
        return str(leg), tuple(float(value) for value in pose)
    except (TypeError, ValueError) as error:
        raise SessionLost(
            "a footstep of getFootSteps must be leg, time and pose, got "
            f"{entry!r:.60}"
        ) from error
