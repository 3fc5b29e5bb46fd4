"""Connection to a robot that is driven by its joints over NAOqi."""

import logging
from collections.abc import Sequence
from contextlib import ExitStack
from functools import partial
from typing import TYPE_CHECKING

from ...core.poses import Array
from ..guardian_process import open_with_retries
from ..joint.joint_body import JointBody, JointInterface
from ..joint.session_options import PLAIN, SessionOptions
from ..joint.stiffness_guardian import StiffnessGuardian
from ..lola.nao_joints import NAO_MOTORS

if TYPE_CHECKING:
    from .joint_transport import JointTransport

log = logging.getLogger(__name__)


def open_joints(
    url: str,
    joint_names: Sequence[str],
    stance: Array,
    how: SessionOptions = PLAIN,
) -> JointBody:
    """Connect to a robot.

    Args:
        url: Address like tcp://HOST:PORT.
        joint_names: Actuated joints, in the order of joint targets.
        stance: Posture in which control begins, in [rad]. Shape (joints,).
        how: Options of the session; lights are not commanded.

    Raises:
        SessionLost: If no robot or no camera answers.
    """
    with ExitStack() as stack:
        guardian = None
        if how.guards:
            # Forked before the connection, whose library starts threads.
            guardian = StiffnessGuardian(partial(_fade, url))
            stack.callback(guardian.dismiss)
        link = open_with_retries(lambda: _connect(url), how.patience)
        stack.callback(link.close)
        from .joint_transport import CODEC, MemorySight

        eyes = how.eyes()
        sight = MemorySight(link) if link.simulated and eyes is None else None
        if sight is not None:
            log.warning("uses the ideal line of sight of the robot")
        body = JointBody(
            JointInterface(link, NAO_MOTORS, CODEC),
            dict(zip(joint_names, stance.tolist(), strict=True)),
            sight=sight,
            eyes=eyes,
            guardian=guardian,
            safety=how.safety,
            dry_run=how.dry_run,
        )
        stack.pop_all()  # the body closes them from now on
        return body


def _connect(url: str) -> "JointTransport":
    from .joint_transport import JointTransport

    return JointTransport(url)


def _fade(url: str, targets: Array, stiffness: Array) -> None:
    from .joint_transport import ramp_stiffness_down

    ramp_stiffness_down(url, targets, stiffness)
