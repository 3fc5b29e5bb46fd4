"""Games of a tournament: an evader against a pursuer, without physics."""

from dataclasses import dataclass, field, replace
from math import inf, isfinite, pi

import numpy as np

from ..arena import (
    OPEN_FLOOR,
    ObstacleSet,
    Room,
    RoomRecipe,
    draw_any_start,
    generate_room,
)
from ..core.poses import Array, Pose, rotate
from ..core.setting import check_settings, setting
from ..games.floor_world import PARTS
from ..games.game import Outcome
from ..games.run import Run
from ..games.strategy_games import StepGame, StrategyTrack, play_strategies
from ..robots.description import load_robot
from ..sim.outline_measurement import measure_outline
from ..strategies import Pursuit, load_strategy
from ..theory.unicycle.circles import find_circle
from ..theory.value.two_cars import pursuit_bound
from .tabulation import Record

EARLIEST_CAPTURE = 0.02  # with any heading capture ends no game, in [m]
ASIDE = "evasion(safety_radius=100)"  # beyond every distance of these games
CELLS = 64  # of the value table of the bound


@dataclass(frozen=True)
class PairingSettings:
    """Settings of one game of a tournament."""

    evader: str = "look-ahead"  # name of the evader
    pursuer: str = "pursuit"  # name of the pursuer
    seed: int = 0  # seed of the room and of the initial poses
    level: str = setting(
        "steps", "Level; a unicycle decides eight times", names=tuple(PARTS)
    )
    floor: str = setting(
        "room",
        "Floor: open without walls, with the starts of duels, or with any "
        "headings, where no game ends by capture",
        names=("room", "open", "any heading"),
    )
    room: RoomRecipe = field(default_factory=RoomRecipe)
    game: StepGame = field(default_factory=StepGame)

    def __post_init__(self) -> None:
        """Validate the settings."""
        check_settings(self)
        load_strategy(self.evader)
        load_strategy(self.pursuer)

    @property
    def rules(self) -> StepGame:
        """Rules of the game on its floor."""
        if self.floor == "any heading":
            return replace(self.game, capture=EARLIEST_CAPTURE)
        return self.game

    def arena(self) -> tuple[Room, tuple[Pose, Pose]]:
        """Return the room, and the initial poses of pursuer and evader."""
        if self.floor == "any heading":
            return OPEN_FLOOR, draw_any_start(self.seed)
        recipe = self.room
        if self.floor == "open":
            recipe = replace(recipe, width=None, depth=None)
        room = generate_room(recipe, self.seed)
        assert room.starts is not None
        return room, room.starts


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
    ``regret_m`` their difference.
    """
    track, game = play_track(settings), settings.rules
    outcome, closest = track.outcome, track.closest_distance
    bound = bound_of(track.pursuer[0], track.evader[0], game)
    reached = 0.0 if outcome is Outcome.TOUCHED else closest
    seconds = (len(track.distances) - 1) * game.period / PARTS[settings.level]
    clear, ways = track.clearances.min(), np.diff(track.evader, axis=0)
    return {
        "outcome": outcome.value,
        "survived_s": seconds,
        "closest_m": closest,
        "bound_m": bound,
        "clearance_m": float(clear) if isfinite(clear) else None,
        "walked_m": float(np.hypot(ways[:, 0], ways[:, 1]).sum()),
        "decision_s": track.decision,
        "longest_decision_s": track.longest_decision,
        "survived": outcome is Outcome.COMPLETED,
        "captured": outcome is Outcome.CAPTURED,
        "touched_obstacle": outcome is Outcome.TOUCHED,
        "of_bound": closest / bound,
        "reached_m": reached,
        "regret_m": bound - reached,
        "circle_m": circle_distance(game, settings.pursuer),
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
    strategy = load_strategy(pursuer)
    if not isinstance(strategy, Pursuit) or game.pursuer_speed_ratio != 1.0:
        return None
    ratio = strategy.gain
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
