"""Summary of a game of any number of players."""

from dataclasses import dataclass, field

from .duel_summary import PlanTimes


@dataclass(frozen=True, slots=True)
class PlayerResult:
    """Summary of one player of a game.

    Attributes:
        name: Name of the player.
        role: Its role.
        team: Its team.
        body: Kind of its body.
        path_m: Length of its path, without the sway of a gait cycle, in [m].
        radius_m: Radius of the circle fitted to its reference point in the
            last third, in [m].
        moved_at_s: Time at which it had first moved by 2 cm, in [s].
        fell: Whether it fell.
        touched: Whether its body was in contact with another or an obstacle.
        goal_at_s: Time at which it reached its goal, in [s].
        closest_m: Closest approach of any other player, in [m].
    """

    name: str
    role: str
    team: str
    body: str
    path_m: float
    radius_m: float | None = None
    moved_at_s: float | None = None
    fell: bool = False
    touched: bool = False
    goal_at_s: float | None = None
    closest_m: float | None = None


@dataclass(frozen=True, slots=True)
class PairResult:
    """Summary of two players of a game, at the recorded samples.

    Attributes:
        players: Their names.
        closest_m: Closest approach of their torsos, in [m].
        closest_at_s: Its time, in [s].
        captured_at_s: Time at which the distance first was at most the
            capture distance, in [s], if they are opponents.
        distance_m: Mean distance between the reference points in the last
            third, in [m].
        angle_deg: Mean angle between their headings then, in [deg].
    """

    players: list[str]
    closest_m: float
    closest_at_s: float
    captured_at_s: float | None
    distance_m: float
    angle_deg: float


@dataclass(frozen=True, slots=True)
class CrowdResult:
    """Encounter of one robot with people.

    Attributes:
        name: Name of the robot.
        people: Number of people.
        success: Whether it reached its goal, or stood to the end without
            one, and was never in contact and did not fall.
        collisions: In physics, contacts of its body, which end the game.
            Else the times at which its distance to a person fell below the
            sum of their radii.
        time_s: Time to the goal, in [s]; None without a goal or if it was
            not reached.
        below_0_45_m_s: Time with a person nearer than 0.45 m, in [s].
        below_1_2_m_s: Time with a person nearer than 1.2 m, in [s].
    """

    name: str
    people: int
    success: bool
    collisions: int
    time_s: float | None
    below_0_45_m_s: float
    below_1_2_m_s: float


@dataclass(frozen=True, slots=True)
class GameSummary:
    """Summary of a game of any number of players.

    Attributes:
        seed: Seed of every random draw.
        level: Level of the game.
        results: Summary of each player.
        pairs: Summary of each pair of players.
        crowd: Encounter of each robot with people, if there are people.
        replans: Maneuvers planned by all robots.
        max_com_velocity_jump_m_s: Greatest jump of the velocity of a CoM
            reference at a replan, in [m/s].
        min_zmp_margin_m: Smallest distance of a ZMP reference from the edge
            of its support polygon, in [m]; None if no robot walked by plans.
        plan_time_us: Processor time of planning.
        real_time_factor: Simulated time over computing time.
        touched: Names of the bodies in contact, if contact ended the game.
        fallen: Names of the players that fell.
    """

    seed: int
    level: str
    results: list[PlayerResult]
    pairs: list[PairResult]
    crowd: list[CrowdResult]
    replans: int
    max_com_velocity_jump_m_s: float
    min_zmp_margin_m: float | None
    plan_time_us: PlanTimes
    real_time_factor: float
    touched: list[str] = field(default_factory=list)
    fallen: list[str] = field(default_factory=list)

    @property
    def players(self) -> int:
        """Number of players."""
        return len(self.results)

    @property
    def closest_m(self) -> float | None:
        """Closest approach of any pair, in [m]; None with one player."""
        return min((pair.closest_m for pair in self.pairs), default=None)

    @property
    def captured_at_s(self) -> float | None:
        """Time of the first capture of a pair, in [s]; None without one."""
        times = (pair.captured_at_s for pair in self.pairs)
        return min((time for time in times if time is not None), default=None)

    @property
    def mean_path_m(self) -> float:
        """Mean length of the paths of all players, in [m]."""
        return sum(each.path_m for each in self.results) / len(self.results)
