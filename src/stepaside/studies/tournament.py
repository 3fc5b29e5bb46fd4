"""Evaders against pursuers, in rooms by seed: one game a record."""

import json
from collections.abc import Callable, Sequence
from concurrent.futures import Executor, Future, as_completed
from dataclasses import asdict, dataclass, field
from functools import cache
from hashlib import sha256
from math import atan2, hypot, isfinite, pi, radians
from typing import Any

import numpy as np

from ..errors import ConfigurationError, check_within
from ..poses import Array, Pose, wrap_angle, wrap_angles
from ..rooms import Room, RoomRecipe, draw_starts, make_room, room_entries
from ..strategies.steps import StepGame, StepTrack, play_steps
from ..strategies.tables import pursuit_bound
from ..workers import give_up
from .entrants import evader_of, pursuer_of
from .floor_used import floor_used
from .records import RecordFile
from .version import GROUND, code_version, library_versions

Record = dict[str, Any]
ERROR = ConfigurationError
LEVELS = ("steps", "unicycles")
ROOMS = (
    *(*GROUND, "laws", "randomness", "rooms", "unicycle", "bound", "steps"),
    *("strategies", "studies/entrants", "studies/tournament"),
    "studies/floor_used",
)
BLOCK = 10  # games that a process is given at once
CELLS = 64  # of the bound's table
SIGHT = radians(148.0)  # bearing up to which a turned head sees, in [rad]
FEEDBACK = 8  # decisions in a step, of unicycles


@dataclass(frozen=True)
class TournamentSettings:
    """What decides a game of a tournament but its seed and its players.

    Attributes:
        level: "steps", or "unicycles", which decide eight times a step.
        room: What the seeds make rooms of, or one room for all of them.
        game: Rules.
        angle: Strategy alpha of the evader "alpha", in [rad].
    """

    level: str = "steps"
    room: RoomRecipe | Room = field(default_factory=RoomRecipe)
    game: StepGame = field(default_factory=StepGame)
    angle: float = pi / 4

    def __post_init__(self) -> None:
        """Refuse other levels and angles."""
        if self.level not in LEVELS:
            raise ERROR(
                f"level must be one of {', '.join(LEVELS)}, "
                f"got {self.level!r:.40}"
            )
        check_within(self.angle, 0.0, pi, "angle", "rad", ERROR)

    def arena(self, seed: int) -> tuple[Room, tuple[Pose, Pose]]:
        """Room of a seed, and where both start in it."""
        if isinstance(self.room, Room):
            room = self.room
            return room, room.starts or draw_starts(room, seed)
        room = make_room(self.room, seed)
        assert room.starts is not None
        return room, room.starts

    def entries(self) -> Record:
        """All of it, as an object for other programs."""
        room = self.room
        return {
            "level": self.level,
            "room": room_entries(room)
            if isinstance(room, Room)
            else asdict(room),
            "game": asdict(self.game),
            "angle_rad": self.angle,
        }

    def fingerprint(self) -> str:
        """Digits that change with any of it."""
        text = json.dumps(self.entries(), sort_keys=True)
        return sha256(text.encode()).hexdigest()[:12]


Pairing = tuple[str, str]
"""Names of an evader and of a pursuer."""


def play_track(
    settings: TournamentSettings, pairing: Pairing, seed: int
) -> tuple[Room, StepTrack]:
    """Play one game of a tournament, and keep all of it."""
    room, starts = settings.arena(seed)
    unicycles = settings.level == "unicycles"
    values = asdict(settings.game)
    game = StepGame(**values | {"decisions": FEEDBACK if unicycles else 1})
    track = play_steps(
        pursuer_of(pairing[1]),
        evader_of(pairing[0], settings.angle),
        starts,
        room=room,
        game=game,
    )
    return room, track


