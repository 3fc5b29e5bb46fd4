"""Locomotion: from an intent to joint targets."""
