"""Search over steps, against models of the pursuer."""
