"""Every call that the flows make: commands, processes and public names.

Flows state what users do and what comes out. How a thing is called stands
here alone, so that a new name of a command changes one line.
"""

import json
import os
import sqlite3
import subprocess
import sys
import tomllib
from collections.abc import Sequence
from contextlib import closing
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

import stepaside as sa
from flows.forking import run_forked

EXAMPLES = Path(__file__).parents[2] / "examples"
TIMEOUT = 850.0  # [s], for what hangs


class Output(NamedTuple):
    """What a command answered."""

    status: int
    out: str
    err: str

    @property
    def json(self) -> Any:
        """The one JSON document on standard output."""
        return json.loads(self.out)


def stepaside(
    *words: object,
    status: int = 0,
    cwd: Path | None = None,
    env: dict[str, str] | None = None,
    largest_file: int | None = None,
    anew: bool = False,
) -> Output:
    """Run a command as a user does, and check its exit status.

    Files that would become larger than ``largest_file`` [bytes] fail, as if
    the disk were full. ``anew``, it imports what it needs itself.
    """
    texts, environment = list(map(str, words)), os.environ | (env or {})
    if anew:
        done = subprocess.run(
            [sys.executable, "-m", "stepaside", *texts],
            capture_output=True,
            text=True,
            cwd=cwd,
            env=environment,
            timeout=TIMEOUT,
        )
        output = Output(done.returncode, done.stdout, done.stderr)
    else:
        folder = cwd or Path.cwd()
        output = Output(
            *run_forked(texts, folder, environment, largest_file, TIMEOUT)
        )
    assert output.status == status, output
    return output


def start_stepaside(
    *words: object,
    cwd: Path | None = None,
    env: dict[str, str] | None = None,
    stdin: int | None = None,
) -> subprocess.Popen[str]:
    """Start a command that goes on until it is told to stop."""
    return subprocess.Popen(
        [sys.executable, "-m", "stepaside", *map(str, words)],
        stdin=stdin,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        cwd=cwd,
        env=os.environ | (env or {}),
    )


# Duels, walks and theory.

Arrays = dict[str, NDArray[np.float64]]


def summary(game: str, *options: object) -> Any:
    """The printed summary of a duel, a walk, a game or a game of theory."""
    return stepaside(game, *options, "--json").json


def kept_summary(game: str, folder: Path, *options: object) -> Any:
    """Play into a run folder; the summary that it holds."""
    stepaside(game, *options, "--output", folder)
    return json.loads((folder / "summary.json").read_text())


def trajectories(folder: Path) -> Arrays:
    """The arrays of a run folder by name."""
    with np.load(folder / "trajectories.npz") as arrays:
        return dict(arrays)


def configuration(folder: Path) -> dict[str, Any]:
    """The settings of a run folder."""
    return tomllib.loads((folder / "configuration.toml").read_text())


def play_duel(
    start: tuple[float, float, float], duration: float, **evasion: Any
) -> sa.Run:
    """Play a duel from Python.

    Args:
        start: Distance, in [m]; offsets of pursuer and evader, in [rad].
        duration: Simulated time, in [s].
        evasion: Settings of the paper's evader.
    """
    return sa.run_game(
        sa.duel(
            duration=duration,
            start=sa.StartSettings(*start),
            evasion=sa.Evasion(**evasion),
        )
    )


def recorded_claims(folder: Path, shard: str) -> Any:
    """Measure one share of the paper's claims; readings by claim."""
    stepaside(
        *("reproduce", "--runs", 1, "--shard", shard, "--workers", 1),
        *("--output", folder),
    )
    with closing(sqlite3.connect(folder / "claims.sqlite")) as table:
        rows = table.execute("select key, record from records").fetchall()
    return {key.partition("/")[0]: json.loads(record) for key, record in rows}


def arena_duel(**settings: Any) -> Any:
    """The Gymnasium environment of an evader against the paper's pursuer."""
    import gymnasium

    return gymnasium.make("stepaside.envs:stepaside/Evade-v0", **settings)


# Games of many, levels, strategies, studies and environments.


def duel_of(
    evader: object,
    *,
    distance: float,
    duration: float,
    level: str = "physics",
    offsets: tuple[float, float] = (0.0, 0.0),
) -> Any:
    """Let NAO pursue a strategy, each by its offset [rad] off the other.

    Return the summary.
    """
    return stepaside(
        *("duel", "--strategy", evader, "--distance", distance, "--json"),
        *("--set", f"start.pursuer_offset={offsets[0]}"),
        *("--set", f"start.evader_offset={offsets[1]}"),
        *("--set", f"level={level}", "--duration", duration),
    ).json


