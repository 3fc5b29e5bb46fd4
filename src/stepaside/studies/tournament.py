"""Games of a tournament: an evader against a pursuer, on any level."""

from dataclasses import dataclass, field, replace
from math import inf, isfinite, pi, radians

import numpy as np

from ..arena import (
    ObstacleSet,
    Room,
    RoomRecipe,
    draw_any_start,
    draw_initial_poses,
    generate_room,
    load_room,
)
from ..core.convex import grown_hull_area
from ..core.errors import ConfigurationError, check_choice
from ..core.poses import Array, Pose, rotate, wrap_angles
from ..games.floor_games import StrategyTrack, play_strategies
from ..games.floor_world import PARTS
from ..games.game_settings import duel
from ..games.outcome import Outcome
from ..games.player_settings import PLAYERS
from ..games.recorded_game import run_game
from ..games.run import Run
from ..games.summary import PlanningSummary
from ..locomotion.control_settings import MapSettings
from ..robots.description import load_robot
from ..sim.outline_measurement import measure_outline
from ..strategies import Evasion, Pursuit, load_strategy
from ..strategies.registry import file_of
from ..strategies.strategy_game import StepGame
from ..strategies.table_cache import pursuit_bound
from ..theory.unicycle.circles import find_circle
from .tabulation import Record

HUMANOIDS = "physics"
CHOICES = {
    "level": ("steps", "unicycle", HUMANOIDS),
    "floor": ("room", "open", "any heading"),
    "map": ("given", "seen", "none"),
}
EARLIEST_CAPTURE = 0.02  # with any heading capture ends no game, in [m]
SIGHT = radians(148.0)  # greatest bearing in view of a turned head, in [rad]
ASIDE = "evasion(safety_radius=100)"  # beyond every distance of these games
CELLS = 64  # of the value table of the bound


@dataclass(frozen=True)
class PairingSettings:
    """Settings of one game of a tournament."""

    evader: str = "look-ahead"  # name of the evader
    pursuer: str = "pursuit"  # name of the pursuer
    seed: int = 0  # seed of the room and of the initial poses
    # "steps"; "unicycle", with eight decisions per step; or "physics", with
    # simulated humanoids
    level: str = "steps"
    # "room"; "open" without walls, with the starts of duels; or "any heading",
    # open with any headings, where no game ends by capture
    floor: str = "room"
    room: RoomRecipe = field(default_factory=RoomRecipe)
    room_file: str = ""  # file of a room that all games share, instead
    game: StepGame = field(default_factory=StepGame)  # physics: duration
    map: str = "given"  # map of the humanoids: "given", "seen" or "none"

    def __post_init__(self) -> None:
        """Validate the settings."""
        for name, known in CHOICES.items():
            check_choice(getattr(self, name), known, name)
        load_strategy(self.evader)
        load_strategy(self.pursuer)
        if self.level == HUMANOIDS:
            ratio = self.game.pursuer_speed_ratio
            if ratio != 1.0:
                raise ConfigurationError(
                    "game.pursuer_speed_ratio must be 1 [1] at level "
                    f"{HUMANOIDS}, got {ratio}"
                )
        elif self.map != "given":
            raise ConfigurationError(
                f"map must be 'given' at level {self.level}, got {self.map!r}"
            )

    @property
    def rules(self) -> StepGame:
        """Rules of the game on its floor."""
        if self.floor == "any heading":
            return replace(self.game, capture=EARLIEST_CAPTURE)
        return self.game

    def arena(self) -> tuple[Room, tuple[Pose, Pose]]:
        """Return the room, and the initial poses of pursuer and evader.

        Raises:
            ConfigurationError: If a room with moving boxes is not played in
                by humanoids.
        """
        recipe = self.room
        if self.room_file:
            room = load_room(self.room_file)
            if room.moving and self.level != HUMANOIDS:
                raise ConfigurationError(
                    f"level must be {HUMANOIDS!r} in a room with moving "
                    f"boxes, got {self.level!r}"
                )
        elif self.floor == "any heading":
            room = Room(starts=draw_any_start(self.seed))
        else:
            if self.floor == "open":
                recipe = replace(recipe, width=None, depth=None)
            room = generate_room(recipe, self.seed)
        return room, room.starts or draw_initial_poses(room, self.seed)


def play_track(settings: PairingSettings) -> StrategyTrack:
    """Play one game at level "steps" or "unicycle"; return its track."""
    evader, pursuer = map(load_strategy, (settings.evader, settings.pursuer))
    room, starts = settings.arena()
    game = replace(settings.rules, decisions=PARTS[settings.level])
    return play_strategies(pursuer, evader, starts, room=room, game=game)


def play_pairing(settings: PairingSettings) -> Record:
    """Play one game of a tournament and return its record.

    Values in SI units: ``survived_s`` ends with capture or contact,
    ``bound_m`` is the closest approach under optimal play on an open floor,
    ``reached_m`` the closest approach, 0 after contact with an obstacle, and
    ``regret_m`` their difference. Of humanoids ``touched`` names the bodies in
    contact, ``PLAYER_clearance_m`` is the least distance of a trunk from
    resting obstacles, and ``decision_s`` the time of a whole replan.
    """
    humanoids = settings.level == HUMANOIDS
    found = (_humanoid_values if humanoids else _step_values)(settings)
    outcome, closest = found["outcome"], found["closest_m"]
    reached = 0.0 if outcome == "touched" else closest
    return {
        "evader": settings.evader,
        "pursuer": settings.pursuer,
        "seed": settings.seed,
        **found,
        "survived": outcome == "completed",
        "captured": outcome == "captured",
        "touched_obstacle": outcome == "touched",
        "of_bound": closest / found["bound_m"],
        "reached_m": reached,
        "regret_m": found["bound_m"] - reached,
        "circle_m": circle_distance(settings.rules, settings.pursuer),
    }


