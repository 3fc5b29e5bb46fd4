"""ALMemory and ALSonar of a simulated robot that walks by itself."""

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
SILENCE = 2.55  # what a sonar says that heard nothing, in [m]


class ALSonar:
    """Sonars: while somebody subscribes their echoes are in ALMemory."""

    def __init__(self, robot: WalkServiceState) -> None:
        """Know the robot."""
        self._robot = robot

    def subscribe(self, name: str) -> None:
        """Let the sonars sound."""
        with self._robot.lock:
            self._robot.calls += 1
            self._robot.listeners.add(name)

    def unsubscribe(self, name: str) -> None:
        """Stop listening; they are silent when nobody listens."""
        with self._robot.lock:
            self._robot.calls += 1
            self._robot.listeners.discard(name)


class ALMemory:
    """Values by key."""

    def __init__(self, robot: WalkServiceState) -> None:
        """Know the robot."""
        self._robot = robot

    def getData(self, key: str) -> Any:
        """One value."""
        with self._robot.lock:
            self._robot.calls += 1
            return self._values()[key]

    def getListData(self, keys: Any) -> list[Any]:
        """Values; None for what there is not."""
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
            heard = robot.state.echoes.get(sonar) if robot.listeners else None
            values[key] = SILENCE if heard is None else heard
        return values


def _sight(state: WalkerState) -> list[float] | None:
    seen = state.sighting
    if seen is None:
        return None
    return [state.time - seen.time, seen.bearing, seen.distance]
