"""Connection to a robot on LoLA."""

import logging
import socket
from collections.abc import Sequence
from contextlib import ExitStack, suppress
from functools import partial
from time import sleep

from ...core.poses import Array
from ..guardian_process import SessionLost, open_with_retries
from ..joint.joint_body import JointBody, JointInterface
from ..joint.safety_state_machine import RobotState
from ..joint.session_options import PLAIN, SessionOptions
from ..joint.stiffness_guardian import FADING, StiffnessGuardian
from .conventions import CODEC
from .lights import lights_for
from .lola_address import LolaAddress
from .lola_frames import ActuatorFrame, pack_actuators
from .nao_joints import NAO_MOTORS, TICK
from .sight_socket import MESSAGE, SightClient
from .socket_link import SocketLink, connect
from .wire import SENSOR_BYTES

log = logging.getLogger(__name__)


def open_lola(
    address: LolaAddress,
    joint_names: Sequence[str],
    stance: Array,
    how: SessionOptions = PLAIN,
) -> JointBody:
    """Connect to a robot, and to its ideal line of sight if there is one.

    Args:
        address: Address of the robot.
        joint_names: Actuated joints, in the order of joint targets.
        stance: Posture in which control begins, in [rad]. Shape (joints,).
        how: Options of the session.

    Raises:
        SessionLost: If no robot or no camera answers.
    """
    sees = how.open_eyes is not None
    with ExitStack() as stack:
        sight, link = open_with_retries(
            lambda: _sight_and_link(address, sees=sees), how.patience
        )
        stack.callback(link.close)
        if sight is not None:
            stack.callback(sight.close)
        if sight is not None:
            log.warning("uses the ideal line of sight of %s", address.sight)
        elif address.sight is not None and not sees:
            log.info("no ideal line of sight at %s", address.sight)
        guardian = None
        if how.guards:
            guardian = StiffnessGuardian(
                partial(ramp_stiffness_down, link.socket)
            )
            stack.callback(guardian.dismiss)
        body = JointBody(
            JointInterface(link, NAO_MOTORS, CODEC),
            dict(zip(joint_names, stance.tolist(), strict=True)),
            sight=sight,
            eyes=how.eyes(),
            guardian=guardian,
            safety=how.safety,
            dry_run=how.dry_run,
        )
        stack.pop_all()  # the body closes them from now on
        return body


def _sight_and_link(
    address: LolaAddress, *, sees: bool
) -> tuple[SightClient | None, SocketLink]:
    """Connect to the line of sight first, as servers offer it first."""
    sight = None if sees else _ideal_sight(address)
    try:
        link = connect(address, SENSOR_BYTES)
    except BaseException:
        if sight is not None:
            sight.close()
        raise
    if sight is None and not sees:
        sight = _ideal_sight(address)  # the server may have started since
    return sight, link


def _ideal_sight(address: LolaAddress) -> SightClient | None:
    """Connect to the ground truth channel of a simulator, if there is one."""
    if address.sight is None:
        return None
    try:
        return SightClient(connect(address.sight, MESSAGE.size))
    except SessionLost:
        return None


def ramp_stiffness_down(
    robot: socket.socket, targets: Array, stiffness: Array
) -> None:
    """Ramp the stiffness down over LoLA, as far as frames can be sent."""
    robot.setblocking(False)
    count = round(FADING / TICK)
    for left in range(count - 1, -1, -1):
        frame = ActuatorFrame(
            targets,
            stiffness * (left / count),
            lights_for(RobotState.LIMP, sees=False, charge=0.0),
        )
        with suppress(BlockingIOError):
            while robot.recv(1 << 16):
                pass  # discard sensor frames, so that the robot can send
        try:
            robot.send(pack_actuators(frame))
        except BlockingIOError:
            pass
        except OSError:
            return
        sleep(TICK)
