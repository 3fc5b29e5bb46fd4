"""Joint strain of a walk: torques by their limits, and sag of the CoM."""

from typing import NamedTuple

import numpy as np

from ..games.game import GameInPlay, GameObserver
from ..games.physics_world import PhysicsWorld
from ..games.walker import SimulatedPlayer

STANDING_FROM = 0.3  # time at which transients have settled, in [s]
STANDING_UNTIL = 0.6  # time before which no robot starts walking, in [s]


class JointStrain(NamedTuple):
    """Joint loads of a robot in a walk.

    Attributes:
        standing: Greatest fraction of a torque limit while standing.
        standing_joint: Joint with this load.
        walking: Greatest fraction of a torque limit while walking.
        walking_joint: Joint with this load.
        saturated: Fraction of ticks with a joint at its torque limit.
        sag: Mean deficit of the CoM height while standing, in [m].
    """

    standing: float
    standing_joint: str
    walking: float
    walking_joint: str
    saturated: float
    sag: float


class StrainGauge(GameObserver):
    """Observer that measures the joint strain of the first player."""

    def __init__(self) -> None:
        """Begin without data."""
        self._standing = self._walking = np.zeros(0)
        self._names: list[str] = []
        self._ticks = self._saturated = 0
        self._sags: list[float] = []

    def acted(self, game: GameInPlay) -> None:
        """Record the actuator forces of this tick."""
        world = game.world
        assert isinstance(world, PhysicsWorld)
        model, data, now = world.model, world.data, world.time
        if now < STANDING_FROM:
            return
        if not self._names:
            self._names = [
                model.joint(model.actuator_trnid[i, 0]).name.split("/", 1)[1]
                for i in range(model.nu)
            ]
            self._limits = model.actuator_forcerange[:, 1].copy()
            self._limits[self._limits <= 0.0] = np.inf
            self._standing = self._walking = np.zeros(model.nu)
        loads = np.abs(data.actuator_force) / self._limits
        self._ticks += 1
        self._saturated += bool((loads > 0.999).any())
        if now < STANDING_UNTIL:
            self._standing = np.maximum(self._standing, loads)
            (walker,) = world.players
            assert isinstance(walker, SimulatedPlayer)
            height = walker.scheme.state.reference.com[2]
            self._sags.append(
                height - float(walker.truth.position_com_in_world[2])
            )
        self._walking = np.maximum(self._walking, loads)

    def strain(self) -> JointStrain:
        """Return the strain so far."""
        if not self._names:
            return JointStrain(0.0, "", 0.0, "", 0.0, 0.0)
        standing, walking = self._standing, self._walking
        return JointStrain(
            float(standing.max()),
            self._names[int(standing.argmax())],
            float(walking.max()),
            self._names[int(walking.argmax())],
            self._saturated / max(1, self._ticks),
            float(np.mean(self._sags)) if self._sags else 0.0,
        )
