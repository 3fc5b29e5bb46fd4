"""Settings of a game: equal settings repeat it exactly."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, fields, replace
from functools import cache
from math import pi
from typing import Any

from .. import arena
from ..arena import NO_OBSTACLES, ObstacleSet, Room, RoomRecipe, load_room
from ..core.constants import CAPTURE_DISTANCE
from ..core.entries import read_entries
from ..core.errors import ConfigurationError, check_within, shown
from ..core.player_identity import PlayerIdentity, Role
from ..core.poses import Pose
from ..core.ranges import RUNTIME, SEEDS, Range
from ..core.setting import NONE, check_settings, setting
from ..locomotion.control_settings import MapSettings
from ..planning import GaitSettings
from ..robots.description import load_robot
from ..sim.body_settings import BODIES, BodySettings
from ..sim.camera_settings import CameraSettings, LidarSettings, SceneSettings
from ..sim.physics_settings import PhysicsSettings
from ..sim.push import MOST_PUSHES, Push
from .player_settings import (
    EVADER,
    EVASION,
    MOST_PLAYERS,
    PLAYERS,
    PRESET,
    PURSUER,
    PURSUIT,
    USED_BY,
    WALKER,
    PlayerSettings,
    nested,
    settings_of,
    take_preset,
)

GAME_LEVELS = ("physics", "steps", "unicycle")
GAME_KINDS = {"game": None, "duel": PLAYERS, "walk": (WALKER,)}
MOST_ROBOTS = Range(0, 12, "1", "in physics", whole=True)
OF_ALL = (  # settings of players that a game may give for all
    *("robot", "gait", "control", "legs", "senses", "sight", "evasion"),
    *("person", "crowd"),
)
AT_MOST = "beyond, they never meet"
COUNT = Range(1, MOST_PLAYERS, "1", "players of a game", whole=True)
RECIPE = "recipe"  # entries of a random room


@dataclass(frozen=True, slots=True)
class StartSettings:
    """Initial poses; omitted values are drawn from the seed.

    Distance and offsets are those of a duel on an open floor, ``least`` too.
    """

    distance: float | None = setting(
        None,
        "Initial distance between the reference points of the players",
        Range(
            0.0,
            100.0,
            "m",
            "at ``least``, or they touch; farther, they never meet",
            also=(None,),
        ),
    )
    pursuer_offset: float | None = setting(
        None,
        "Heading of the pursuer relative to its line of sight to the evader "
        "{unit}, drawn up to a right angle to either side",
        Range(-pi, pi, "rad", "half a turn", also=(None,)),
    )
    evader_offset: float | None = setting(
        None,
        "Heading of the evader relative to its line of sight to the pursuer "
        "{unit}, drawn up to 30 degrees to either side",
        Range(-pi, pi, "rad", "half a turn", also=(None,)),
    )
    least: float = setting(
        0.4,
        "Smallest distance at which the robots cannot overlap",
        Range(0.0, 100.0, "m", AT_MOST),
    )
    near: float = setting(
        0.6,
        "Smallest initial distance that is drawn",
        Range(0.0, 100.0, "m", "between ``least`` and ``far``"),
    )
    far: float = setting(
        1.5,
        "Greatest initial distance that is drawn; in a game of many, from "
        "the origin of an open floor",
        Range(0.0, 100.0, "m", AT_MOST),
    )

    def __post_init__(self) -> None:
        """Validate ranges and the order of the distances."""
        error = ConfigurationError
        check_settings(self)
        check_within(self.far, self.least, 100.0, "far", "m", error)
        check_within(self.near, self.least, self.far, "near", "m", error)
        if self.distance is not None:
            low = self.least
            check_within(self.distance, low, 100.0, "distance", "m", error)


@dataclass(frozen=True, slots=True)
class GameSettings:
    """Settings of a game of any number of players."""

    game: str = setting(
        "game",
        "Kind of the game: a duel is compared with theory, a walk with its "
        "references",
        names=tuple(GAME_KINDS),
    )
    seed: int = setting(1, "Random seed", SEEDS)
    duration: float = setting(120.0, "Simulated time", RUNTIME)
    level: str = setting(
        "physics",
        "Level of the game: bodies in physics, templates that decide at "
        "steps, or unicycles that decide continuously",
        names=GAME_LEVELS,
    )
    capture: float = setting(
        CAPTURE_DISTANCE,
        "Distance between opponents that ends a game without bodies",
        Range(1e-6, 100.0, "m", AT_MOST),
    )
    start: StartSettings = setting(
        StartSettings(near=0.8, far=2.0), "Initial poses that are drawn"
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
    scene: SceneSettings = setting(
        SceneSettings(), "What the cameras of a duel see around the players"
    )
    map: MapSettings = setting(
        MapSettings(), "Map of the room that robots have", needs=("room", "")
    )
    cameras: CameraSettings = setting(
        CameraSettings(),
        "Cameras of players that sense by them",
        needs=("senses", "cameras"),
    )
    lidar: LidarSettings = setting(
        LidarSettings(),
        "Lidar of players that sense by one",
        needs=("senses", "lidar"),
    )
    pushes: tuple[Push, ...] = setting(
        (), "Pushes on the robots", count=(0, MOST_PUSHES)
    )
    players: tuple[PlayerSettings, ...] = setting(
        (), "The players", count=(0, MOST_PLAYERS)
    )

    def __post_init__(self) -> None:
        """Validate ranges, and that the players fit together."""
        check_settings(self)
        check_players(self.players)
        robots, names = self.robots, GAME_KINDS[self.game]
        bodies = {p.body for p in self.players}
        if names and (
            self.names != names
            or bodies - {"robot", "person"}
            or names[-1] not in robots
        ):
            raise ConfigurationError(
                f"game must be 'game' unless {' and '.join(names)} play, the "
                f"last one as a robot, got {self.game!r} of "
                f"{', '.join(f'{p.name} ({p.body})' for p in self.players)}"
            )
        if self.game == "walk" and self.level != "physics":
            raise ConfigurationError(
                f"level of a walk must be physics, got {self.level!r}"
            )
        if self.game == "walk" and (network := self.players[0].legs.network):
            raise ConfigurationError(
                "legs.network must be empty in a walk, which compares steps "
                f"with their plans, got {network!r}"
            )
        if self.level == "physics":
            MOST_ROBOTS.check(len(robots), "number of robots")
        if self.pushes and not robots:
            raise ConfigurationError("pushes need a robot, got none")
        for push in self.pushes:
            if push.player not in ("", *robots):
                raise ConfigurationError(
                    f"push player must be one of {', '.join(robots)}, got "
                    f"{push.player!r}"
                )
            if push.time >= self.duration:
                raise ConfigurationError(
                    "push time must be less than the duration, "
                    f"{self.duration:g} [s], got {push.time:g}"
                )
        if self.room and self.room.moving and self.level != "physics":
            raise ConfigurationError(
                "room.moving must be empty without physics, got "
                f"{len(self.room.moving)} moving boxes"
            )
        check_senses(self)
        tick, step = self.physics.tick, self.physics.time_step
        if tick < 0.5 * step or abs(tick / step - round(tick / step)) > 1e-9:
            raise ConfigurationError(
                "physics.tick must be a whole multiple of physics.time_step, "
                f"{step:g} [s], got {tick:g}"
            )

    def changed(self, **changes: Any) -> "GameSettings":
        """Return the game with other settings.

        They are those of the game; of all players that use them, like
        ``gait``; or a dictionary for one player, by its name.
        """
        return read_game(nested(changes), base=self) if changes else self

    def with_players(
        self, changes: Mapping[str, Mapping[str, Any]]
    ) -> "GameSettings":
        """Return the game with other settings of players, by their names."""
        players = tuple(
            replace(own, **changes.get(own.name, {})) for own in self.players
        )
        return replace(self, players=players)

    def started_at(self, poses: Iterable[Pose]) -> "GameSettings":
        """Return the game with initial poses of the players, in order."""
        starts = [{"start": tuple(map(float, pose))} for pose in poses]
        return self.with_players(dict(zip(self.names, starts, strict=True)))

    @property
    def knows_room(self) -> bool:
        """Whether there is a room, and robots know it."""
        return self.room is not None and self.map.source != "none"

    @property
    def solids(self) -> ObstacleSet:
        """Obstacles of the room, walls included."""
        if self.room is None or not self.room.solids:
            return NO_OBSTACLES
        return self.room.solid_set

    def player(self, name: str) -> PlayerSettings:
        """Return the settings of the player with a name."""
        return {p.name: p for p in self.players}[name]

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the players, in the order in which they act."""
        return tuple(p.name for p in self.players)

    @property
    def robots(self) -> tuple[str, ...]:
        """Names of the players that are robots."""
        return tuple(p.name for p in self.players if p.body == "robot")

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
    def pursuer(self) -> PlayerSettings:
        """The pursuer of a duel."""
        return self.player(PURSUER)

    @property
    def evader(self) -> PlayerSettings:
        """The evader of a duel."""
        return self.player(EVADER)

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
    def maps_room(self) -> bool:
        """Whether robots map the room with their cameras."""
        return self.room is not None and self.map.source == "seen"

    def resolved(self) -> "GameSettings":
        """Return the settings of the same game with nothing left open."""
        players = tuple(
            own.resolved(
                self.body,
                person=any(
                    p.body == "person" for p in self.sensed_opponents(own)
                ),
                walks=self.level == "physics",
            )
            for own in self.players
        )
        if any(own.shield.enabled for own in players):
            from .shields import with_contact

            opponents_of = self.sensed_opponents
            players = tuple(with_contact(p, opponents_of(p)) for p in players)
        return replace(self, players=players)

    @property
    def is_of_the_paper(self) -> bool:
        """Whether a duel has the paper's strategies, on an open floor."""
        pursuer, evader = map(self.resolved().player, PLAYERS)
        return (
            self.room is None
            and evader.strategy == EVASION
            and (pursuer.strategy == PURSUIT or not pursuer.decides)
        )