def play_record(
    settings: TournamentSettings, pairing: Pairing, seed: int
) -> Record:
    """Play one game of a tournament, and keep its figures.

    Returns:
        Figures in SI units, and the version of code and libraries.
    """
    room, track = play_track(settings, pairing, seed)
    game = settings.game
    distances = track.distances
    turns = wrap_angles(np.diff(track.evader[:, 2]))
    moved = np.diff(track.evader[:, :2], axis=0)
    seconds = (len(distances) - 1) * game.period
    seconds /= FEEDBACK if settings.level == "unicycles" else 1
    clear = float(track.clearances.min())
    return {
        "evader": pairing[0],
        "pursuer": pairing[1],
        "seed": seed,
        "outcome": str(track.outcome),
        "survived_s": seconds,
        "closest_m": float(distances.min()),
        "bound_m": bound_of(track.pursuer[0], track.evader[0], game),
        "clearance_m": clear if isfinite(clear) else None,
        "floor_m2": floor_used(track.evader[:, :2], game.body_radius),
        "walked_m": float(np.hypot(*moved.T).sum()),
        "turning_rad_s": float(np.abs(turns).sum()) / max(seconds, 1e-9),
        "unseen": float((np.abs(track.bearings) > SIGHT).mean()),
        "decision_s": track.decision,
        "longest_decision_s": track.longest_decision,
    } | _stamp()


def bound_of(pursuer: Array, evader: Array, game: StepGame) -> float:
    """Best least distance on an open floor from two poses, in [m]."""
    x, y = (evader[:2] - pursuer[:2]).tolist()
    sight, unit = atan2(y, x), game.speed / game.gain
    value = pursuit_bound(CELLS).value(
        hypot(x, y) / unit,
        wrap_angle(sight - float(pursuer[2])),
        wrap_angle(sight + pi - float(evader[2])),
    )
    return unit * float(value)


def key_of(settings: TournamentSettings, pairing: Pairing, seed: int) -> str:
    """Key of a game among records."""
    return f"{settings.fingerprint()}/{'/'.join(pairing)}/{seed}"


def play_tournament(
    settings: TournamentSettings,
    pairings: Sequence[Pairing],
    seeds: Sequence[int],
    file: RecordFile | None = None,
    executor: Executor | None = None,
    report: Callable[[int], None] | None = None,
    done: dict[str, Record] | None = None,
) -> dict[str, Record]:
    """Play what a file of records does not hold yet.

    Args:
        settings: Of every game.
        pairings: Who plays whom.
        seeds: One game of each pairing for each.
        file: Where records are kept as they come; one that another version
            of the code made is made again.
        executor: Any executor of ``concurrent.futures``; None plays here.
        report: Called with the number of games that are done.
        done: Filled with the records as they come, for whoever stops it.

    Returns:
        Records by key, by pairing and then by seed.
    """
    wanted = {
        key_of(settings, pairing, seed): (pairing, seed)
        for pairing in pairings
        for seed in seeds
    }
    results: dict[str, Record] = {} if done is None else done
    if file is not None:
        for key, record in file.read().items():
            stamp = {name: record.get(name) for name in _stamp()}
            if key in wanted and stamp == _stamp():
                results[key] = record
    left = [key for key in wanted if key not in results]
    pursuit_bound(CELLS)  # solved once, before many want it

    def take(keys: list[str], records: list[Record]) -> None:
        for key, record in zip(keys, records, strict=True):
            results[key] = record
            if file is not None:
                file.append(key, record)
        if report is not None:
            report(len(results))

    take([], [])
    blocks = [left[i : i + BLOCK] for i in range(0, len(left), BLOCK)]
    if executor is None:
        for keys in blocks:
            take(keys, _play_block(settings, [wanted[key] for key in keys]))
    else:
        futures: dict[Future[list[Record]], list[str]] = {
            executor.submit(
                _play_block, settings, [wanted[key] for key in keys]
            ): keys
            for keys in blocks
        }
        try:
            for future in as_completed(futures):
                take(futures[future], future.result())
        except BaseException:
            give_up(executor, futures)
            raise
    return {key: results[key] for key in wanted}


def _play_block(
    settings: TournamentSettings, games: list[tuple[Pairing, int]]
) -> list[Record]:
    return [play_record(settings, pairing, seed) for pairing, seed in games]


@cache
def _stamp() -> Record:
    return {
        "version": code_version(ROOMS),
        "libraries": library_versions(("numba", "numpy")),
    }
