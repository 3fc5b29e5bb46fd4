"""Figures and files that runs are looked at with."""
