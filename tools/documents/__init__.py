"""Generated parts of README and docs/, from docs/results/."""