NOT_PLAYERS = {*OF_ALL, *(each.name for each in fields(GameSettings))}
"""Names that mean settings of a game where settings are named."""


def check_players(players: tuple[PlayerSettings, ...]) -> None:
    """Check that names are unique and that roles and targets fit."""
    if not players:
        raise ConfigurationError("players must be at least 1, got 0")
    names = [p.name for p in players]
    if len(set(names)) < len(names):
        raise ConfigurationError(
            f"player names must be unique, got {', '.join(names)}"
        )
    roles = {Role(p.role) for p in players}
    for role, needed in (
        (Role.PURSUER, {Role.EVADER}),
        (Role.EVADER, {Role.PURSUER, Role.BYSTANDER}),
    ):
        # Pursuers that are assigned to each other need no evader.
        alone = [p for p in players if p.role == role and not p.target]
        cyclic = len(alone) > 1 and {p.strategy for p in alone} == {"cyclic"}
        if alone and not roles & needed and not cyclic:
            wanted = " or ".join(sorted(needed))
            raise ConfigurationError(
                f"role {role} of {alone[0].name} needs an opponent: a player "
                f"of role {wanted}, or a target, got none"
            )
    for player in players:
        others = [name for name in names if name != player.name]
        if player.target and player.target not in others:
            raise ConfigurationError(
                f"{player.name}: target must be another player, one of "
                f"{', '.join(others)}, got {player.target!r}"
            )


