"""Summary of a player at a robot, by its own odometry and sightings."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class PlayStateChange:
    """Change of the state of a robot.

    Attributes:
        time_s: Time since the record began, in [s].
        state: New state.
        reason: Reason, as text.
    """

    time_s: float
    state: str
    reason: str


@dataclass(frozen=True, slots=True)
class PlaySummary:
    """Summary of one player, by its own odometry and its own sightings.

    Attributes:
        role: "pursuer" or "evader".
        language: Protocol of the robot: "lola", "naoqi", "ros2" or "python".
        walking_s: Time in the walking state, in [s].
        steps: Footsteps begun; None where the robot has its own walk.
        path_length_m: Length of the path, in [m], without the sway of a
            gait cycle.
        radius_m: Radius of the circle fitted to the last third of the walk,
            in [m]; None if the path hardly turns there.
        distance_m: Mean distance to the opponent there, in [m]; None
            without a sighting.
        closest_m: Smallest distance of a sighting, in [m].
        sighted_share: Fraction of the walking time with a valid sighting.
        plan_time_us: Median processor time of a plan, in [us].
        changes: Changes of state, with time and reason.
    """

    role: str
    language: str
    walking_s: float
    steps: int | None
    path_length_m: float
    radius_m: float | None
    distance_m: float | None
    closest_m: float | None
    sighted_share: float | None
    plan_time_us: float | None
    changes: tuple[PlayStateChange, ...]
