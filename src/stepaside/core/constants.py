"""Constants shared by several packages."""

GRAVITY = 9.81
"""Gravitational acceleration, in [m/s^2]."""
CAPTURE_DISTANCE = 0.35
"""Distance between the reference points of two players, in [m], at or below
which the evader is captured. The bodies of two NAOs touch at 0.2 to 0.4 m, by
an arm or a foot: contact is a separate event."""
