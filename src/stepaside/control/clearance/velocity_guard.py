"""Guard that keeps legs with a velocity set clear of obstacles."""

from math import cos, radians, sin

import numpy as np

from ...core.poses import Array, Pose, arc, rotate
from ...strategies.velocity_set import STILL, BodyVelocity, VelocitySet
from .surroundings import Surroundings

DEVIATIONS = tuple(radians(angle) for angle in range(-120, 121, 15))
SHARES = (1.0, 0.6, 0.3, 0.0)  # of the desired speed
SLOWING = 1.5  # cost of giving up all speed, as a deviation in [rad]
SAMPLES = 9  # of an arc until the next decision; chords are off by < 1 mm
GAIN = 0.005  # by which a robot too near must gain clearance, in [m]
NEARER = 1e-6  # approach on the way that counts as none, in [m]


class VelocityGuard:
    """Guard that changes a desired velocity as little as necessary.

    A velocity is admissible if the robot, walking at it until the next
    decision and halting then, keeps its clearance. The halting distance is
    that measured for the legs, in proportion to the velocity. Among
    admissible velocities in other directions and with less speed the guard
    takes the one nearest to the desired one. Legs without a lateral velocity
    only slow down. A robot that is too near may move away, and comes no
    nearer on the way.
    """

    def __init__(
        self,
        surroundings: Surroundings,
        velocities: VelocitySet,
        clearance: float,
    ) -> None:
        """Guard one robot.

        To its clearance, in [m], the measured tube of the legs is added, as
        the body is that far from the path that is checked.
        """
        self._surroundings, self._velocities = surroundings, velocities
        self._clearance = clearance + velocities.tube
        sideways = velocities.lateral[1] > velocities.lateral[0]
        changes = [
            (abs(angle) + SLOWING * (1.0 - share), angle, share)
            for angle in (DEVIATIONS if sideways else (0.0,))
            for share in SHARES
        ]
        self._changes = [change[1:] for change in sorted(changes)]

    def admit(
        self, velocity: BodyVelocity, pose: Pose, duration: float
    ) -> BodyVelocity:
        """Return the admissible velocity nearest to a desired one.

        ``pose``: Pose of the robot in odometry. The velocity; zero if none is
        admissible.
        """
        solids = self._surroundings.solids
        if velocity == STILL or not len(solids):
            return velocity
        here = self._surroundings.pose_odometry_in_map.compose(pose)
        tried = [
            self._velocities.nearest(_changed(velocity, angle, share))
            for angle, share in self._changes
        ]
        paths = self._paths(np.array(tried), here, duration)
        at = solids.clearance(paths.reshape(-1, 2)).reshape(len(tried), -1)
        now = float(at[0, 0])
        least = min(self._clearance, now - NEARER)
        admissible = at.min(axis=1) >= least
        if now < self._clearance:
            admissible &= at[:, -1] >= now + GAIN
        # Obstacles may be thinner than the way between two points.
        chords = paths[admissible]
        admissible[admissible] = (
            solids.segments_keep_clear(
                np.full(len(solids), least),
                chords[:, :-1].reshape(-1, 2),
                chords[:, 1:].reshape(-1, 2),
            )
            .reshape(len(chords), paths.shape[1] - 1)
            .all(axis=1)
        )
        if not admissible.any():
            return STILL
        best = int(np.argmax(admissible))
        # The desired velocity itself is left as it is.
        return velocity if self._changes[best] == (0.0, 1.0) else tried[best]

    def _paths(self, tried: Array, here: Pose, duration: float) -> Array:
        """Return the positions of the robot at velocities, until it stands.

        ``tried``: Velocities. Shape (n, 3). Positions in the map, in [m].
        Shape (n, SAMPLES + 1, 2).
        """
        times = np.linspace(0.0, duration, SAMPLES)
        ahead, left, turn = tried.T[:, :, None]
        arcs = arc(ahead * times, left * times, turn * times)
        x, y = rotate(arcs[..., 0], arcs[..., 1], here.theta)
        halts = [
            part * halting / max(-low, high, 1e-9)
            for part, (low, high), halting in zip(
                (ahead, left),
                self._velocities[:2],
                self._velocities.halting,
                strict=False,
            )
        ]
        end = here.theta + turn * duration
        u, v = rotate(halts[0], halts[1], end)
        x = np.concatenate([x, x[:, -1:] + u], axis=1)
        y = np.concatenate([y, y[:, -1:] + v], axis=1)
        return np.stack([here.x + x, here.y + y], axis=-1)


def _changed(
    velocity: BodyVelocity, angle: float, share: float
) -> BodyVelocity:
    """Return a velocity in another direction and with a share of its speed."""
    c, s = share * cos(angle), share * sin(angle)
    ahead, left, turn = velocity
    return BodyVelocity(c * ahead - s * left, s * ahead + c * left, turn)
