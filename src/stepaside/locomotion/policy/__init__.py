"""Learned walking policies: a velocity command in, joint targets out."""
