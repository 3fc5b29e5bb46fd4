"""The paper's game on learned legs: its circle at their speed and gain."""

from math import nan, pi, sqrt
from pathlib import Path

from ..core.errors import ConfigurationError
from ..games.configuration_file import dump_configuration
from ..games.duel import run_duel
from ..games.duel_settings import DuelSettings
from ..games.outcome import Outcome
from ..games.robot_settings import LEGS_GAIT, with_robot
from ..locomotion.policy.response_file import digest_of
from .claims import Claim, ClaimJob, Readings

NAME = "learned-legs"
RADIUS = 4.0 * LEGS_GAIT["speed"] / (pi * LEGS_GAIT["gain"])
DISTANCE = sqrt(2.0) * RADIUS
CLAIMS = tuple(
    Claim(
        key,
        f"on learned legs, at {LEGS_GAIT['speed']:g} m/s and k = "
        f"{LEGS_GAIT['gain']:g} 1/s, {text}",
        "IV, Fig. 5",
        "physics",
        expected,
        unit,
        tolerance,
    )
    for key, text, expected, unit, tolerance in (
        (
            "pursuer_radius",
            "the pursuer converges to a circle",
            RADIUS,
            "m",
            0.05 * RADIUS,
        ),
        (
            "evader_radius",
            "the evader converges to a circle",
            RADIUS,
            "m",
            0.05 * RADIUS,
        ),
        (
            "distance",
            "their distance converges",
            DISTANCE,
            "m",
            0.03 * DISTANCE,
        ),
        (
            "orientation",
            "their relative orientation is pi/2",
            90.0,
            "deg",
            2.0,
        ),
    )
)


def legs_settings(
    robot: str, seed: int, duration: float = 120.0
) -> DuelSettings:
    """Return the settings of the duel of Fig. 5 on learned legs.

    Args:
        robot: Folder of a robot whose description names a policy.
        seed: Seed of the initial poses.
        duration: Simulated time, in [s].

    Raises:
        ConfigurationError: If the description names no policy.
    """
    settings = DuelSettings(seed=seed, duration=duration)
    settings = with_robot(settings, robot)
    if not settings.legs.walks:
        raise ConfigurationError(
            f"the robot {robot!r} must have learned legs: its robot.toml "
            "names no network in [locomotion]"
        )
    return settings


def measure_circle(settings: DuelSettings) -> Readings:
    """Play a duel; a value that it does not have is NaN."""
    run = run_duel(settings)
    summary = run.summary
    values = {
        "pursuer_radius": summary.pursuer.radius_m,
        "evader_radius": summary.evader.radius_m,
        "distance": summary.distance_m,
        "orientation": summary.relative_orientation_deg,
    }
    ended = run.outcome is not Outcome.COMPLETED
    return {
        key: nan if ended or value is None else value
        for key, value in values.items()
    }


def learned_legs_job(robot: str) -> ClaimJob:
    """Return the job that measures the game on the legs of a robot.

    Args:
        robot: Folder of a robot whose description names a policy.

    Raises:
        ConfigurationError: If the description names no policy.
    """
    network = Path(legs_settings(robot, 1).legs.network)

    def settings_text(seed: int) -> str:
        text = dump_configuration(legs_settings(robot, seed))
        return f"{text}; network {digest_of(network)}"

    return ClaimJob(
        CLAIMS,
        lambda seed: measure_circle(legs_settings(robot, seed)),
        settings_text,
        seeded=True,
    )
