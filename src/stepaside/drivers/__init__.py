"""Drivers for real and remote robots, one package per protocol."""
