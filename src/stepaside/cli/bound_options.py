"""Options of ``stepaside bound``: the game, its grid and the checks."""

from dataclasses import dataclass
from math import pi
from typing import TYPE_CHECKING

from ..core.ranges import Range
from ..core.setting import check_settings, setting
from .options.parameter_types import positive
from .options.settings_options import refuse_options

if TYPE_CHECKING:
    from ..theory.value import CarGame

AGAINST = ("pursuit", "any", "person")

OF_CARS = {
    "pursuer_gain",
    "evader_turn",
    "horizon",
    "games",
    "output",
}
OF_PERSON = {
    "person_turning_radius",
    "evader_forward",
    "evader_sideways",
    "response",
}


@dataclass(frozen=True, slots=True)
class BoundOptions:
    """Game, grid and solver of ``stepaside bound``."""

    against: str = setting(
        AGAINST[0],
        "The pursuer of eqs. (1)-(2), any with a bounded turning rate, or a "
        "person whom an evader escapes that moves in any direction",
        names=AGAINST,
    )
    pursuer_speed: float = setting(
        1.0,
        "Speed of the pursuer",
        positive("m/s"),
    )
    evader_speed: float = setting(
        1.0,
        "Speed of the evader",
        positive("m/s"),
    )
    pursuer_gain: float = setting(
        0.5,
        "Steering gain k of eq. (2) {unit}, for --against pursuit",
        positive("1/s"),
    )
    pursuer_turn: float | None = setting(
        None,
        "Maximum turning rate of the pursuer {unit}, for --against any",
        positive("rad/s", None),
        default_text="pi k",
    )
    evader_turn: float | None = setting(
        None,
        "Maximum turning rate of the evader",
        positive("rad/s", None),
        default_text="the pursuer's",
    )
    person_turning_radius: float | None = setting(
        None,
        "Tightest turning radius of the person {unit}, for --against person",
        positive("m", None),
        default_text="2.5",
    )
    evader_forward: float | None = setting(
        None,
        "Speed of the evader towards the person {unit}, for --against person",
        positive("m/s", None),
        default_text="--evader-speed",
    )
    evader_sideways: float | None = setting(
        None,
        "Speed of the evader across the line of sight {unit}, for --against "
        "person",
        positive("m/s", None),
        default_text="--evader-speed",
    )
    response: float | None = setting(
        None,
        "Time for which a standing evader still stands {unit}, for --against "
        "person",
        Range(0.0, 60.0, "s", "a robot starts sooner", also=(None,)),
        default_text="0.4",
    )
    capture: float | None = setting(
        None,
        "Capture distance of the barrier in the output",
        positive("m", None),
        default_text="0.7 v/k",
    )
    farthest: float | None = setting(
        None,
        "Outer edge of the grid",
        positive("m", None),
        default_text="depends on the game",
    )
    grid: int = setting(
        64,
        "Grid cells along each axis",
        Range(16, 200, "1", "more do not fit in memory", whole=True),
    )
    refine: int = setting(
        1,
        "Number of coarser grids, each with half the cells, for the error "
        "estimate",
        Range(0, 3, "1", "coarser ones say nothing", whole=True),
    )
    horizon: float | None = setting(
        None,
        "Time horizon",
        positive("s", None),
        default_text="until nothing changes",
    )
    games: int = setting(
        1000,
        "Number of random games simulated to check the table",
        Range(0, 1_000_000, "1", "more take hours", whole=True),
    )

    def __post_init__(self) -> None:
        """Validate ranges and names."""
        check_settings(self)
        if self.against != "any":
            given = f"--against any, got {self.against}"
            refuse_options({"pursuer_turn"}, given)
        if self.against == "person":
            refuse_options(OF_CARS, "--against pursuit or any, got person")
        else:
            refuse_options(OF_PERSON, f"--against person, got {self.against}")

    def game(self) -> "CarGame":
        """Return the game."""
        from ..theory.value import CarGame

        gain, turn = self.pursuer_gain, 0.0
        if self.against == "any":
            gain, turn = 0.0, self.pursuer_turn or pi * gain
        own = self.evader_turn or 0.0
        return CarGame(self.pursuer_speed, self.evader_speed, gain, turn, own)