def start_duel(
    evader: object, folder: Path, *, duration: float
) -> "subprocess.Popen[str]":
    """Start a duel into a run folder."""
    return start_stepaside(
        *("duel", "--strategy", evader, "--distance", 1, "--output", folder),
        *("--set", "start.pursuer_offset=0", "--set", "start.evader_offset=0"),
        *("--duration", duration),
    )


def duel_with_person(
    *, sensing: str, speed: float, distance: float, duration: float
) -> Any:
    """Let a person walk straight at a NAO with fast legs."""
    return stepaside(
        *("duel", "--gait", "fast", "--pursuer", "person", "--json"),
        *("--set", "person.path=straight", "--set", f"person.speed={speed}"),
        *("--set", "start.pursuer_offset=0", "--set", "start.evader_offset=0"),
        *("--distance", distance, "--duration", duration),
        *("--sensing", sensing),
    ).json


def own_duel(evader: Any, *, distance: float, duration: float) -> Any:
    """The same as :func:`duel_of` with a strategy object, from Python."""
    return sa.run_game(
        sa.duel(
            duration=duration,
            start=sa.StartSettings(distance, 0.0, 0.0),
            evader={"strategy": evader if isinstance(evader, str) else ""},
        ),
        strategies={} if isinstance(evader, str) else {"evader": evader},
    )


def rows_of(source: object, *words: object) -> Any:
    """Play a study in one process; return the rows of its table."""
    return stepaside("study", source, *words, "--workers", 1, "--json").json[
        "rows"
    ]


def changes(**settings: object) -> list[object]:
    """Return the words that change settings of a study."""
    words: list[object] = []
    for name, value in settings.items():
        each = value if isinstance(value, list | tuple) else [value]
        path = name.replace("__", ".")
        words += ["--set", f"{path}={','.join(map(str, each))}"]
    return words


def walk_on_uneven_floor(height: float, *, seed: int) -> Any:
    """Walk for 20 s on an uneven floor; return the summary."""
    return stepaside(
        *(
            "run",
            "walk",
            "--set",
            f"physics.unevenness={height}",
            "--seed",
            seed,
            "--json",
        ),
        *("--duration", 20, "--set", "control.feedback=false"),
    ).json


def game_of_file(file: Path) -> Any:
    """Play the game that a file lists; return the summary."""
    return stepaside("run", "game", file, "--json").json


def study(file: Path, output: Path, *words: object, **process: Any) -> Output:
    """Run a study in one process; its output is one JSON object."""
    kept = ("--output", table_in(output), "--workers", 1, "--json")
    return stepaside("study", file, *kept, *words, **process)


def table_in(output: Path) -> Path:
    """The file of a study by a name."""
    return output.with_suffix(".sqlite")


def records_in(output: Path) -> int:
    """How many cases of a study are stored so far."""
    if not table_in(output).exists():
        return 0
    with closing(sqlite3.connect(table_in(output))) as table:
        has = "SELECT 1 FROM sqlite_master WHERE name = 'results'"
        if not table.execute(has).fetchone():
            return 0
        (number,) = table.execute("SELECT COUNT(*) FROM results").fetchone()
    return int(number)


def start_study(
    file: Path, output: Path, **environment: str
) -> "subprocess.Popen[str]":
    """Start a study, which is ended before it has finished."""
    words = ("study", file, "--output", table_in(output), "--workers", 2)
    return start_stepaside(*words, env=environment)


def commands() -> list[str]:
    """Names of all commands, as the help of the program lists them."""
    _, _, listed = stepaside("--help").out.partition("Commands:\n")
    return [line.split()[0] for line in listed.splitlines() if line[2:3] > " "]


def merge(file: Path, output: Path, *parts: Path) -> Output:
    """Join the results of the shards of a study."""
    return study(file, output, *map(table_in, parts))


def frame_of_duels(settings: dict[str, Any], seeds: Sequence[int]) -> Any:
    """Play duels as a study in Python; return the data frame."""
    study = sa.make_study("duel", settings, {"seed": seeds})
    return sa.run_study(study).to_frame()


def environment(role: str, **settings: Any) -> Any:
    """Return the Gymnasium environment of one player."""
    import gymnasium

    return gymnasium.make(f"stepaside.envs:stepaside/{role}-v0", **settings)


