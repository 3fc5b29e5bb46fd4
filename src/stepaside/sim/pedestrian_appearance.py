"""Pedestrian models: size, clothes and step length."""

from dataclasses import dataclass

from ..core.player_colours import Colour

HIP = 0.9  # height of an adult's hips, in [m]


@dataclass(frozen=True, slots=True)
class PedestrianModel:
    """Appearance and gait of a pedestrian."""

    size: float  # scale of all lengths; 1 for an adult of 1.74 m
    step: float  # step length [m]
    swing: float  # amplitude of the leg angle [rad], which gives that step
    shirt: Colour  # colour of the shirt: red, green, blue and opacity
    trousers: Colour  # colour of the trousers


FIGURES = {
    "adult": PedestrianModel(
        1.0, 0.25, 0.14, (0.80, 0.16, 0.14, 1.0), (0.25, 0.27, 0.32, 1.0)
    ),
    "child": PedestrianModel(
        0.7, 0.3, 0.24, (0.92, 0.78, 0.16, 1.0), (0.16, 0.30, 0.52, 1.0)
    ),
}
