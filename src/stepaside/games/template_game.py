"""Game of an approaching pursuer and the template of an evader."""

from collections.abc import Callable

from ..core.poses import Pose
from ..planning import GaitSettings
from ..sim.person_motion import PersonMotion, Place
from ..strategies.knowledge import limits_of
from ..strategies.strategy import Strategy
from ..strategies.velocity_set import VelocitySet
from .floor_games import PAIR, StrategyTrack, track_of
from .floor_world import (
    FloorAgent,
    FloorMotion,
    FloorPerson,
    FloorPoint,
    FloorRecorder,
    FloorWalk,
    FloorWorld,
)
from .game import GameInPlay, GameRules, play

STEP = 0.01  # of the integration, in [s]


def play_template(
    motion: Callable[[Pose, Place], PersonMotion],
    start: Pose,
    evader: Pose,
    strategy: Strategy,
    gait: GaitSettings,
    *,
    duration: float,
    velocities: VelocitySet | None = None,
    step: float = STEP,
) -> StrategyTrack:
    """Play the template of an evader against a prescribed motion.

    The evader decides once per footstep; while it stands it decides at any
    time, and moves after its first double support. One on learned legs is
    the point that stands for them.

    Args:
        motion: Returns the motion of the pursuer from its initial pose and
            the evader's position.
        start: Initial pose of the pursuer in the world.
        evader: Initial pose of the evader in the world.
        strategy: Strategy of the evader.
        gait: Gait of the evader.
        duration: Duration of the game, in [s].
        velocities: Velocities that learned legs deliver; None for a unicycle.
        step: Step of the integration, in [s].
    """
    agent = FloorAgent(
        strategy,
        limits_of(gait, velocities),
        PAIR["evader"],
        list(PAIR.values()),
    )
    own: FloorMotion
    if velocities is not None:
        own = FloorPoint(agent, evader, gait, step)
    else:
        own = FloorWalk(agent, evader, delay=gait.start_support, alert=step)
    walk = motion(start, (evader.x, evader.y))
    world = FloorWorld(
        {
            "pursuer": FloorPerson("pursuer", walk, {}, "evader", step),
            "evader": own,
        }
    )
    recorder = FloorRecorder(world, step)
    game = GameInPlay(world, GameRules(duration), (recorder,))
    play(game)
    return track_of(game, recorder)
