"""Velocity commands, for any robot that walks by itself."""
