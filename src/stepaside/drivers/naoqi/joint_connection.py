"""Connecting to a robot on NAOqi whose joints are moved."""

import logging
from collections.abc import Sequence
from contextlib import ExitStack
from functools import partial
from typing import TYPE_CHECKING

from ...core.poses import Array
from ..guardian_process import open_within
from ..joint.joint_body import JointBody
from ..joint.session_options import PLAIN, SessionOptions
from ..joint.stiffness_guardian import StiffnessGuardian

if TYPE_CHECKING:
    from .joint_transport import JointTransport

log = logging.getLogger(__name__)


def open_joints(
    url: str,
    joint_names: Sequence[str],
    stance: Array,
    how: SessionOptions = PLAIN,
) -> JointBody:
    """Connect to a robot, whose body is the one that LoLA's robots have.

    Args:
        url: Like tcp://HOST:PORT.
        joint_names: Actuated joints, in the order of joint targets.
        stance: Posture in which control begins, in [rad].
        how: What is asked of the session; lights stay as they are.

    Raises:
        SessionLost: If no robot answers there, or no camera.
    """
    with ExitStack() as stack:
        guardian = None
        if how.guards:
            # Forked here: what speaks to the robot starts threads.
            guardian = StiffnessGuardian(partial(_fade, url))
            stack.callback(guardian.dismiss)
        line = open_within(lambda: _line_to(url), how.patience)
        stack.callback(line.close)
        from .joint_transport import CODEC, MemorySight

        eyes = how.eyes()
        sight = MemorySight(line) if line.simulated and eyes is None else None
        if sight is not None:
            log.warning("sees by the ideal line of sight of the robot")
        body = JointBody(
            line,
            joint_names,
            stance,
            sight=sight,
            eyes=eyes,
            guardian=guardian,
            safety=how.safety,
            dry_run=how.dry_run,
            codec=CODEC,
        )
        stack.pop_all()  # they are the body's now
        return body


def _line_to(url: str) -> "JointTransport":
    from .joint_transport import JointTransport

    return JointTransport(url)


def _fade(url: str, targets: Array, stiffness: Array) -> None:
    from .joint_transport import fade

    fade(url, targets, stiffness)