def check_senses(settings: GameSettings) -> None:
    """Check that each robot can sense its opponents."""
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
        if own.legs.network and settings.room is not None:
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


def duel(**changes: Any) -> GameSettings:
    """Return the settings of a duel of a pursuer and an evader.

    Changes are differences from a default duel of two NAO, as in
    :meth:`GameSettings.changed`: ``duel(seed=2, evader="look-ahead")``.
    """
    return _default_duel().changed(**changes)


@cache
def _default_duel() -> GameSettings:
    players = tuple(PlayerSettings(name, name) for name in PLAYERS)
    return GameSettings("duel", start=StartSettings(), players=players)


def walk(
    bearing: float = 0.0, *, backward: bool = False, **changes: Any
) -> GameSettings:
    """Return the settings of a walk of one robot, the player ``walker``.

    The bearing is the desired heading in the frame of the support foot, in
    [rad]: 0 is straight ahead, others walk a circle. Changes are differences
    from a walk of NAO for 20 s, as in :meth:`GameSettings.changed`.
    """
    way = f"walk{'-backward' * backward}(bearing={bearing!r})"
    own = PlayerSettings(WALKER, strategy=way, start=(0.0, 0.0, 0.0))
    made = GameSettings("walk", duration=20.0, players=(own,))
    return made.changed(**changes)


STARTED_FROM = {"duel": duel, "walk": walk}  # what a file changes