def vector_environment(role: str, number: int, **settings: Any) -> Any:
    """Return many such games as one vector environment."""
    import gymnasium

    name = f"stepaside.envs:stepaside/{role}-v0"
    return gymnasium.make_vec(name, num_envs=number, **settings)


def duel_environment(**settings: Any) -> Any:
    """Return the PettingZoo environment of both players."""
    from stepaside.envs import ParallelDuel

    return ParallelDuel(**settings)


def game_environment(file: Path, level: str) -> Any:
    """Return the PettingZoo environment of a game file."""
    from dataclasses import replace

    from stepaside.envs import ParallelGame

    game = ParallelGame(file).settings
    return ParallelGame(replace(game, level=level))


# Robots, legs, drivers and safety.


def play_ros2(
    namespace: str,
    *words: object,
    domain: int,
    role: str = "evader",
    speed: float,
    gain: float,
    duration: float | None = None,
    record: Path | None = None,
    dead_man: str = "",
) -> subprocess.Popen[str]:
    """Start to control a robot on ROS 2 topics."""
    options: list[object] = ["--role", role, "--domain", domain]
    options += ["--set", f"gait.speed={speed}"]
    options += ["--set", f"gait.gain={gain}"]
    options += ["--set", "evasion.safety_radius=5"]
    if duration is not None:
        options += ["--duration", duration]
    if record is not None:
        options += ["--record", record]
    if dead_man:
        options += ["--dead-man", f"ros2:{dead_man}"]
    robot = f"ros2:{namespace}"
    return start_stepaside("play", robot, *options, *words)


def serve_ros2(
    namespace: str, *, domain: int, duration: float, output: Path
) -> subprocess.Popen[str]:
    """Start to serve a simulated pursuer on ROS 2 topics, in lock step."""
    return start_stepaside(
        *("serve", "--ros2", f"pursuer={namespace}", "--domain", domain),
        *("--distance", 2, "--duration", duration, "--lockstep"),
        *("--output", output),
    )


def play_own(
    robot: str,
    *words: object,
    role: str = "evader",
    speed: float | None = None,
    gain: float | None = None,
    duration: float | None = None,
    record: Path | None = None,
    dead_man: str = "",
    stdin: int | None = None,
    env: dict[str, str] | None = None,
) -> subprocess.Popen[str]:
    """Start to control a robot by FILE.py:CLASS."""
    options: list[object] = ["--role", role]
    given: dict[str, object] = {
        "set gait.speed": speed,
        "set gait.gain": gain,
        "duration": duration,
    }
    given |= {"record": record, "dead-man": dead_man or None}
    for name, value in given.items():
        option, _, path = name.partition(" ")
        if value is not None:
            word = f"{path}={value}" if path else value
            options += [f"--{option}", word]
    return start_stepaside(
        "play", robot, *options, *words, env=env, stdin=stdin
    )


def describe_robot(model: Path, folder: Path) -> Any:
    """Derive the description of a robot from its model."""
    words = ("robot", "init", model, "--output", folder, "--json")
    return stepaside(*words).json


def check_robot(folder: Path, status: int = 0) -> Any:
    """Check whether a robot can play."""
    words = ("robot", "check", folder, "--workers", 1, "--json")
    return stepaside(*words, status=status).json


def tune_robot(folder: Path) -> Any:
    """Search for a steadier gait of a robot."""
    return stepaside("robot", "tune", folder, "--workers", 1, "--json").json


def duel_of_robot(folder: Path, distance: float, *, duration: float) -> Any:
    """Play a duel of two robots of a description; return the summary."""
    return stepaside(
        *("duel", "--robot", folder, "--distance", distance, "--json"),
        *(
            "--set",
            "start.pursuer_offset=0",
            "--set",
            "start.evader_offset=0.2",
        ),
        *("--duration", duration),
    ).json


def inspect_legs(
    network: Path, *, robot: Path | None = None, status: int = 0
) -> Any:
    """Read the contract of a walking policy."""
    words = ("--robot", robot) if robot else ()
    return stepaside(
        "robot", "legs", "inspect", network, *words, "--json", status=status
    ).json


def measure_legs(robot: Path) -> Any:
    """Measure what the learned legs of a robot deliver."""
    return stepaside(
        "robot", "legs", "measure", robot, "--workers", 1, "--json"
    ).json


