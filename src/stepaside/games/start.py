"""Where the players stand at first."""

from math import pi, radians

from ..randomness import named_generator
from .settings import DuelSettings, StartSettings


def draw_start(settings: DuelSettings) -> StartSettings:
    """Fill in what a start leaves out, from the seed."""
    generator = named_generator(settings.seed, "start")
    distance = generator.uniform(0.6, 1.5)
    if settings.pursuer == "person":
        distance += 1.5  # whole strides away
    pursuer = generator.uniform(-pi / 2, pi / 2)
    evader = generator.uniform(-radians(30.0), radians(30.0))
    start = settings.start
    return StartSettings(
        distance if start.distance is None else start.distance,
        pursuer if start.pursuer_offset is None else start.pursuer_offset,
        evader if start.evader_offset is None else start.evader_offset,
    )
