"""Lights of NAO as a display of the robot's state."""

from collections.abc import Mapping

from ..joint.safety_state_machine import RobotState

Colour = tuple[float, float, float]
OFF: Colour = (0.0, 0.0, 0.0)
COLOURS: Mapping[RobotState, Colour] = {
    RobotState.LIMP: (1.0, 0.0, 0.0),
    RobotState.REACHING: (1.0, 0.5, 0.0),
    RobotState.READY: (0.0, 1.0, 0.0),
    RobotState.WALKING: (0.0, 0.0, 1.0),
    RobotState.STOPPING: (0.5, 0.0, 1.0),
    RobotState.RESTING: (1.0, 1.0, 0.0),
}
EYE_LEDS, EAR_LEDS, SKULL_LEDS = 8, 10, 12


def lights_for(
    state: RobotState, *, sees: bool, charge: float
) -> dict[str, tuple[float, ...]]:
    """Return the brightness of every light, by LoLA's keys.

    Args:
        state: State of the robot, shown by the chest: red limp, orange
            reaching, green ready, blue walking, violet stopping, yellow
            resting.
        sees: Whether there is a sighting of the opponent: white eyes, else
            dark.
        charge: Charge of the battery, from 0 to 1, shown as a bar by the
            ears.
    """
    eye = (1.0 if sees else 0.0,) * (3 * EYE_LEDS)
    lit = round(min(max(charge, 0.0), 1.0) * EAR_LEDS)
    ear = (1.0,) * lit + (0.0,) * (EAR_LEDS - lit)
    skull = (1.0 if state.moves_by_control else 0.0,) * SKULL_LEDS
    return {
        "Chest": COLOURS[state],
        "LEar": ear,
        "REar": ear,
        "LEye": eye,
        "REye": eye,
        "LFoot": OFF,
        "RFoot": OFF,
        "Skull": skull,
    }
