"""Balance control of ZMP-based walking."""
