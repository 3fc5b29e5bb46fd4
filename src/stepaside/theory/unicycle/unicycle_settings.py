"""Settings of games of two unicycles."""

from dataclasses import dataclass
from math import pi

from ...core.ranges import Range, positive
from ...core.setting import CheckedSettings, setting
from .circles import settling_time
from .simulation import RelativeStart
from .unicycle_game import LAWS, SIDE_RULES, Unicycles


@dataclass(frozen=True, slots=True)
class UnicycleGameSettings(CheckedSettings):
    """Speeds, gains and evasion of two unicycles."""

    speed: float = setting(1.0, "Speed v of both players", positive("m/s"))
    gain: float = setting(
        0.5, "Steering gain k of both players", positive("1/s")
    )
    pursuer_speed: float | None = setting(
        None, "Speed of the pursuer, if different", positive("m/s", None)
    )
    evader_speed: float | None = setting(
        None, "Speed of the evader, if different", positive("m/s", None)
    )
    pursuer_gain: float | None = setting(
        None, "Gain of the pursuer, if different", positive("1/s", None)
    )
    evader_gain: float | None = setting(
        None, "Gain of the evader, if different", positive("1/s", None)
    )
    angle: float = setting(
        pi / 2,
        "Evasion angle {unit}; 90deg moves aside, 0 back",
        Range(0.0, pi, "rad", "the sign is given by the side"),
    )
    law: str = setting(
        LAWS[0],
        "Turning law of the evader: eq. (4) or eq. (6)",
        names=LAWS,
    )
    side_rule: str = setting(
        SIDE_RULES[0],
        "Side of the line of sight to which the evader moves: the side "
        "behind it at every instant, or its initial side (latched)",
        names=SIDE_RULES,
    )
    hysteresis: float = setting(
        0.0,
        "Angle beyond the evader's axis at which it changes side",
        Range(0.0, pi / 2, "rad", "beyond, it never changes side"),
        needs=("side_rule", "behind"),
    )

    @property
    def game(self) -> Unicycles:
        """The game of these settings."""
        return Unicycles(
            self.pursuer_speed or self.speed,
            self.evader_speed or self.speed,
            self.pursuer_gain or self.gain,
            self.evader_gain or self.gain,
            self.angle,
            self.law,
            side_rule=self.side_rule,
            hysteresis=self.hysteresis,
        )


@dataclass(frozen=True, slots=True)
class UnicycleSettings(UnicycleGameSettings):
    """Settings of one game of two unicycles, with its start."""

    distance: float | None = setting(
        None,
        "Initial distance",
        positive("m", None),
        default_text="2.5 v/k",
    )
    aim: float = setting(
        0.2,
        "Initial bearing of the evader in the pursuer's frame",
        Range(-pi, pi, "rad", "half a turn"),
    )
    bearing: float = setting(
        -0.1,
        "Initial bearing of the pursuer in the evader's frame",
        Range(-pi, pi, "rad", "half a turn"),
    )
    duration: float | None = setting(
        None,
        "Simulated time",
        positive("s", None),
        default_text="until the game has settled",
    )
    capture: float = setting(
        1e-6, "Capture distance, which ends the game", positive("m")
    )

    @property
    def start(self) -> RelativeStart:
        """Initial relative pose."""
        unit = self.game.evader_speed / self.game.evader_gain
        distance = self.distance or 2.5 * unit
        return RelativeStart(distance, self.aim, self.bearing)

    @property
    def time(self) -> float:
        """Simulated time, in [s]."""
        return self.duration or settling_time(self.game)
