"""Locomotion: from an intended motion of the body to joint targets."""
