"""How a robot on NAOqi that walks by itself is told to: by footsteps."""

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
AHEAD = 3  # footsteps that are told at once
REFUSALS = 5  # in a row, after which a robot takes no footsteps
log = logging.getLogger(__name__)


class FootstepMover:
    """Moves a robot by ``setFootSteps``, planned anew when a step begins.

    The template of (7) and (8) begins beside the last foot that cannot be
    changed any more, as the robot says it: replanning takes place at each
    step, as in Sec. III-E. What was told before of later steps is cleared.
    """

    def __init__(
        self,
        motion: Any,
        gait: GaitSettings,
        clock: Callable[[], float],
        limits: StepLimits | None = None,
    ) -> None:
        """Know a robot's ALMotion.

        Args:
            motion: Its ALMotion.
            gait: Gives stride, gain, foot spacing and time of a step.
            clock: Time of this computer, in [s].
            limits: What its walk accepts; NAO's by default.
        """
        self._motion, self._gait = motion, gait
        self._limits = limits or StepLimits()
        self._errand = PendingCall(clock)
        self._asked = REST
        self._look: Any = None
        self._tells = False  # whether the last call told footsteps
        self._after: object = None
        self._refused = 0

    def command(self, velocity: VelocityCommand) -> None:
        """Ask for footsteps along the path of a velocity.

        Raises:
            SessionLost: If the robot is gone, stuck, or takes no footsteps.
        """
        if velocity == REST:
            self._stop()
        elif self._taken():
            self._asked = velocity
            told = self._looked()
            if told is not None:
                self._plan(velocity, *told)

    def _stop(self) -> None:
        """Stop at once, whatever footsteps are on their way."""
        at_rest = self._asked == REST and self._errand.begun
        if at_rest or not self._taken():
            return
        self._asked, self._after = REST, None
        self._look, self._tells = None, False
        self._errand.send("stopMove", self._motion.stopMove(_async=True))

    def _taken(self) -> bool:
        """Whether the robot is free for another command."""
        why = self._errand.refusal() if self._tells else ""
        if why:
            # Perhaps a step has begun meanwhile, which they do not follow.
            log.warning("footsteps refused: %s", why)
            self._after, self._tells = None, False
            self._refused += 1
            if self._refused >= REFUSALS:
                raise SessionLost("the robot takes no footsteps")
            return True
        if not self._errand.arrived:
            return False
        if self._tells:
            self._refused = 0
        return True

    def _looked(self) -> tuple[list[Any], list[Any]] | None:
        """Steps that are certain, and those that can be changed.

        None while the robot has not said them.
        """
        look = self._look
        if look is None:
            self._look = self._motion.getFootSteps(_async=True)
            return None
        if not look.isFinished():
            return None
        self._look = None
        told = answer_of(look, "getFootSteps", within=0.0)
        try:
            _, certain, later = told
            return list(certain), list(later)
        except (TypeError, ValueError) as error:
            raise SessionLost(
                f"the robot's footsteps are {told!r:.60}"
            ) from error

    def _plan(
        self, velocity: VelocityCommand, certain: list[Any], later: list[Any]
    ) -> None:
        """Tell the next footsteps, if the last ones told have begun."""
        last = _leg_and_place(certain[-1]) if certain else None
        if later and last == self._after:
            return
        left_supports = last is not None and last[0] == LEGS[Foot.LEFT]
        steps = plan_footsteps(
            velocity,
            self._gait,
            self._limits,
            first_foot=Foot.RIGHT if left_supports else Foot.LEFT,
            count=AHEAD,
        )
        self._after, self._tells = last, True
        call = self._motion.setFootSteps(*words_of(steps), True, _async=True)
        self._errand.send("setFootSteps", call)


def words_of(
    steps: tuple[FootCommand, ...],
) -> tuple[list[str], list[list[float]], list[float]]:
    """Footsteps as ``setFootSteps`` takes them: legs, places and times."""
    return (
        [LEGS[step.foot] for step in steps],
        [list(step.pose) for step in steps],
        [step.time for step in steps],
    )


def _leg_and_place(told: Any) -> tuple[str, tuple[float, ...]]:
    """Leg and place of a footstep that a robot tells.

    Raises:
        SessionLost: If it is none.
    """
    try:
        leg, _, place = told
        return str(leg), tuple(float(value) for value in place)
    except (TypeError, ValueError) as error:
        raise SessionLost(f"the robot's footstep is {told!r:.60}") from error
