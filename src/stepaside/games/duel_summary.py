"""Summary of a duel."""

from dataclasses import dataclass, field

from .sight_summary import PerceptionSummary, SightSummary


@dataclass(frozen=True, slots=True)
class StartSummary:
    """Initial poses of the players; see ``StartSettings``."""

    distance_m: float | None
    pursuer_offset_rad: float | None
    evader_offset_rad: float | None


@dataclass(frozen=True, slots=True)
class TheorySummary:
    """Theory of the same game.

    Attributes:
        closest_approach_m: Closest approach of a person, or of the pursuer's
            template, to the evader's template, in [m]; None where theory
            gives none.
        exists: Whether there is a circle that the players can reach.
        radius_m: Radius of the evader's circle, in [m].
        distance_m: Distance between the players on the circle, in [m].
        relative_orientation_deg: Angle between their headings on the circle,
            in [deg].
        pursuer_radius_m: Radius of the pursuer's circle, in [m]; equal to
            the evader's for equal players.
        expected: Forecast of the templates of two robots: "circle", "later"
            for a circle reached after the duration, "contact" or "no
            circle".
        circle_since_s: Time from which the templates are on the circle, in
            [s].
        words: The forecast as text; for other games, the reason why there
            is no circle.
    """

    closest_approach_m: float | None
    exists: bool
    radius_m: float | None
    distance_m: float | None
    relative_orientation_deg: float | None
    pursuer_radius_m: float | None = None
    expected: str | None = None
    circle_since_s: float | None = None
    words: str | None = None


@dataclass(frozen=True, slots=True)
class PlanTimes:
    """Processor time of planning one maneuver, in [us]; None without any."""

    median: float | None
    p99: float | None


@dataclass(frozen=True, slots=True)
class PlayerSummary:
    """Summary of one player.

    Attributes:
        radius_m: Radius of the circle fitted to its reference point in the
            last third, in [m].
        sight: Errors and rates of its perception, with camera sensing.
    """

    radius_m: float | None
    sight: SightSummary | None = None


@dataclass(frozen=True, slots=True)
class DuelSummary:
    """Summary of a duel; radii, distance and angle are of its last third.

    The reference point of a robot is midway between its feet, that of a
    person on the axis of the trunk.

    Attributes:
        seed: Seed of every random draw.
        start: Initial poses.
        triggered_at_s: Time at which the evader began to evade, in [s].
        triggered_at_distance_m: True distance between the reference points
            then, in [m].
        distance_m: Mean distance between the reference points, in [m].
        relative_orientation_deg: Mean angle between the headings, in [deg].
        min_distance_m: Smallest distance between the torsos, in [m].
        captured_at_s: Time at which that distance first was at most the
            capture distance, in [s]; None if it never was. Contact is
            another event: it ends a duel, with ``outcome`` and ``touched``.
        converged_at_s: Time from which the players are on the circle of
            theory, in [s]; None if they did not converge.
        replans: Maneuvers planned by both players.
        max_com_velocity_jump_m_s: Greatest jump of the velocity of a CoM
            reference at a replan, in [m/s].
        min_zmp_margin_m: Smallest distance of a ZMP reference from the edge
            of its support polygon, in [m]; None if no robot walked.
        theory: Theory of the same game.
        plan_time_us: Processor time of planning.
        real_time_factor: Simulated time over computing time.
        pursuer: Summary of the pursuer.
        evader: Summary of the evader.
        sight: Perception of both players together, with camera sensing.
        touched: Names of the bodies in contact, if contact ended the duel.
        notes: Remarks, such as that the configuration does not repeat the
            run.
    """

    seed: int
    start: StartSummary
    triggered_at_s: float | None
    triggered_at_distance_m: float | None
    distance_m: float
    relative_orientation_deg: float
    min_distance_m: float
    converged_at_s: float | None
    replans: int
    max_com_velocity_jump_m_s: float
    min_zmp_margin_m: float | None
    theory: TheorySummary
    plan_time_us: PlanTimes
    real_time_factor: float
    pursuer: PlayerSummary
    evader: PlayerSummary
    sight: PerceptionSummary | None = None
    touched: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    captured_at_s: float | None = None
