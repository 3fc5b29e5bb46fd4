"""Games of a tournament: an evader against a pursuer, without physics."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import inf, isfinite, pi
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from ..arena import (
    OPEN_FLOOR,
    ObstacleSet,
    Room,
    RoomRecipe,
    draw_any_start,
    generate_room,
)
from ..core.errors import ConfigurationError
from ..core.poses import Array, Pose, rotate
from ..core.setting import check_settings, setting
from ..games.floor_games import floor_of, play_floor, rules_of
from ..games.floor_world import FloorRecorder, FloorWalk
from ..games.game import GameInPlay, Outcome
from ..games.game_settings import GameSettings, duel
from ..games.player_settings import PLAYERS, PURSUIT
from ..games.run import Run
from ..planning import GaitSettings
from ..robots.description import load_robot
from ..sim.outline_measurement import measure_outline
from ..strategies import Pursuit, Strategy, load_strategy
from ..theory.unicycle.circles import find_circle
from ..theory.value.two_cars import pursuit_bound
from .tabulation import Record

EARLIEST_CAPTURE = 0.02  # with any heading capture ends no game, in [m]
ASIDE = "evasion(safety_radius=100)"  # beyond every distance of these games
CELLS = 64  # of the value table of the bound


@dataclass(frozen=True)
class PairingSettings:
    """Settings of one game of a tournament, and its floor."""

    game: GameSettings  # its seed is that of the room and the initial poses
    floor: str = setting(
        "room",
        "Floor: open without walls, with the starts of duels, or with any "
        "headings, where no game ends by capture",
        names=("room", "open", "any heading"),
    )
    room: RoomRecipe = field(default_factory=RoomRecipe)

    def __post_init__(self) -> None:
        """Validate the settings."""
        check_settings(self)
        if self.game.level == "physics":
            raise ConfigurationError(
                "level must be steps or unicycle in a tournament, got physics"
            )
        for name in PLAYERS:
            load_strategy(self.game.player(name).strategy)

    def arena(self) -> tuple[Room, tuple[Pose, Pose]]:
        """Return the room, and the initial poses of pursuer and evader."""
        seed = self.game.seed
        if self.floor == "any heading":
            return OPEN_FLOOR, draw_any_start(seed)
        recipe = self.room
        if self.floor == "open":
            recipe = replace(recipe, width=None, depth=None)
        room = generate_room(recipe, seed)
        assert room.starts is not None
        return room, room.starts

    @property
    def played(self) -> GameSettings:
        """The game on its floor, from its initial poses."""
        room, starts = self.arena()
        capture = self.game.capture
        if self.floor == "any heading":
            capture = EARLIEST_CAPTURE
        game = replace(self.game, room=room, capture=capture)
        return game.started_at(starts)


class StrategyTrack(NamedTuple):
    """Recorded game of pursuer and evader, one pose at each decision."""

    outcome: Outcome  # of the game
    times: Array  # of the poses, from the start on [s]. (n,)
    pursuer: Array  # poses x [m], y [m], theta [rad]. (n, 3)
    evader: Array  # likewise. (n, 3)
    clearances: Array  # of the evader's centre [m]. (n,)
    # mean processor time of a decision of the evader, without the first one,
    # which loads code [s]
    decision: float
    longest_decision: float  # likewise

    @property
    def distances(self) -> Array:
        """Distance between the two, in [m]. Shape (n,)."""
        apart = self.evader - self.pursuer
        found: Array = np.hypot(apart[:, 0], apart[:, 1])
        return found

    @property
    def closest_distance(self) -> float:
        """Least recorded distance, in [m]."""
        return float(self.distances.min())


TOURNAMENT = duel(
    level="steps",
    duration=246.15,  # 450 steps
    evader="look-ahead",
    pursuer=PURSUIT,
)


def play_track(settings: PairingSettings) -> StrategyTrack:
    """Play one game at level "steps" or "unicycle"; return its track."""
    return record_steps(settings.played)


def record_steps(
    game: GameSettings,
    strategies: Mapping[str, Strategy] = MappingProxyType({}),
) -> StrategyTrack:
    """Play a duel without bodies; return a pose at each decision.

    Strategies as objects replace those of the settings, by player.
    """
    world, times = floor_of(game, strategies), list[float]()
    evades = world.motions["evader"]
    assert isinstance(evades, FloorWalk)
    evades.decision_times = times
    return track_of(*play_floor(world, rules_of(game)), game.room, times)


def track_of(
    game: GameInPlay,
    recorder: FloorRecorder,
    room: Room | None = None,
    times: Sequence[float] = (),
) -> StrategyTrack:
    """Return the record of a finished game of pursuer and evader.

    Times of decisions of the evader are in [s].
    """
    assert game.outcome is not None
    poses = recorder.poses()
    return StrategyTrack(
        game.outcome,
        recorder.times,
        poses["pursuer"],
        poses["evader"],
        (room or OPEN_FLOOR).clearance(poses["evader"][:, :2]),
        float(np.mean(times[1:] or times or [0.0])),
        max(times[1:], default=0.0),
    )


def play_pairing(settings: PairingSettings) -> Record:
    """Play one game of a tournament and return its record.

    Values in SI units: ``survived_s`` ends with capture or contact,
    ``bound_m`` is the closest approach under optimal play on an open floor,
    ``reached_m`` the closest approach, 0 after contact with an obstacle, and
    ``regret_m`` their difference.
    """
    track, game = play_track(settings), settings.game
    outcome, closest = track.outcome, track.closest_distance
    bound = bound_of(track.pursuer[0], track.evader[0], game.evader.gait)
    reached = 0.0 if outcome is Outcome.TOUCHED else closest
    clear, ways = track.clearances.min(), np.diff(track.evader, axis=0)
    return {
        "outcome": outcome.value,
        "survived_s": float(track.times[-1]),
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
        "circle_m": circle_distance(game),
    }


def bound_of(pursuer: Array, evader: Array, gait: GaitSettings) -> float:
    """Return the closest approach under optimal play on an open floor, [m].

    Both have a gait, and stand at their initial poses.
    """
    unit, heading = gait.speed / gait.gain, pursuer[2]
    x, y = (evader[:2] - pursuer[:2]) / unit
    x, y = rotate(x, y, -heading)
    # The evader walks backwards.
    value = pursuit_bound(CELLS).value((x, y, evader[2] + pi - heading))
    return unit * float(value)


def circle_distance(game: GameSettings) -> float | None:
    """Return the distance on the paper's circle for a pursuer, in [m].

    The evader moves aside. None for a pursuer that does not steer by eq. (2),
    or of another speed.
    """
    strategy = load_strategy(game.pursuer.strategy)
    own, other = game.pursuer.gait, game.evader.gait
    if not isinstance(strategy, Pursuit) or own.speed != other.speed:
        return None
    ratio = strategy.gain
    if ratio == inf or strategy != Pursuit(gain=ratio):
        return None
    circle = find_circle(
        own.speed,
        other.speed,
        ratio * own.gain,
        other.gain,
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