def _step_values(settings: PairingSettings) -> Record:
    """Play a game at level "steps" or "unicycle" and return its values."""
    track, game = play_track(settings), settings.rules
    seconds = (len(track.distances) - 1) * game.period / PARTS[settings.level]
    clear = float(track.clearances.min())
    return {
        "outcome": track.outcome.value,
        "survived_s": seconds,
        "closest_m": float(track.distances.min()),
        "bound_m": bound_of(track.pursuer[0], track.evader[0], game),
        "clearance_m": clear if isfinite(clear) else None,
        **_motion(track.evader, track.bearings, seconds, game.body_radius),
        "decision_s": track.decision,
        "longest_decision_s": track.longest_decision,
    }


def _humanoid_values(settings: PairingSettings) -> Record:
    """Play a game in physics and return its values."""
    room, starts = settings.arena()
    played = load_strategy(settings.evader)
    paper = played if isinstance(played, Evasion) else None
    run = run_game(
        duel(
            seed=settings.seed,
            duration=settings.game.duration,
            evasion=paper or Evasion(),
            evader={"strategy": "evasion" if paper else settings.evader},
            pursuer={"strategy": settings.pursuer},
            senses="cameras" if settings.map == "seen" else "ideal",
            room=replace(room, starts=starts),
            map=MapSettings(source=settings.map),
        )
    )
    summary = run.uninterrupted().summary
    planning = summary.planning or PlanningSummary(0, 0)
    pursuer, evader = (run.tracks[name].unicycle for name in PLAYERS)
    aims = pursuer[:, :2] - evader[:, :2]
    bearings = np.arctan2(aims[:, 1], aims[:, 0]) - evader[:, 2]
    captured = summary.captured_at_s
    radius, seconds = settings.game.body_radius, run.duration
    return {
        "outcome": outcome_of(run).value,
        "contact": players_touched(run),
        "touched": list(summary.touched),
        "survived_s": seconds if captured is None else captured,
        "closest_m": summary.min_distance_m,
        "bound_m": bound_of(pursuer[0], evader[0], settings.game),
        **_motion(evader, wrap_angles(bearings), seconds, radius),
        "decision_s": 1e-6 * (planning.median_us or 0.0),
        "longest_decision_s": 1e-6 * (planning.p99_us or 0.0),
        **{f"{name}_clearance_m": clearance(run, name) for name in PLAYERS},
    }


def _motion(
    evader: Array, bearings: Array, seconds: float, radius: float
) -> Record:
    """Return the values of an evader's motion.

    Its poses (n, 3), bearings of the pursuer from it [rad], duration [s] and
    radius [m].
    """
    turns = np.abs(wrap_angles(np.diff(evader[:, 2])))
    walked = np.hypot(*np.diff(evader[:, :2], axis=0).T)
    return {
        "floor_m2": grown_hull_area(evader[:, :2], radius),
        "walked_m": float(walked.sum()),
        "turning_rad_s": float(turns.sum()) / max(seconds, 1e-9),
        "unseen": float((np.abs(bearings) > SIGHT).mean()),
    }


def bound_of(pursuer: Array, evader: Array, game: StepGame) -> float:
    """Return the closest approach under optimal play on an open floor, [m]."""
    unit, heading = game.speed / game.gain, pursuer[2]
    x, y = (evader[:2] - pursuer[:2]) / unit
    x, y = rotate(x, y, -heading)
    # The evader walks backwards.
    value = pursuit_bound(CELLS).value((x, y, evader[2] + pi - heading))
    return unit * float(value)


def circle_distance(game: StepGame, pursuer: str) -> float | None:
    """Return the distance on the paper's circle for a pursuer, in [m].

    The evader moves aside, with the gain of the game. None for a pursuer that
    does not steer by eq. (2), or of another speed.
    """
    if file_of(pursuer) is not None or game.pursuer_speed_ratio != 1.0:
        return None
    strategy = load_strategy(pursuer)
    ratio = getattr(strategy, "gain", inf)
    if ratio == inf or strategy != Pursuit(gain=ratio):
        return None
    circle = find_circle(
        game.speed,
        game.speed,
        ratio * game.gain,
        game.gain,
        0.5 * pi,
        "proportional",
    )
    return float(circle.distance_m) if circle.exists else None


def players_touched(run: Run) -> bool:
    """Return whether a duel ended with contact between its two players."""
    contact = run.outcome is Outcome.CONTACT
    return contact and set(run.summary.touched) == set(PLAYERS)


def outcome_of(run: Run) -> Outcome:
    """Return the outcome of a duel as that of a tournament game.

    It is captured if the distance was at most the capture distance at any
    time; a contact with an obstacle is told apart from one of the players.
    """
    if run.summary.captured_at_s is not None:
        return Outcome.CAPTURED
    if run.outcome is Outcome.CONTACT and not players_touched(run):
        return Outcome.TOUCHED
    return run.outcome


def clearance(run: Run, name: str) -> float | None:
    """Return the least distance of a trunk from resting obstacles, in [m]."""
    settings, track = run.settings, run.tracks[name]
    if settings.room is None:
        return None
    solids = ObstacleSet(settings.room.solids)
    own = settings.player(name)
    trunk = measure_outline(load_robot(own.robot), own.gait).trunk
    corners = [
        Pose(x, y, heading).transform_points(trunk)
        for (x, y), heading in zip(
            track.com[:, :2].tolist(), track.torso[:, 2].tolist(), strict=True
        )
    ]
    found = float(solids.swept_clearances(np.array(corners)).min())
    return found if isfinite(found) else None
