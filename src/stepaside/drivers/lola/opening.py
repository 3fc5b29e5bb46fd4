"""Connecting to a robot that speaks LoLA."""

import logging
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from functools import partial

from ...poses import Array
from ..cameras.source import PerceptSource
from ..session import SessionLost
from .address import Address
from .body import LolaBody
from .guardian import StiffnessGuardian, let_go
from .link import connect
from .safety import SafetySettings
from .sight import MESSAGE
from .sight_channel import SightChannel
from .wire import SENSOR_BYTES

log = logging.getLogger(__name__)


def open_lola(
    address: Address,
    joint_names: Sequence[str],
    stance: Array,
    *,
    safety: SafetySettings | None = None,
    dry_run: bool = False,
    guarded: bool = False,
    open_eyes: Callable[[], PerceptSource] | None = None,
) -> LolaBody:
    """Connect to a robot, and to the ideal line of sight if it offers one.

    Args:
        address: Where it listens.
        joint_names: Actuated joints, in the order of joint targets.
        stance: Posture in which control begins, in [rad].
        safety: Limits of what is safe.
        dry_run: Command nothing but lights.
        guarded: Whether a second process lets go of the robot if this one
            dies or freezes. Forks: not for a process with threads.
        open_eyes: Opens its cameras, if it is played with those instead of
            with an ideal line of sight. They may start threads.

    Raises:
        SessionLost: If no robot listens there, or no camera.
    """
    sees = open_eyes is not None
    sight = None if sees else _ideal_sight(address)
    with ExitStack() as stack:
        if sight is not None:
            stack.callback(sight.close)
        link = connect(address, SENSOR_BYTES)
        stack.callback(link.close)
        # Not before: who finds no robot is told that, and nothing else.
        if sight is not None:
            log.warning("sees by the ideal line of sight of %s", address.sight)
        elif address.sight is not None and not sees:
            log.info("no ideal line of sight at %s", address.sight)
        guardian = None
        if guarded and not dry_run:
            guardian = StiffnessGuardian(partial(let_go, link.socket))
            stack.callback(guardian.dismiss)
        eyes = None if open_eyes is None else open_eyes()
        body = LolaBody(
            link,
            joint_names,
            stance,
            sight=sight,
            eyes=eyes,
            guardian=guardian,
            safety=safety,
            dry_run=dry_run,
        )
        stack.pop_all()  # they are the body's now
        return body


def _ideal_sight(address: Address) -> SightChannel | None:
    """The simulator's truth, where there is a simulator that offers it."""
    beside = address.sight
    if beside is None:
        return None
    try:
        return SightChannel(connect(beside, MESSAGE.size))
    except SessionLost:
        return None
