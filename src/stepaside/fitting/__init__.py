"""Fitting a stranger's humanoid: describing, checking and tuning it."""
