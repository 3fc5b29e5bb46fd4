"""Settings of a game of any number of players: equal settings repeat it."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import pi
from typing import ClassVar

from ..arena import Room
from ..core.brief_repr import brief_repr
from ..core.errors import ConfigurationError
from ..core.player_identity import PlayerIdentity, Role
from ..core.poses import Pose
from ..core.ranges import RUNTIME, SEEDS, Range, check_count
from ..core.setting import REQUIRED, check_settings, setting
from ..locomotion.control_settings import (
    ControlSettings,
    LegsSettings,
    MapSettings,
)
from ..planning import GaitSettings
from ..robots.description import load_robot
from ..sim.body_settings import BODIES, BodySettings
from ..sim.camera_settings import CameraSettings, LidarSettings
from ..sim.crowd_motion import RADIUS, CrowdSettings
from ..sim.person_settings import PersonSettings
from ..sim.physics_settings import PhysicsSettings, SightSettings
from ..sim.push import MOST_PUSHES, Push, check_pushes
from ..strategies import Evasion, Strategy
from ..strategies.registry import (
    OF_EVASION,
    check_strategy_name,
    describe_strategy,
)
from ..strategies.shield_settings import ShieldSettings
from .duel_settings import RobotSettings
from .implied_settings import (
    implied_control,
    implied_evader,
    implied_trigger,
)
from .player_names import MOST_PLAYERS, PLAYER_NAME

BODY_KINDS = ("robot", "unicycle", "person", "run")
GAME_LEVELS = ("physics", "steps", "unicycle")
SENSING = ("ideal", "cameras", "lidar")
MOST_ROBOTS = 12  # in physics
NAO_RADIUS = 0.14  # within which its body stands and sways, in [m]
POSITION = Range(-100.0, 100.0, "m", "the farthest initial distance")
TURN = Range(-2.0 * pi, 2.0 * pi, "rad", "a turn")


@dataclass(frozen=True, slots=True)
class PlayerSettings:
    """Settings of one player."""

    name: str = setting(
        REQUIRED, "Name of the player: lower case, digits and hyphens"
    )
    role: str = setting(
        "bystander", "Role of the player", names=tuple(r.value for r in Role)
    )
    team: str = setting("", "Team of the player; that of its role if empty")
    body: str = setting(
        "robot",
        "Body of the player: a robot; its template unicycle; a person; or "
        "the recorded motion of a player of a run",
        names=BODY_KINDS,
    )
    robot: str = setting(
        "nao", "Name of a robot, or folder of its description"
    )
    gait: GaitSettings = setting(
        GaitSettings(), "Gait of a robot or a unicycle"
    )
    control: ControlSettings = setting(
        ControlSettings(), "Walking control of a robot"
    )
    legs: LegsSettings = setting(
        LegsSettings(), "Learned legs of a robot", needs=("body", "robot")
    )
    strategy: str | Strategy = setting(
        "",
        "Strategy of a robot or a unicycle; if empty, it walks to its goal if "
        "it has one, steps aside for people if it evades on learned legs, and "
        "else plays that of the paper for its role; a bystander stands",
    )
    evasion: Evasion = setting(
        Evasion(), "Settings of the paper's evasion strategy"
    )
    shield: ShieldSettings = setting(
        ShieldSettings(), "Shield of the player", needs=("shield.enabled", "")
    )
    target: str = setting(
        "",
        "Name of the player that it plays against; the nearest opponent if "
        "empty",
    )
    start: tuple[float, ...] = setting(
        (),
        "Initial position (x, y) [m] and heading [rad] in the world; drawn "
        "from the seed if empty",
    )
    goal: tuple[float, ...] = setting(
        (), "Position (x, y) in the world that the player walks to [m]"
    )
    draws_goal: bool = setting(
        False,
        "Draw the goal from the seed, at least a third of the longer side "
        "of the room away from the start",
    )
    senses: str = setting(
        "ideal",
        "Sensing of other players by a robot: true poses (ideal), or "
        "detection in simulated camera images, or of people in the scans of "
        "a simulated lidar",
        names=SENSING,
    )
    sight: SightSettings = setting(SightSettings(), "Errors of ideal sensing")
    person: PersonSettings = setting(
        PersonSettings(),
        "Motion of a person without a goal",
        needs=("body", "person"),
    )
    crowd: CrowdSettings = setting(
        CrowdSettings(),
        "Motion of a person with a goal",
        needs=("body", "person"),
    )
    run: str = setting(
        "", "Run folder of a replayed player", needs=("body", "run")
    )
    run_player: str = setting(
        "", "Name of the player in that run", needs=("body", "run")
    )

    def __post_init__(self) -> None:
        """Validate ranges, name and combinations of settings."""
        if not isinstance(self.name, str) or not PLAYER_NAME.fullmatch(
            self.name
        ):
            raise ConfigurationError(
                "player name must be lower case letters, digits and hyphens, "
                f"at most 32, got {self.name!r:.40}"
            )
        if not isinstance(self.strategy, str):
            self.named()  # validates the copy that holds its name
            return
        prefix = f"{self.name}: "
        check_settings(self, prefix=prefix)
        if self.strategy:
            check_strategy_name(
                self.strategy, f"{prefix}strategy", recorded=True
            )
        for name, counts in (("start", (0, 3)), ("goal", (0, 2))):
            values = getattr(self, name)
            if len(values) not in counts:
                raise ConfigurationError(
                    f"{prefix}{name} must have {counts[1]} numbers, got "
                    f"{len(values)}"
                )
            for value, allowed in zip(
                values, (POSITION, POSITION, TURN), strict=False
            ):
                allowed.check(value, f"{prefix}{name}")
        if (self.body == "run") != bool(self.run):
            raise ConfigurationError(
                f"{prefix}run must be a run folder with body 'run' only, got "
                f"{self.run!r} with body {self.body!r}"
            )

    @property
    def identity(self) -> PlayerIdentity:
        """Name, role and team."""
        return PlayerIdentity(
            self.name, Role(self.role), self.team or self.role
        )

    def named(self) -> "PlayerSettings":
        """Return the settings with a text for a strategy object."""
        return replace(self, strategy=describe_strategy(self.strategy))

    @property
    def pose(self) -> Pose | None:
        """Initial pose in the world; None if it is drawn."""
        return Pose(*self.start) if self.start else None

    @property
    def radius(self) -> float:
        """Radius of the body among people, in [m].

        That of a robot is NAO's, relative to the heights of their CoM.
        """
        if self.body == "person":
            return RADIUS
        return NAO_RADIUS * load_robot(self.robot).game.get("length_unit", 1.0)

    @property
    def decides(self) -> bool:
        """Whether it has a strategy: a robot or a unicycle."""
        return self.body in ("robot", "unicycle")


@dataclass(frozen=True, slots=True)
class GameSettings:
    """Settings of a game of any number of players."""

    game: ClassVar[str] = "game"
    __repr__ = brief_repr

    seed: int = setting(
        1,
        "Random seed",
        SEEDS,
    )
    duration: float = setting(
        120.0,
        "Simulated time",
        RUNTIME,
    )
    level: str = setting(
        "physics",
        "Level of the game: bodies in physics, templates that decide at "
        "steps, or unicycles that decide continuously",
        names=GAME_LEVELS,
    )
    players: tuple[PlayerSettings, ...] = setting((), "The players")
    near: float = setting(
        0.8,
        "Smallest distance between two initial positions that are drawn",
        Range(0.0, 100.0, "m", "beyond, they never meet"),
    )
    far: float = setting(
        2.0,
        "Greatest distance from the origin of a position that is drawn on "
        "an open floor",
        Range(0.0, 100.0, "m", "beyond, they never meet"),
    )
    physics: PhysicsSettings = setting(
        PhysicsSettings(), "Physics, floor and clock"
    )
    body: BodySettings = setting(
        BodySettings(),
        "Deviations of the bodies from ideal ones",
        presets=BODIES,
    )
    room: Room | None = setting(
        None, "Room in which the game is played; an open floor without"
    )
    map: MapSettings = setting(
        MapSettings(), "Map of the room that robots have", needs=("room", "")
    )
    cameras: CameraSettings = setting(
        CameraSettings(), "Cameras of players that sense by them"
    )
    lidar: LidarSettings = setting(
        LidarSettings(), "Lidar of players that sense by one"
    )
    pushes: tuple[Push, ...] = setting((), "Pushes on the robots")

    def __post_init__(self) -> None:
        """Validate ranges, and that the players fit together."""
        check_settings(self)
        check_count(self.players, MOST_PLAYERS, "players")
        check_players(self.players)
        robots = self.robots
        if self.level == "physics":
            check_count(robots, MOST_ROBOTS, "robots in physics")
        check_count(self.pushes, MOST_PUSHES, "pushes")
        if self.pushes and not robots:
            raise ConfigurationError("pushes need a robot, got none")
        check_pushes(self.pushes, robots)
        check_senses(self)

    @property
    def knows_room(self) -> bool:
        """Whether there is a room, and robots know it."""
        return self.room is not None and self.map.source != "none"

    def player(self, name: str) -> PlayerSettings:
        """Return the settings of the player with a name."""
        return {p.name: p for p in self.players}[name]

    def people_around(self, own: PlayerSettings) -> dict[str, bool]:
        """Return all people by name, and whether they walk with a player.

        People who share a named team walk as a group.
        """
        return {
            p.name: p.team == own.team != "" and p is not own
            for p in self.players
            if p.body == "person"
        }

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the players, in the order in which they act."""
        return tuple(p.name for p in self.players)

    @property
    def robots(self) -> tuple[str, ...]:
        """Names of the players that are robots."""
        return tuple(p.name for p in self.players if p.body == "robot")

    def robot_of(self, player: str) -> RobotSettings:
        """Return robot, gait, control and legs of a player."""
        own = self.player(player)
        return RobotSettings(own.robot, own.gait, own.control, own.legs)

    @property
    def gait(self) -> GaitSettings:
        """Gait of the slowest stepping robot or unicycle."""
        gaits = [p.gait for p in self.players if p.decides]
        return max(
            gaits or [GaitSettings()], key=lambda gait: gait.step_duration
        )

    @property
    def cycle(self) -> float:
        """Duration of a gait cycle, two steps of the slowest, in [s]."""
        return 2.0 * self.gait.step_duration

    @property
    def identities(self) -> dict[str, PlayerIdentity]:
        """Identity of each player, by name."""
        return {p.name: p.identity for p in self.players}

    def opponents_of(self, name: str) -> tuple[str, ...]:
        """Return the names of the players of the opposing role."""
        own = self.player(name).identity
        return tuple(p.name for p in self.players if own.opposes(p.identity))

    def sensing_by(self, senses: str) -> tuple[PlayerSettings, ...]:
        """Return the robots with a kind of sensing."""
        return tuple(
            p for p in self.players if p.body == "robot" and p.senses == senses
        )

    def sensed_opponents(self, own: PlayerSettings) -> list[PlayerSettings]:
        """Return the players that the sensors of a robot look for.

        They are its target, or all players of the opposing role.
        """
        names = [own.target] if own.target else [*self.opponents_of(own.name)]
        return [self.player(name) for name in names]

    @property
    def safety_radii(self) -> dict[str, float]:
        """Safety radius of each player that has one, in [m], by name.

        They belong to the paper's evasion strategy and its variants.
        """
        return {
            p.name: p.evasion.area
            for p in self.resolved().players
            if p.decides and p.strategy in OF_EVASION
        }

    @property
    def maps_room(self) -> bool:
        """Whether robots map the room with their cameras."""
        return self.room is not None and self.map.source == "seen"

    def resolved(self) -> "GameSettings":
        """Return the settings of the same game with nothing left open."""
        return replace(self, players=tuple(map(self._resolved, self.players)))

    def _resolved(self, own: PlayerSettings) -> PlayerSettings:
        """Return a player with strategy, trigger and control."""
        if not own.decides:
            return own
        person = any(p.body == "person" for p in self.sensed_opponents(own))
        strategy, evasion = own.strategy, own.evasion
        if not strategy and (own.goal or own.draws_goal):
            strategy = "goal"
        elif not strategy and own.role == "evader":
            legs = own.legs if self.level == "physics" else LegsSettings()
            strategy = implied_evader(legs, person=person)
        elif not strategy:
            strategy = "pursuit" if own.role == "pursuer" else "stand"
        if strategy in OF_EVASION:
            evasion = implied_trigger(evasion, own.gait, person=person)
        return replace(
            own,
            strategy=strategy,
            evasion=evasion,
            control=implied_control(own.control, own.gait, self.body),
        )

    def named(self) -> "GameSettings":
        """Return the settings with a text for each strategy object."""
        return replace(self, players=tuple(p.named() for p in self.players))

    def with_places(
        self,
        poses: Mapping[str, Pose],
        goals: Mapping[str, tuple[float, ...]],
    ) -> "GameSettings":
        """Return the settings with starts and goals filled in.

        Args:
            poses: Initial pose of each player, by name.
            goals: Goals of the players that have one, by name, in [m].
        """
        players = tuple(
            replace(
                p,
                start=tuple(map(float, poses[p.name])),
                goal=goals.get(p.name, p.goal),
            )
            for p in self.players
        )
        return replace(self, players=players)


