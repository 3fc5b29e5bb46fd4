"""Every call that the flows make: commands, processes and public names.

Flows state what users do and what comes out. How a thing is called stands
here alone, so that a new name of a command changes one line.
"""

import json
import os
import subprocess
import sys
import tomllib
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

import stepaside as sa

TIMEOUT = 280.0  # [s], for what hangs


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
) -> Output:
    """Run a command as a user does, and check its exit status."""
    done = subprocess.run(
        [sys.executable, "-m", "stepaside", *map(str, words)],
        capture_output=True,
        text=True,
        cwd=cwd,
        env=os.environ | (env or {}),
        timeout=TIMEOUT,
    )
    output = Output(done.returncode, done.stdout, done.stderr)
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
) -> sa.DuelRun:
    """Play a duel from Python.

    Args:
        start: Distance, in [m]; offsets of pursuer and evader, in [rad].
        duration: Simulated time, in [s].
        evasion: Settings of the paper's evader.
    """
    return sa.run_duel(
        sa.DuelSettings(
            duration=duration,
            start=sa.StartSettings(*start),
            strategy=sa.Evasion(**evasion),
        )
    )


def recorded_claims(folder: Path, shard: str) -> Any:
    """Measure one share of the paper's claims; readings by claim."""
    stepaside(
        *("reproduce", "--runs", 1, "--shard", shard, "--workers", 1),
        *("--output", folder),
    )
    (records,) = (folder / "records").glob("*.jsonl")
    lines = [json.loads(line) for line in records.read_text().splitlines()]
    return {
        line["key"].partition("/")[0]: line["record"]["readings"]
        for line in lines
    }


def arena_duel(**settings: Any) -> Any:
    """The Gymnasium environment of an evader against the paper's pursuer."""
    import gymnasium

    return gymnasium.make("stepaside.envs:stepaside/Evade-v0", **settings)


# Games of many, levels, strategies, studies and environments.


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
    options += ["--speed", speed, "--gain", gain, "--safety-radius", 5]
    if duration is not None:
        options += ["--duration", duration]
    if record is not None:
        options += ["--record", record]
    if dead_man:
        options += ["--dead-man", f"ros2:{dead_man}"]
    robot = f"ros2:{namespace}"
    return start_stepaside("play", "--robot", robot, *options, *words)


def serve_ros2(
    namespace: str, *, domain: int, duration: float, output: Path
) -> subprocess.Popen[str]:
    """Start to serve a simulated pursuer on ROS 2 topics, in lock step."""
    return start_stepaside(
        *("serve", "--ros2", f"pursuer={namespace}", "--domain", domain),
        *("--distance", 2, "--duration", duration, "--lockstep"),
        *("--output", output),
    )


def play_lola(
    path: Path, *, duration: float, record: Path
) -> subprocess.Popen[str]:
    """Start to control the joints of a NAO V6, as evader."""
    return start_stepaside(
        *("play", "--robot", f"lola:{path}", "--role", "evader"),
        *("--duration", duration, "--record", record),
    )


def serve_lola(path: Path, *, duration: float) -> subprocess.Popen[str]:
    """Start to serve the joints of a simulated evader, in lock step."""
    return start_stepaside(
        *("serve", "--lola", f"evader={path}", "--lockstep"),
        *("--distance", 3, "--duration", duration, "--json"),
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
        "speed": speed,
        "gain": gain,
        "duration": duration,
    }
    given |= {"record": record, "dead-man": dead_man or None}
    for name, value in given.items():
        if value is not None:
            options += [f"--{name}", value]
    return start_stepaside(
        "play", "--robot", robot, *options, *words, env=env, stdin=stdin
    )


def describe_robot(model: Path, folder: Path) -> Any:
    """Derive the description of a robot from its model."""
    words = ("robot", "init", model, "--output", folder, "--json")
    return stepaside(*words).json


def check_robot(folder: Path, status: int = 0) -> Any:
    """Check whether a robot can play."""
    return stepaside("robot", "check", folder, "--json", status=status).json


def tune_robot(folder: Path) -> Any:
    """Search for a steadier gait of a robot."""
    return stepaside("robot", "tune", folder, "--json").json


