"""Initial poses of the players of a game."""

from dataclasses import replace
from math import dist, pi, radians

from .. import arena
from ..core.errors import ConfigurationError
from ..core.poses import Pose
from ..core.random_streams import named_generator
from .game_settings import GameSettings, StartSettings

SLOW_SPEED = 0.15  # up to which a person begins a duel nearby, in [m/s]
SAME = 1e-6  # distance of equal poses, in [m] and [rad]
LEAD_TIME = 5.0  # extra distance of a faster person over its speed, in [s]


def with_starts(settings: GameSettings) -> GameSettings:
    """Return the settings of the same game with nothing left open.

    All starts and goals are filled in, and what the settings imply. In a duel
    starts are those of ``start``, or of its room, which gets them; otherwise
    see :func:`.drawn_starts.draw_starts`.
    """
    if settings.game == "duel":
        return _with_start_of_duel(settings)
    from .drawn_starts import draw_starts

    return draw_starts(settings).resolved()


def _with_start_of_duel(settings: GameSettings) -> GameSettings:
    """Return a duel with its start, and poses by it or by its room."""
    room, start = settings.room, settings.start
    if room is None:
        drawn = draw_start(settings)
        assert drawn.distance is not None
        assert drawn.pursuer_offset is not None
        assert drawn.evader_offset is not None
        poses = (
            Pose(0.0, 0.0, drawn.pursuer_offset),
            Pose(drawn.distance, 0.0, pi + drawn.evader_offset),
        )
        settings = replace(settings, start=drawn)
    else:
        for name in ("distance", "pursuer_offset", "evader_offset"):
            if getattr(start, name) is not None:
                raise ConfigurationError(
                    f"start.{name} must be omitted in a room, which gives "
                    f"the initial poses, got {getattr(start, name):g}"
                )
        poses = room.starts or arena.draw_initial_poses(room, settings.seed)
        arena.check_initial_poses(room, poses)
        settings = replace(settings, room=replace(room, starts=poses))
    own = settings.pursuer
    if own.body == "person" and own.person.backward:  # it looks away
        x, y, theta = poses[0]
        poses = Pose(x, y, theta - pi), poses[1]
    # Settings with nothing left open give a distance, or the poses of a room.
    for each, pose in zip(settings.players, poses, strict=True):
        moved = each.start and (room or not start.distance)
        if moved and dist(each.start, pose) > SAME:
            raise ConfigurationError(
                f"{each.name}: start must be omitted in a duel, whose start "
                "is start, or that of its room"
            )
    return settings.started_at(poses).resolved()


def draw_start(settings: GameSettings) -> StartSettings:
    """Return the start of a duel with what is omitted drawn by the seed."""
    start, pursuer = settings.start, settings.pursuer
    generator = named_generator(settings.seed, "start")
    distance = generator.uniform(start.near, start.far)
    if pursuer.body == "person":
        distance += 1.5  # whole strides away
        # A faster person begins farther away, to be detected in time.
        distance += LEAD_TIME * max(0.0, pursuer.person.speed - SLOW_SPEED)
    drawn = {
        "distance": distance,
        "pursuer_offset": generator.uniform(-pi / 2, pi / 2),
        "evader_offset": generator.uniform(-radians(30.0), radians(30.0)),
    }
    missing = {k: v for k, v in drawn.items() if getattr(start, k) is None}
    return replace(start, **missing)
