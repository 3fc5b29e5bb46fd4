"""Obstacle clearance, independent of the strategy."""