def duel_on_legs(
    robot: Path, folder: Path, speed: float, duration: float
) -> Path:
    """Play a duel on learned legs into a run folder."""
    stepaside(
        *(
            "duel",
            "--robot",
            robot,
            "--set",
            f"gait.speed={speed}",
            "--set",
            "gait.gain=0.2",
        ),
        *(
            "--distance",
            0.75,
            "--set",
            "start.pursuer_offset=0",
            "--set",
            "start.evader_offset=0",
        ),
        *("--duration", duration, "--output", folder),
    )
    return folder


def evade_person_on_legs(
    robot: Path, folder: Path, strategy: str, *, speed: float, miss: float
) -> Path:
    """Let a person walk past a robot on learned legs, into a run folder."""
    stepaside(
        *("duel", "--robot", robot, "--strategy", strategy),
        *("--pursuer", "person", "--set", "person.path=straight"),
        *("--set", f"person.speed={speed}", "--set", f"person.miss={miss}"),
        *("--set", "start.pursuer_offset=0", "--set", "start.evader_offset=0"),
        *("--distance", 7, "--duration", 7, "--output", folder),
    )
    return folder


def shielded_duel(*, shield: bool) -> Any:
    """Let a slow person steer at a robot that would stand."""
    words: tuple[object, ...] = ("--duration", 12, "--json")
    if shield:
        words += ("--set", "evader.shield.enabled=true")
        words += ("--set", "evader.shield.speed=0.06")
        words += ("--set", "evader.shield.turning_radius=6")
    return stepaside(
        *("duel", "--pursuer", "person", "--set", "person.speed=0.06"),
        *("--set", "person.gain=10", "--set", "person.turning_radius=6"),
        *("--set", "start.pursuer_offset=0", "--distance", 0.95),
        *("--strategy", "stand", *words),
    ).json


# Pages, runs and files.


def load_run(folder: Path) -> Any:
    """Read a run folder."""
    return sa.load_run(folder)


def write_page_of(run: Path, page: Path) -> Path:
    """Write one page that plays a run."""
    stepaside("show", run, "-o", page)
    return page


def export_run(run: Path, to: str, folder: Path) -> Path:
    """Write a run in the format of other programs."""
    output = folder.with_suffix(f".{to}")
    stepaside("show", run, "-o", output)
    return output


def measure_bag(bag: Path, output: Path, **frames: str) -> Any:
    """Measure players whose motion a bag holds; return the summary."""
    words = [f"--frame={name}={frame}" for name, frame in frames.items()]
    return stepaside("show", bag, *words, "-o", output, "--json").json


def keep_duel(
    folder: Path,
    distance: float,
    pursuer_offset: float,
    evader_offset: float,
    *,
    duration: float,
) -> Path:
    """Play a duel of the paper's robots into a run folder."""
    stepaside(
        *("duel", "--seed", 7, "--duration", duration, "--output", folder),
        *(
            "--distance",
            distance,
            "--set",
            f"start.pursuer_offset={pursuer_offset}",
        ),
        *("--set", f"start.evader_offset={evader_offset}"),
    )
    return folder


def film_run(
    run: Path, film: Path, width: int, height: int, rate: int, seconds: float
) -> Path:
    """Write a film of the beginning of a run."""
    stepaside(
        *("show", run, "-o", film, "--width", width),
        *("--height", height, "--rate", rate, "--duration", seconds),
    )
    return film


def draw_comparison(figure: Path, *runs: Path) -> Path:
    """Draw runs in one figure."""
    stepaside("show", *runs, "-o", figure)
    return figure


def draw_saved_run(run: Path, figure: Path) -> Path:
    """Draw the figure of a saved run."""
    stepaside("show", run, "-o", figure)
    return figure


def open_page(settings: Any) -> Any:
    """Serve the live page of a game, paused."""
    from stepaside.report.viewer.live_page import Page

    return Page(settings, port=8200 + os.getpid() % 1000)


def games_of_pages() -> dict[str, Any]:
    """Return a game of each kind that a live page plays, by name."""
    from stepaside.report.viewer.settings_panel import presets_of

    start = sa.StartSettings(1.2, 0.4, 0.1)
    players = [
        {"name": "red", "count": 2, "role": "pursuer", "strategy": "pincer"},
        {"name": "blue", "role": "evader", "strategy": "team-evasion"},
        {"name": "guest", "body": "person", "goal": [2.0, 0.0]},
        {"name": "car", "role": "pursuer", "body": "unicycle"},
    ]
    return {
        **presets_of(sa.duel(seed=7, start=start)),
        "walk": sa.walk(0.3, seed=4, body="hardware"),
        "players": sa.duel(game="game", seed=3, players=players),
    }
