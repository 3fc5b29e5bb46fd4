"""Summary of an experiment: motion of players that was recorded elsewhere."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class ExperimentPlayer:
    """Motion of one player of an experiment.

    Attributes:
        radius_m: Radius of the circle fitted to its position in the last
            third, in [m].
        path_length_m: Length of its path, in [m].
        mean_speed_m_s: Path length over duration, in [m/s].
        longest_gap_s: Longest time without a pose, in [s]; poses in between
            are interpolated.
    """

    radius_m: float | None
    path_length_m: float
    mean_speed_m_s: float
    longest_gap_s: float


@dataclass(frozen=True, slots=True)
class ExperimentSummary:
    """Measurements of an experiment; pairs are of the first two players.

    Attributes:
        source: Name of the recording.
        samples: Number of samples.
        rate_hz: Mean rate of the samples, in [1/s].
        distance_m: Mean distance in the last third, in [m].
        relative_orientation_deg: Mean angle between the headings there, in
            [deg].
        start_distance_m: Distance at the first sample, in [m].
        min_distance_m: Smallest distance, in [m].
        min_distance_at_s: Time of the smallest distance, in [s].
        captured_at_s: Time at which the distance first was at most the
            capture distance, 0.35 m, in [s]; None if it never was.
        measured: Measurements of each player, by name.
        notes: Remarks.
    """

    source: str
    samples: int
    rate_hz: float
    distance_m: float
    relative_orientation_deg: float
    start_distance_m: float
    min_distance_m: float
    min_distance_at_s: float
    captured_at_s: float | None
    measured: dict[str, ExperimentPlayer]
    notes: list[str]
