"""Summary of a game of any kind: a duel, a walk, a play at a robot, a bag.

Names end with their unit. What is unknown, or no part of a game, is None.
"""

from dataclasses import dataclass, field


@dataclass(frozen=True, slots=True)
class SightSummary:
    """Errors of the sightings of one robot with cameras."""

    bearing_error_median_deg: float | None
    bearing_error_p95_deg: float | None
    distance_error_median_m: float | None
    misled_s: float  # with a bearing error above 20 deg
    lost_s: float  # without a sighting of the opponent


@dataclass(frozen=True, slots=True)
class PerceptionSummary:
    """Detections of all robots together."""

    camera: str  # name of the renderer of the colour images
    detection_rate: float | None  # of the images with the opponent in view
    false_detections: int  # that match no object


@dataclass(frozen=True, slots=True)
class CrowdSummary:
    """Encounter of one robot with people.

    It succeeds if it reaches its goal, or stands to the end without one, and
    is never in contact and does not fall. Collisions are in physics contacts
    of its body, which end the game; else the times at which its distance to
    a person falls below the sum of their radii.
    """

    people: int
    success: bool
    collisions: int
    intimate_s: float  # with a person nearer than 0.45 m
    personal_s: float  # with a person nearer than 1.2 m


@dataclass(frozen=True, slots=True)
class PlayerSummary:
    """Motion of one player."""

    path_m: float  # without the sway of a gait cycle
    radius_m: float | None  # of its circle in the last third, if it turns
    goal_at_s: float | None = None
    sight: SightSummary | None = None
    crowd: CrowdSummary | None = None


@dataclass(frozen=True, slots=True)
class PairSummary:
    """Approach of two players, at the recorded samples."""

    closest_m: float  # of their torsos
    closest_at_s: float
    captured_at_s: float | None  # first within 0.35 m, of opponents
    distance_m: float | None  # mean of the last third, of reference points
    angle_deg: float | None  # mean of the last third, between headings


@dataclass(frozen=True, slots=True)
class TheorySummary:
    """Theory of a duel: the forecast of its templates, and its circle.

    Two robots are expected to reach the "circle", to do so "later" than the
    duration, to be in "contact", or to reach "no circle".
    """

    expected: str | None = None
    words: str | None = None  # the forecast, or why there is no circle
    circle_since_s: float | None = None  # of the templates
    min_distance_m: float | None = None  # of the templates
    radius_m: float | None = None  # of the evader; None without a circle
    radius_pursuer_m: float | None = None
    distance_m: float | None = None
    relative_orientation_deg: float | None = None


@dataclass(frozen=True, slots=True)
class PlanningSummary:
    """Plans of all robots together."""

    steps: int  # begun
    replans: int  # maneuvers planned
    min_zmp_margin_m: float | None = None  # from the edge of the support
    median_us: float | None = None  # processor time of planning a maneuver
    p99_us: float | None = None


@dataclass(frozen=True, slots=True)
class SolverSummary:
    """Performance of the solver of the MPC."""

    solves: int
    infeasible: int
    median_us: float  # processor time
    p99_us: float


@dataclass(frozen=True, slots=True)
class WalkingSummary:
    """Walk of one robot, after its first three seconds.

    Speed and yaw rate are over whole gait cycles. Errors are in the frame of
    the support foot.
    """

    speed_m_s: float | None
    speed_ratio: float | None  # path length over the planned one
    yaw_rate_deg_s: float | None
    yaw_ratio: float | None  # turn over the planned one
    slip_per_step_m: float | None  # of the support foot, mean
    tilt_max_deg: float | None  # of the torso
    tracking: dict[str, float | None]  # RMS errors of CoM and ZMP
    estimation: dict[str, float | None]  # RMS errors of the estimates
    adapted_steps: int = 0  # by feedback, in the whole walk
    push_impulse_n_s: tuple[float, float] = (0.0, 0.0)  # all, in the world
    solver: SolverSummary | None = None


@dataclass(frozen=True, slots=True)
class StateChange:
    """Change of the state of a robot that is played."""

    time_s: float
    state: str
    reason: str


@dataclass(frozen=True, slots=True)
class PlaySummary:
    """Play at a robot."""

    walking_s: float  # in the walking state
    changes: tuple[StateChange, ...]


@dataclass(frozen=True, slots=True)
class Summary:
    """Summary of a game.

    Distance and angle are means of the last third, of a play of the last
    third of its walk, between opponents: each pursuer and evader, or without
    such any players; of several the nearest. The reference point of a robot
    is midway between its feet, that of a person on the axis of the trunk.
    """

    distance_m: float | None = None  # between the reference points
    relative_orientation_deg: float | None = None  # of two players
    min_distance_m: float | None = None  # between torsos; or of a sighting
    captured_at_s: float | None = None  # first within 0.35 m
    triggered_at_s: float | None = None  # when the evader began to evade
    triggered_at_distance_m: float | None = None  # of the reference points
    converged_at_s: float | None = None  # to the circle of theory
    real_time_factor: float | None = None  # simulated over computing time
    touched: list[str] = field(default_factory=list)  # if that ended it
    fallen: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    players: dict[str, PlayerSummary] = field(default_factory=dict)
    pairs: dict[str, PairSummary] = field(default_factory=dict)
    """Of each two players, by their names: "red - blue"."""
    theory: TheorySummary | None = None
    planning: PlanningSummary | None = None
    walking: WalkingSummary | None = None
    sight: PerceptionSummary | None = None
    play: PlaySummary | None = None
