"""Settings of the shield: the person that it expects, and known errors."""

from dataclasses import dataclass

from ..core.ranges import Range
from ..core.setting import CheckedSettings, setting


@dataclass(frozen=True, slots=True)
class ShieldSettings(CheckedSettings, prefix="shield."):
    """Settings of the shield, a filter around the strategy of a robot.

    It changes a decision only where contact with a person within these
    bounds could otherwise no longer be excluded.
    """

    enabled: bool = setting(
        False,
        "Replace decisions after which contact could be forced",
    )
    speed: float = setting(
        1.4,
        "Greatest speed of the opponent that the shield expects",
        Range(1e-3, 3.0, "m/s", "faster is running"),
        needs=("shield.enabled", ""),
    )
    turning_radius: float = setting(
        8.0,
        "Radius of the tightest turn of the opponent at that speed",
        Range(1e-2, 1000.0, "m", "beyond, hardly a turn"),
        needs=("shield.enabled", ""),
    )
    contact: float | None = setting(
        None,
        "Distance between centres that counts as contact",
        Range(0.05, 5.0, "m", "of two bodies", also=(None,)),
        default_text="of both outlines",
        needs=("shield.enabled", ""),
    )
    sighting_error: float = setting(
        0.0,
        "Greatest error of the position of a sighting",
        Range(0.0, 1.0, "m", "beyond, there is no certificate"),
        needs=("shield.enabled", ""),
    )
    sighting_delay: float = setting(
        0.0,
        "Greatest age of a sighting at a decision",
        Range(0.0, 2.0, "s", "beyond, there is no certificate"),
        needs=("shield.enabled", ""),
    )
    loss: float | None = setting(
        None,
        "Greatest departure of the body from its template per decision",
        Range(0.0, 0.5, "m", "beyond, it does not follow", also=(None,)),
        default_text="as measured",
        needs=("shield.enabled", ""),
    )
    response: float | None = setting(
        None,
        "Time from a decision to start until a standing robot moves",
        Range(0.0, 5.0, "s", "beyond, it does not start", also=(None,)),
        default_text="of the legs",
        needs=("shield.enabled", ""),
    )