def duel_of_robot(folder: Path, distance: float, *, duration: float) -> Any:
    """Play a duel of two robots of a description; return the summary."""
    return stepaside(
        *("duel", "--robot", folder, "--distance", distance, "--json"),
        *("--pursuer-offset", 0, "--evader-offset", 0.2),
        *("--duration", duration),
    ).json


def inspect_legs(
    network: Path, *, robot: Path | None = None, status: int = 0
) -> Any:
    """Read the contract of a walking policy."""
    words = ("--robot", robot) if robot else ()
    return stepaside(
        "legs", "inspect", network, *words, "--json", status=status
    ).json


def measure_legs(robot: Path) -> Any:
    """Measure what the learned legs of a robot deliver."""
    return stepaside("legs", "measure", robot, "--json").json


def duel_on_legs(
    robot: Path, folder: Path, speed: float, duration: float
) -> Path:
    """Play a duel on learned legs into a run folder."""
    stepaside(
        *("duel", "--robot", robot, "--speed", speed, "--gain", 0.2),
        *("--distance", 0.75, "--pursuer-offset", 0, "--evader-offset", 0),
        *("--duration", duration, "--output", folder),
    )
    return folder


def evade_person_on_legs(
    robot: Path, folder: Path, strategy: str, *, speed: float, miss: float
) -> Path:
    """Let a person walk past a robot on learned legs, into a run folder."""
    stepaside(
        *("duel", "--robot", robot, "--strategy", strategy),
        *("--pursuer", "person", "--person-path", "straight"),
        *("--person-speed", speed, "--person-miss", miss),
        *("--pursuer-offset", 0, "--evader-offset", 0),
        *("--distance", 7, "--duration", 7, "--output", folder),
    )
    return folder


def shielded_duel(*, contact: float, shield: bool) -> Any:
    """Let a slow person steer at a robot that would stand."""
    words: tuple[object, ...] = ("--duration", 20, "--json")
    if shield:
        words += ("--shield", "--shield-speed", 0.09)
        words += ("--shield-turning-radius", 6, "--shield-contact", contact)
    return stepaside(
        *("duel", "--pursuer", "person", "--person-speed", 0.09),
        *("--person-gain", 10, "--person-turning-radius", 6),
        *("--pursuer-offset", 0, "--distance", 1.3, "--strategy", "stand"),
        *words,
    ).json


# Pages, runs and files.


def load_run(folder: Path) -> Any:
    """Read a run folder."""
    return sa.load_run(folder)


def write_page_of(run: Path, page: Path) -> Path:
    """Write one page that plays a run."""
    stepaside("replay", run, "--html", page)
    return page


def export_run(run: Path, to: str, folder: Path) -> Path:
    """Write a run in the format of other programs."""
    stepaside("export", run, "--to", to, "--output", folder)
    return folder


def measure_bag(bag: Path, output: Path, **frames: str) -> Any:
    """Measure players whose motion a bag holds; return the summary."""
    words = [f"--frame={name}={frame}" for name, frame in frames.items()]
    return stepaside("replay", bag, *words, "--output", output, "--json").json


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
        *("--distance", distance, "--pursuer-offset", pursuer_offset),
        *("--evader-offset", evader_offset),
    )
    return folder


def film_run(
    run: Path, film: Path, width: int, height: int, rate: int, seconds: float
) -> Path:
    """Write a film of the beginning of a run."""
    stepaside(
        *("replay", run, "--video", film, "--width", width),
        *("--height", height, "--rate", rate, "--duration", seconds),
    )
    return film


def draw_comparison(figure: Path, *runs: Path) -> Path:
    """Draw runs in one figure."""
    stepaside("compare", *runs, "--output", figure)
    return figure


def draw_saved_run(run: Path, figure: Path) -> Path:
    """Draw the figure of a saved run."""
    stepaside("replay", run, "--figure", figure)
    return figure


def serve_page(
    folder: Path, seed: int, distance: float
) -> subprocess.Popen[str]:
    """Start the live page of a duel, paused, with hands for its controls."""
    hands = Path(__file__).with_name("page_hands.py")
    words = ["view", "--no-run", "--no-open", "--seed", seed]
    words += ["--distance", distance, "--port", 8200 + os.getpid() % 1000]
    return subprocess.Popen(
        [sys.executable, str(hands), *map(str, words)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        cwd=folder,
    )
