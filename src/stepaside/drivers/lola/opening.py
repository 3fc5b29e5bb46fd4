"""Connecting to a robot that speaks LoLA."""

import logging
from collections.abc import Sequence

from ...poses import Array
from ..session import SessionLost
from .address import Address
from .body import LolaBody
from .guardian import StiffnessGuardian
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

    Raises:
        SessionLost: If no robot listens there.
    """
    sight = _ideal_sight(address)
    try:
        link = connect(address, SENSOR_BYTES)
    except SessionLost:
        if sight is not None:
            sight.close()
        raise
    # Not before: who finds no robot is told that, and nothing else.
    if sight is not None:
        log.warning("sees by the ideal line of sight of %s", address.sight)
    elif address.sight is not None:
        log.info("no ideal line of sight at %s", address.sight)
    return LolaBody(
        link,
        joint_names,
        stance,
        sight=sight,
        guardian=(
            StiffnessGuardian(link.socket) if guarded and not dry_run else None
        ),
        safety=safety,
        dry_run=dry_run,
    )


def _ideal_sight(address: Address) -> SightChannel | None:
    """The simulator's truth, where there is a simulator that offers it."""
    beside = address.sight
    if beside is None:
        return None
    try:
        return SightChannel(connect(beside, MESSAGE.size))
    except SessionLost:
        return None
