"""Descriptions and kinematics of robots."""
