r"""Relative coordinates of two unicycles.

.. math::
    \dot r = v_e \cos\psi - v_p \cos a, \qquad
    \Omega = (v_p \sin a - v_e \sin\psi) / r, \qquad
    \dot a = \Omega - \omega_p, \qquad \dot\psi = \Omega - \omega_e
"""

from dataclasses import dataclass
from math import atan2, cos, hypot, pi, sin

from ...core.errors import check_bearing, check_positive
from ...core.poses import Pose, wrap_angle


@dataclass(frozen=True, slots=True)
class RelativeStart:
    r"""Relative coordinates of two unicycles.

    Attributes:
        distance: Distance :math:`r`, in [m].
        pursuer_error: Bearing :math:`a` of the evader in the pursuer's
            frame, which is the error of (2), in [rad].
        bearing: Bearing :math:`\psi` of the pursuer in the evader's frame,
            in [rad]; zero if the evader faces the pursuer.
    """

    distance: float
    pursuer_error: float = 0.0
    bearing: float = 0.0

    def __post_init__(self) -> None:
        """Check the values."""
        check_positive(self.distance, "distance", "m")
        check_bearing(self.pursuer_error, "pursuer_error")
        check_bearing(self.bearing, "bearing")

    @classmethod
    def from_world(cls, pursuer: Pose, evader: Pose) -> "RelativeStart":
        """Compute relative coordinates of two poses in a common frame."""
        dx, dy = evader.x - pursuer.x, evader.y - pursuer.y
        sight = atan2(dy, dx)
        return cls(
            hypot(dx, dy),
            wrap_angle(sight - pursuer.theta),
            wrap_angle(sight + pi - evader.theta),
        )

    def wrapped(self) -> tuple[float, float, float]:
        """Return the distance [m] and both angles in [-pi, pi] [rad]."""
        a, psi = wrap_angle(self.pursuer_error), wrap_angle(self.bearing)
        return self.distance, a, psi

    def poses(self) -> tuple[Pose, Pose]:
        """Return the poses of both in the initial frame of the pursuer."""
        r, sight = self.distance, self.pursuer_error
        turned = sight + pi - self.bearing
        return Pose(0.0, 0.0, 0.0), Pose(
            r * cos(sight), r * sin(sight), turned
        )