def read_game(
    entries: Mapping[str, Any],
    source: str = "",
    *,
    base: GameSettings | None = None,
) -> GameSettings:
    """Turn nested entries into the settings of a game.

    Entries of ``[[players]]`` change what the robot of the player brings.
    Entries that only players have, like ``gait``, hold for all that use them
    and do not have their own, and a table named like a player changes this
    player; a text instead is its strategy. ``body`` may be the name of a
    preset, and ``room`` a room file or the seed of a room by ``recipe``.
    """
    left, before = dict(entries), source and f"{source}, "
    if base is None and entries.get("game") in STARTED_FROM:
        base = STARTED_FROM[entries["game"]]()
    own = {p.name: p for p in base.players} if base else {}
    tables = [(before + name, name, dict[str, Any]()) for name in own]
    if (listed := left.pop("players", None)) is not None:
        if not isinstance(listed, list):
            raise ConfigurationError(
                f"{before}players must be tables [[players]], got "
                f"{shown(listed)}"
            )
        tables = [
            (f"{before}player {number}, {each['name']}", each["name"], each)
            for number, entry in enumerate(listed, start=1)
            for each in _copies(entry, f"{before}player {number}")
        ]
    shared = {k: left.pop(k) for k in OF_ALL if k in left}
    changes = []
    for place, name, entry in tables:
        player = own.get(name) or PlayerSettings(name)
        given = {} if name in NOT_PLAYERS else left.pop(name, {})
        if isinstance(given, str):
            given = {PRESET: given}
        if not isinstance(given, Mapping):
            raise ConfigurationError(
                f"{before}{name} must be a table or the name of a strategy, "
                f"got {shown(given)}"
            )
        mine = nested(given, entry)
        if PRESET in mine:
            mine.setdefault("strategy", mine.pop(PRESET))
        used = USED_BY.get(mine.get("body", player.body), set(OF_ALL))
        common = {k: v for k, v in shared.items() if k in used}
        where = place if mine else source
        changes.append((where, player, nested(mine, common), mine))
    if base is not None:
        base = _with_distances(base, changes)
    made = tuple(_player(*each) for each in changes)
    if base is None:
        base = GameSettings(players=made)
    robots = [player.robot for player in made if player.body == "robot"]
    if preset := take_preset(left, "body", BODIES):
        from .robot_bodies import body_of_robot

        body = body_of_robot((robots or ["nao"])[0], preset)
        base = replace(base, body=body)
    _make_room(left)
    if made != base.players:
        left["players"] = made
    return read_entries(GameSettings, left, source, base=base)


def _copies(entry: Any, source: str) -> list[dict[str, Any]]:
    """Return an entry for each of ``count`` players alike, numbered."""
    if not isinstance(entry, dict) or type(entry.get("name")) is not str:
        raise ConfigurationError(
            f"{source} must be a table with a name, got {entry!r:.80}"
        )
    rest = dict(entry)
    if "count" not in rest:
        return [rest]
    count = rest.pop("count")
    COUNT.check(count, f"{source}: count")
    if count > 1 and "start" in rest:
        raise ConfigurationError(
            f"{source}: start must be omitted with count {count}, or all "
            "would start at one place"
        )
    return [
        rest | {"name": f"{rest['name']}-{number}"}
        for number in range(1, count + 1)
    ]


def _with_distances(base: GameSettings, changes: list[Any]) -> GameSettings:
    """Return a duel with the distances of the robots that entries name."""
    given = [entries.get("robot") for _, _, entries, _ in changes]
    if base.game != "duel" or not any(isinstance(x, str) for x in given):
        return base
    games = [
        load_robot(entries.get("robot", player.robot)).game
        for _, player, entries, _ in changes
        if entries.get("body", player.body) == "robot"
    ]
    radius = max(game.safety_radius for game in games)
    for at, (where, player, entries, mine) in enumerate(changes):
        if player.name == EVADER:
            own = {"evasion": {"safety_radius": radius}}
            changes[at] = where, player, nested(entries, own), mine
    start = replace(
        base.start,
        least=max(game.start_least for game in games),
        near=max(game.start_near for game in games),
        far=max(game.start_far for game in games),
    )
    return replace(base, start=start)


def _player(
    source: str,
    base: PlayerSettings,
    entries: Mapping[str, Any],
    mine: Mapping[str, Any],
) -> PlayerSettings:
    """Return the settings of one player; those of its own must have effect."""
    player: PlayerSettings = settings_of(
        PlayerSettings, entries, source, base=base
    )
    for key in mine.keys() - USED_BY[player.body]:
        if getattr(player, key) != getattr(base, key):
            raise ConfigurationError(
                f"{source}: {key} must be omitted with body {player.body!r}, "
                "as it has no effect"
            )
    return player


def _make_room(entries: dict[str, Any]) -> None:
    """Put a room in place of its file or its seed."""
    recipe, plan = entries.pop(RECIPE, None), entries.get("room")
    if recipe is not None and type(plan) is not int:
        got = "none" if plan is None else f"{plan}"
        raise ConfigurationError(
            f"{RECIPE} requires the seed of a random room as room, got {got}"
        )
    if type(plan) is int:
        own = read_entries(RoomRecipe, recipe or {})
        entries["room"] = arena.generate_room(own, plan)
    elif isinstance(plan, str) and plan != NONE:
        entries["room"] = load_room(plan)
