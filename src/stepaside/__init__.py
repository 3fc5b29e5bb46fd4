"""Real-time pursuit and evasion for humanoid robots."""

__version__ = "0.1.0"