def check_players(players: tuple[PlayerSettings, ...]) -> None:
    """Check that names are unique and that roles and targets fit.

    Raises:
        ConfigurationError: If there is no player, two have one name, a role
            has no opponent, or a target does not exist.
    """
    if not players:
        raise ConfigurationError("players must be at least 1, got 0")
    names = [p.name for p in players]
    twice = next((n for n in names if names.count(n) > 1), None)
    if twice is not None:
        raise ConfigurationError(
            f"player names must be unique, got {twice!r} "
            f"{names.count(twice)} times"
        )
    roles = {Role(p.role) for p in players}
    for role, needed in (
        (Role.PURSUER, {Role.EVADER}),
        (Role.EVADER, {Role.PURSUER, Role.BYSTANDER}),
    ):
        # Pursuers that are assigned to each other need no evader.
        alone = [p for p in players if p.role == role and not p.target]
        if alone and not roles & needed and not _is_cyclic(alone):
            wanted = " or ".join(sorted(needed))
            raise ConfigurationError(
                f"role {role} of {alone[0].name} needs an opponent: a player "
                f"of role {wanted}, or a target, got none"
            )
    for player in players:
        if player.target and player.target not in names:
            raise ConfigurationError(
                f"{player.name}: target must be a player, one of "
                f"{', '.join(names)}, got {player.target!r}"
            )
        if player.target == player.name:
            raise ConfigurationError(
                f"{player.name}: target must be another player, got itself"
            )


