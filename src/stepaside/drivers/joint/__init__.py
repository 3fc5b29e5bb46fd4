"""Robots that are driven by their joints, whatever protocol they speak."""
