"""ALMemory and ALSonar of a simulated robot with walking control."""

from collections.abc import Mapping
from typing import Any

from ..velocity.walking_robot import WalkerState
from .naoqi_url import IDEAL_SIGHT
from .service_state import WalkServiceState

SUBDEVICES = "Device/SubDeviceList"
SENSED = "Position/Sensor/Value"
SONARS = {
    "left": f"{SUBDEVICES}/US/Left/Sensor/Value",
    "right": f"{SUBDEVICES}/US/Right/Sensor/Value",
}
NO_ECHO = 2.55  # reading of a sonar without an echo, in [m]


class ALSonar:
    """Sonars, whose echoes are in ALMemory while there are subscribers."""

    def __init__(self, robot: WalkServiceState) -> None:
        """Create the service of a robot."""
        self._robot = robot

    def subscribe(self, name: str) -> None:
        """Switch the sonars on for a subscriber."""
        with self._robot.lock:
            self._robot.calls += 1
            self._robot.listeners.add(name)

    def unsubscribe(self, name: str) -> None:
        """Remove a subscriber; without any the sonars are off."""
        with self._robot.lock:
            self._robot.calls += 1
            self._robot.listeners.discard(name)


class ALMemory:
    """Values by key."""

    def __init__(self, robot: WalkServiceState) -> None:
        """Create the service of a robot."""
        self._robot = robot

    def getData(self, key: str) -> Any:
        """Return the value of a key."""
        with self._robot.lock:
            self._robot.calls += 1
            return self._values()[key]

    def getListData(self, keys: Any) -> list[Any]:
        """Return the values of keys; None for unknown keys."""
        with self._robot.lock:
            self._robot.calls += 1
            values = self._values()
            return [values.get(key) for key in keys]

    def _values(self) -> Mapping[str, Any]:
        robot = self._robot
        values: dict[str, Any] = {
            "robotHasFallen": float(robot.fallen),
            "ChestButtonPressed": float(robot.pressed),
            IDEAL_SIGHT: _sight(robot.state),
        }
        for name, angle in zip(robot.names, robot.state.joints, strict=True):
            values[f"{SUBDEVICES}/{name}/{SENSED}"] = angle
        for sonar, key in SONARS.items():
            echo = robot.state.echoes.get(sonar) if robot.listeners else None
            values[key] = NO_ECHO if echo is None else echo
        return values


def _sight(state: WalkerState) -> list[float] | None:
    sighting = state.sighting
    if sighting is None:
        return None
    return [state.time - sighting.time, sighting.bearing, sighting.distance]
