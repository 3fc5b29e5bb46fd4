"""Covariances of the odometry of a simulated robot, by REP 105.

The numbers were measured by ``python -m tools.checks.served_odometry``.
"""

from math import hypot

from ...core.poses import Pose, wrap_angle

SIZE = 6  # x, y, z, and rotations about x, y, z
SWAY = 0.02  # of the position in a gait cycle, in [m]
POSITION_PER_METRE = 0.03  # error of the position per path, in [m/m]
HEADING = 0.01  # in a gait cycle, in [rad]
HEADING_PER_METRE = 0.02  # error of the heading per path, in [rad/m]
HEADING_PER_TURN = 0.02  # error of the heading per turn, in [rad/rad]
# Velocities in a gait cycle beyond those commanded: forward and lateral in
# [m/s], turning in [rad/s].
SPEEDS = 0.03, 0.13, 0.09
# Height, roll and pitch of the footprint are zero by definition (REP 120); a
# variance of zero would mean an unknown one to some programs.
EXACT = 1e-9

Covariance = tuple[float, ...]


def diagonal(x: float, y: float, turn: float) -> Covariance:
    """Return a row-major covariance of planar motion. Length 36.

    Args:
        x: Standard deviation along x, in [m] or [m/s].
        y: Standard deviation along y.
        turn: Standard deviation about z, in [rad] or [rad/s].
    """
    values = (x * x, y * y, EXACT, EXACT, EXACT, turn * turn)
    return tuple(
        values[row] if row == column else 0.0
        for row in range(SIZE)
        for column in range(SIZE)
    )


class OdometryCovariance:
    """Covariances that grow with the path and the turns of a robot."""

    twist = diagonal(*SPEEDS)

    def __init__(self) -> None:
        """Begin where odometry begins."""
        self._last: Pose | None = None
        self._path = self._turned = 0.0

    def note(self, pose: Pose) -> Covariance:
        """Return the covariance of the next pose, in odometry."""
        last, self._last = self._last, pose
        if last is not None:
            self._path += hypot(pose.x - last.x, pose.y - last.y)
            self._turned += abs(wrap_angle(pose.theta - last.theta))
        heading = hypot(
            HEADING,
            HEADING_PER_METRE * self._path,
            HEADING_PER_TURN * self._turned,
        )
        # A heading that errs in proportion to the path bends it.
        aside = 0.5 * HEADING_PER_METRE * self._path**2
        position = hypot(SWAY, POSITION_PER_METRE * self._path, aside)
        return diagonal(position, position, heading)
