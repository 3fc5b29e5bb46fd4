"""Play one duel, and one in a room, at every level from every door.

The doors are Python, a game file, a tournament, the environment of both
players, whose actions are those of the strategies, and the compiled games
against the pursuer. In the room the pursuer goes around obstacles::

    PYTHONPATH=src:tools/benchmarks python tests/doors.py
"""

from dataclasses import asdict, replace
from math import atan2
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from stepaside.arena import Room, RoomRecipe, generate_room
from stepaside.core.poses import Pose
from stepaside.envs import ParallelDuel, VectorDuel
from stepaside.games import GameSettings, duel
from stepaside.games.game import play
from stepaside.games.game_starts import with_starts
from stepaside.games.players import RobotPlayer
from stepaside.games.recorded_game import RecordedGame
from stepaside.games.settings_reader import dump_configuration, load_game
from stepaside.strategies import Knowledge, load_strategy
from stepaside.strategies.knowledge import limits_of
from stepaside.studies.tournament import (
    PairingSettings,
    play_track,
    record_steps,
)
from stepaside.theory.unicycle import RelativeStart

LEVELS = ("steps", "unicycle", "physics")
DURATION = 110 * 0.547  # of a duel, whole steps, in [s]
STRATEGIES = {"pursuer": "pursuit", "evader": "evasion(safety_radius=100)"}
STARTS = RelativeStart(1.0, 0.3, -0.2).poses()
RECIPE, SEED = RoomRecipe(discs=3), 105  # of the room

Row = dict[str, Any]


def settings_of(level: str, *, room: bool) -> GameSettings:
    """Return the duel, or the one in a room."""
    start = {"distance": 1.0, "pursuer_offset": -0.3, "evader_offset": 0.2}
    game = duel(
        level=level,
        duration=DURATION,
        pursuer=STRATEGIES["pursuer"],
        evader=STRATEGIES["evader"],
        **({} if room else {"start": start}),
    )
    return replace(game, room=generate_room(RECIPE, SEED)) if room else game


def from_python(level: str, *, room: bool) -> Row:
    """Play the settings."""
    return row_of(settings_of(level, room=room))


def from_file(level: str, *, room: bool) -> Row:
    """Play a game file of two players."""
    game = settings_of(level, room=room)
    game = replace(with_starts(game), game="game")
    with TemporaryDirectory() as folder:
        file = Path(folder) / "game.toml"
        file.write_text(dump_configuration(game))
        return row_of(load_game(file))


def row_of(settings: GameSettings) -> Row:
    """Return outcome, end [s], last distance and closest approach [m]."""
    game = RecordedGame(settings)
    play(game)
    run = game.run()
    return {
        "outcome": run.outcome.value,
        "time_s": run.duration,
        "distance_m": float(run.distance[-1]),
        "closest_m": game.closest["evader", "pursuer"],
    }


def from_tournament(level: str, *, room: bool) -> Row:
    """Play as a tournament does; in physics as a study of duels."""
    game = settings_of(level, room=room)
    if level == "physics":
        return from_python(level, room=room)
    if room:
        game = game.changed(seed=SEED)
        track = play_track(PairingSettings(game, room=RECIPE))
    else:
        track = record_steps(game.started_at(STARTS))
    return {
        "outcome": track.outcome.value,
        "time_s": float(track.times[-1]),
        "distance_m": float(track.distances[-1]),
        "closest_m": track.closest_distance,
    }


def environment_of(level: str, *, room: bool) -> dict[str, Any]:
    """Return the settings of an environment of the duel."""
    game = settings_of(level, room=room)
    plan = game.room
    if level != "physics" and plan is None:
        plan = Room(starts=STARTS)
    duel = replace(game, room=None)
    found = {"level": level, "duration": DURATION, "room": plan}
    return found | {"arenas": 1, "duel": duel}


def from_many(level: str, *, room: bool) -> Row | None:
    """Play one of the compiled games, which are not played in physics."""
    if level == "physics":
        return None
    settings = environment_of(level, room=room)
    name = STRATEGIES["pursuer"]
    env = VectorDuel(role="evader", opponent=name, **settings)
    given, over, time = env.settings, [False], 0.0
    gait, mind = given.duel.evader.gait, load_strategy(STRATEGIES["evader"])
    limits, memory = limits_of(gait), mind.begin()
    seen, _ = env.reset(seed=0)
    while not any(over):
        away, cosine, sine = map(float, seen[0, :3])
        known = Knowledge(time, atan2(sine, cosine), away, limits)
        intent, memory = mind.decide(known, memory)
        action = [[intent.heading, intent.speed_factor]]
        seen, _, touched, late, info = env.step(action)
        over, time = touched | late, time + given.period
    unit = gait.speed / gait.gain
    return {
        "outcome": "touched" if touched[0] else "completed",
        "time_s": time,
        "distance_m": float(info["final_obs"][0, 0]) * unit,
        "closest_m": float(info["final_info"]["closest_m"][0]),
    }


def from_environment(level: str, *, room: bool) -> Row:
    """Play an episode by the decisions of the strategies of a game."""
    env = ParallelDuel(**environment_of(level, room=room))
    game = RecordedGame(settings_of(level, room=room))
    minds = dict(game.strategies)
    if level == "physics":
        for player in game.in_physics.players:
            assert isinstance(player, RobotPlayer)
            minds[player.name] = player.scheme.decisions.strategy
    memories = {name: mind.begin() for name, mind in minds.items()}
    _, infos = env.reset(seed=env.settings.duel.seed)
    actions: dict[str, tuple[float, float]] = {}
    last: dict[str, Knowledge] = {}
    while env.agents:
        for name, mind in minds.items():
            known = env.known[name]
            if known is last.get(name):
                continue  # it does not decide
            intent, memories[name] = mind.decide(known, memories[name])
            actions[name] = (intent.heading, intent.speed_factor)
            last[name] = known
        *_, infos = env.step(actions)
    info, world = infos["evader"], env.game.world
    poses: dict[str, Pose] = dict(world.states())
    apart = RelativeStart.from_world(poses["pursuer"], poses["evader"])
    return {
        "outcome": env.game.outcome.value if env.game.outcome else "",
        "time_s": info["time_s"],
        "distance_m": apart.distance,
        "closest_m": info["closest_m"],
    }


DOORS = {
    "Python": from_python,
    "game file": from_file,
    "tournament": from_tournament,
    "environment": from_environment,
    "many games": from_many,
}


def main() -> None:
    """Play all, and write the results."""
    from benchmark_options import ask
    from result_files import header, write_result

    output = ask(__doc__, "doors.json").parse_args().output
    rows = [
        {"level": level, "door": door, "room": room, **found}
        for room in (False, True)
        for level in LEVELS
        for door, play in DOORS.items()
        if (found := play(level, room=room))
    ]
    head = header({"duration_s": DURATION, "recipe": asdict(RECIPE)})
    write_result(output, head, rows=rows)
    for row in rows:
        print(row)


if __name__ == "__main__":
    main()