def _is_cyclic(players: list[PlayerSettings]) -> bool:
    """Return whether all of several players pursue the next of their team."""
    return len(players) > 1 and all(p.strategy == "cyclic" for p in players)


def check_senses(settings: GameSettings) -> None:
    """Check that each robot can sense its opponents.

    Raises:
        ConfigurationError: If cameras or lidars cannot tell the opponents,
            or the room cannot be mapped.
    """
    seeing = settings.sensing_by("cameras")
    other = next((p for p in settings.players if p.senses != "ideal"), None)
    if settings.level != "physics" and other is not None:
        raise ConfigurationError(
            f"{other.name}: senses must be ideal at level {settings.level!r}, "
            f"got {other.senses!r}"
        )
    for own in seeing:
        sensed = settings.sensed_opponents(own)
        if {p.body for p in sensed} not in ({"robot"}, {"person"}):
            listed = ", ".join(f"{p.name} ({p.body})" for p in sensed)
            raise ConfigurationError(
                f"{own.name}: senses must be ideal unless all its opponents "
                "are robots, or all are people, got 'cameras' and opponents "
                f"{listed or 'none'}"
            )
        if sensed[0].body == "robot" and sensed[0].role == "bystander":
            raise ConfigurationError(
                f"{own.name}: target must be a pursuer or an evader with "
                "senses 'cameras', which know the colours of these roles, "
                f"got {sensed[0].name!r}"
            )
        if len(settings.robots) > 2 and sensed[0].body == "robot":
            raise ConfigurationError(
                f"{own.name}: senses must be ideal in a game of more than two "
                "robots, as cameras do not tell robots of one role apart, got "
                "'cameras'"
            )
        if own.legs.walks and settings.room is not None:
            raise ConfigurationError(
                f"{own.name}: legs.network must be empty in rooms with camera "
                f"sensing, got {own.legs.network!r}"
            )
    models = {own.robot for own in seeing}
    if len(models) > 1:
        raise ConfigurationError(
            "senses must be ideal for different robots, got 'cameras' for "
            f"{', '.join(sorted(models))}"
        )
    for own in settings.sensing_by("lidar"):
        if any(p.body != "person" for p in settings.sensed_opponents(own)):
            raise ConfigurationError(
                f"{own.name}: senses must be ideal or cameras with a robot as "
                "opponent, got 'lidar': a lidar detects people"
            )
    if settings.maps_room and (
        len(seeing) < len(settings.robots)
        or any(p.body == "person" for p in settings.players)
    ):
        raise ConfigurationError(
            "map.source must be given or none unless all robots sense by "
            "cameras and there are no people, got 'seen'"
        )
