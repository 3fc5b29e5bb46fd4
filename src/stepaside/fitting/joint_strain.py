"""What a walk asks of the joints: torques, speeds, and how far they sag."""

from typing import NamedTuple

import numpy as np

from ..games.match import Match
from ..games.outcome import Outcome
from ..games.walker import Walker

SETTLED = 0.3  # after which a robot stands as it will, in [s]
STANDS = 0.6  # until which it surely does, in [s]


class JointStrain(NamedTuple):
    """What the joints of a robot bore.

    Attributes:
        standing: Greatest share of a torque limit while it stood.
        standing_joint: Joint that bore it.
        walking: Greatest share while it walked.
        walking_joint: Joint that bore it.
        saturated: Share of the ticks in which some leg joint was at its
            limit.
        sag: How far the CoM stood under its height, in [m].
    """

    standing: float
    standing_joint: str
    walking: float
    walking_joint: str
    saturated: float
    sag: float


class StrainGauge:
    """Watches one robot that walks alone."""

    def __init__(self) -> None:
        """Begin with nothing seen."""
        self._standing = self._walking = np.zeros(0)
        self._names: list[str] = []
        self._ticks = self._saturated = 0
        self._sags: list[float] = []

    def before(self, match: Match) -> None:
        """Look at nothing."""

    def acted(self, match: Match) -> None:
        """Note what the servos pushed with until this tick."""
        model, data = match.world.model, match.world.data
        now = match.world.time
        if now < SETTLED:
            return
        if not self._names:
            self._names = [
                model.joint(model.actuator_trnid[i, 0]).name.split("/", 1)[1]
                for i in range(model.nu)
            ]
            self._limits = model.actuator_forcerange[:, 1].copy()
            self._limits[self._limits <= 0.0] = np.inf
            self._standing = self._walking = np.zeros(model.nu)
        shares = np.abs(data.actuator_force) / self._limits
        self._ticks += 1
        self._saturated += bool((shares > 0.999).any())
        if now < STANDS:
            self._standing = np.maximum(self._standing, shares)
            walker = match.players[0]
            assert isinstance(walker, Walker)
            asked = walker.scheme.reference.com[2]
            self._sags.append(asked - float(walker.truth.com[2]))
        self._walking = np.maximum(self._walking, shares)

    def ended(self, match: Match, outcome: Outcome) -> None:
        """Look at nothing."""

    def strain(self) -> JointStrain:
        """What was borne so far."""
        if not self._names:
            return JointStrain(0.0, "", 0.0, "", 0.0, 0.0)
        stood, walked = self._standing, self._walking
        return JointStrain(
            float(stood.max()),
            self._names[int(stood.argmax())],
            float(walked.max()),
            self._names[int(walked.argmax())],
            self._saturated / max(1, self._ticks),
            float(np.mean(self._sags)) if self._sags else 0.0,
        )
