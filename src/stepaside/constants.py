"""Constants of nature that more than one room needs."""

GRAVITY = 9.81
"""Gravitational acceleration, in [m/s^2]."""
