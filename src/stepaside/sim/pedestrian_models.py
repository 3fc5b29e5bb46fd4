"""How persons look: their size, their clothes and their steps."""

from dataclasses import dataclass

Colour = tuple[float, float, float, float]
HIP = 0.9  # height of an adult's hips, in [m]


@dataclass(frozen=True, slots=True)
class PedestrianModel:
    """One person's look.

    Attributes:
        size: Of all lengths, those of an adult of 1.74 m being 1.
        step: Way from one foot to the other, in [m].
        swing: Of a leg to either side, in [rad], which leads over a step.
        shirt: Colour, of red, green, blue and opacity.
        trousers: Likewise.
    """

    size: float
    step: float
    swing: float
    shirt: Colour
    trousers: Colour


FIGURES = {
    "adult": PedestrianModel(
        1.0, 0.25, 0.14, (0.80, 0.16, 0.14, 1.0), (0.25, 0.27, 0.32, 1.0)
    ),
    "child": PedestrianModel(
        0.7, 0.3, 0.24, (0.92, 0.78, 0.16, 1.0), (0.16, 0.30, 0.52, 1.0)
    ),
}
