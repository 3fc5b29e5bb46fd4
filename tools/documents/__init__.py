"""The parts of README and docs/ that are made from docs/results/."""
