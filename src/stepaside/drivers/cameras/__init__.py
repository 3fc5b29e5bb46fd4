"""Cameras of real and remote robots."""
