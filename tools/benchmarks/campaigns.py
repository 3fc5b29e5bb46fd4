"""Measure the results of docs/results/ that one command prints.

Most are studies, whose records an interrupted run keeps in a folder; others
measure learned legs. Networks and robots are those of docs/legs.md, in this
folder::

    python tools/benchmarks/campaigns.py duels-ideal pushes
    python tools/benchmarks/campaigns.py --list
"""

import json
import shlex
import subprocess
import sys
from argparse import ArgumentParser, RawDescriptionHelpFormatter
from pathlib import Path
from typing import Any, NamedTuple

from benchmark_options import RESULTS
from result_files import header, write_result

FILES = "tools/results"  # studies that are no presets
AIMED = "--set 'person=straight,0.3 m*'"
SEEN = f"{AIMED} --set bearing=-45,0,45,180 --set seed=1:2 --by bearing"
PASSED = "--set person=passing --set bearing=-45,0,45 --by person"
AROUND = "--set bearing=0,30,60,90,120,150,180,-150,-120,-90,-60,-30"
LEGS = f"--set speed=0.5,1.0,1.4,1.8 {AROUND}"
G1 = "--set robot=g1 --set legs.network=fastsac_g1_29dof.onnx"
T1 = "--set robot=t1_12 --set legs.network=t1_12dof.onnx"
PUSHES = (
    "--set phase=0,0.5 --by method --value limit_n_s "
    "--value of_bound --value above_bound"
)
CROWD = (
    "--value robot.success --value robot.collided --value fell "
    "--value robot.time_s --value robot.intimate_share "
    "--value robot.personal_share"
)
TEAMS = "--set pursuers=pursuit,assigned,pincer --set evaders=evasion"


class Campaign(NamedTuple):
    """Command that makes a result.

    Attributes:
        label: What tells it apart in a table of several results.
        words: Words of ``stepaside study``; or those of ``stepaside robot``,
            from this word on.
    """

    label: str
    words: str


STUDIES = {
    "duels-ideal": Campaign("ideal", "duels --set seed=0:40"),
    "duels-hardware": Campaign(
        "hardware-like", "duels --set body=hardware --set seed=0:16"
    ),
    "duels-cameras": Campaign(
        "ideal, with cameras", f"{FILES}/camera-duels.toml"
    ),
    "duels-degraded": Campaign(
        "degraded cameras",
        f"{FILES}/camera-duels.toml --set cameras.drop_frames=0.3 --set "
        "cameras.added_latency=0.1 --set scene.things=clutter --set seed=0:1",
    ),
    "fast-walks-ideal": Campaign(
        "ideal", f"{FILES}/fast-walks.toml --set seed=1:2"
    ),
    "fast-walks-hardware": Campaign(
        "hardware",
        f"{FILES}/fast-walks.toml --set body=hardware --set seed=1:2",
    ),
    "corrections": Campaign("", f"{FILES}/corrections.toml"),
    "pushes": Campaign("paper", f"pushes {PUSHES}"),
    "pushes-fast": Campaign(
        "fast", f"pushes --set gait=fast --set method=measured,mpc {PUSHES}"
    ),
    "robustness": Campaign(
        "hardware",
        "robustness --set body=hardware --set method=measured "
        "--set seed=1:2 --by disturbance",
    ),
    "people-ideal": Campaign("ideal", f"people {AIMED} --by speed"),
    "people-hardware": Campaign(
        "hardware",
        f"people --set body=hardware --set speed=0.6,1.4 {AIMED} --by speed",
    ),
    "people-passing": Campaign(
        "ideal", "people --set person=passing --by person"
    ),
    "people-cameras": Campaign(
        "cameras, ideal, 0.8 m/s",
        f"people --set senses=cameras --set speed=0.8 {SEEN}",
    ),
    "people-cameras-hardware": Campaign(
        "cameras, hardware, 0.5 m/s",
        "people --set senses=cameras --set body=hardware --set speed=0.5 "
        f"{SEEN}",
    ),
    "people-cameras-passing": Campaign(
        "cameras",
        f"people --set senses=cameras --set speed=0.8 --set seed=1:3 {PASSED}",
    ),
    "people-lidar": Campaign(
        "lidar, ideal, 0.8 m/s",
        f"people --set senses=lidar --set speed=0.8 {SEEN}",
    ),
    "people-lidar-passing": Campaign(
        "lidar",
        f"people --set senses=lidar --set speed=0.8 --set seed=1:3 {PASSED}",
    ),
    "person-walks": Campaign("ideal", f"{FILES}/person-walks.toml"),
    "person-cameras": Campaign(
        "cameras",
        f"{FILES}/person-walks.toml --set senses=cameras --set "
        "cameras.colour.renderer=raycast --set cameras.colour.rate=2 --set "
        "walk=steers-slowly --set seed=1:4",
    ),
    "people-legs": Campaign(
        "G1, ideal sight",
        f"people {G1} --set person=straight {LEGS} --by speed",
    ),
    "people-legs-lidar": Campaign(
        "T1, Booster Gym, lidar",
        f"people {T1} --set senses=lidar --set person=straight --set "
        f"speed=1.0,1.8 {AROUND} --by speed",
    ),
    "people-legs-cameras": Campaign(
        "T1, B-Human, cameras",
        "people --set robot=t1 --set legs.network=T1.onnx --set "
        "legs.contract=bhuman_t1 --set senses=cameras --set person=straight "
        f"--set speed=0.5 {AROUND} --by speed",
    ),
    "people-legs-passing": Campaign(
        "G1",
        f"people {G1} --set person=passing --set speed=1.0 {AROUND} "
        "--by person",
    ),
    "chasers": Campaign("G1", f"{FILES}/chasers.toml"),
    "people-drawn": Campaign(
        "G1",
        f"people {G1} --set evader.strategy=wary --set drawn=true --set "
        "speed=1.0 --set bearing=0 --set person=straight,halting,turning,"
        "backing,regular,impassive,surprised,curious,scared,threatening "
        "--set seed=0:3 --by person",
    ),
    "crowd-legs": Campaign(
        "G1 on learned legs, physics",
        f"{FILES}/crowd-legs.toml --set seed=0:10 {CROWD}",
    ),
    "crowd": Campaign(
        "NAO on the paper's legs, physics",
        f"examples/crowd.toml --set seed=0:10 {CROWD}",
    ),
    "crowd-steps": Campaign(
        "NAO, template at `steps`",
        f"examples/crowd.toml --set level=steps --set seed=0:10 {CROWD}",
    ),
    "teams": Campaign(
        "", f"examples/teams.toml {TEAMS},team-evasion --set seed=0:10"
    ),
    "rooms": Campaign("", f"{FILES}/rooms.toml"),
    "rooms-seen": Campaign(
        "",
        f"{FILES}/rooms.toml --set senses=cameras --set map.source=seen "
        "--set evader.strategy=look-ahead --set room=0:3",
    ),
    "rooms-pursuers": Campaign(
        "",
        f"{FILES}/rooms.toml --set recipe.discs=0 --set duration=60 --set "
        "pursuer.strategy=sharp,herding,noisy --set "
        "evader.strategy=look-ahead,robust",
    ),
    "evaders": Campaign("", f"{FILES}/evaders.toml"),
    "robust": Campaign(
        "",
        f"{FILES}/evaders.toml --set evader=robust --set "
        "'pursuer=pursuit,sharp,herding,noisy' --set seed=3000:3003",
    ),
    "rating": Campaign(
        "",
        "rating --set 'evader=look-ahead,optimal,"
        "evasion(safety_radius=100),"
        "evasion(saturated=true,safety_radius=100),"
        "evasion(angle=45deg,safety_radius=100)' --set seed=0:6 "
        "--by evader",
    ),
    "rating-pursuers": Campaign(
        "",
        "pursuers --set 'pursuer=pursuit,pursuit(gain=2),sharp,herding,lead,"
        "noisy,stop-and-wait' --set seed=0:6 --by pursuer",
    ),
    "legs-fastsac_g1_29dof": Campaign(
        "G1, 29 joints, holosoma",
        "robot legs measure g1 --legs fastsac_g1_29dof.onnx",
    ),
    "legs-g1_12dof": Campaign(
        "G1, 12 joints, recurrent, legged_gym",
        "robot legs measure g1_12 --legs g1_12dof.onnx",
    ),
    "legs-t1_12dof": Campaign(
        "T1, 12 joints, Booster Gym",
        "robot legs measure t1_12 --legs t1_12dof.onnx",
    ),
    "legs-T1": Campaign(
        "T1, 13 joints, B-Human",
        "robot legs measure t1 --legs T1.onnx --legs-contract bhuman_t1",
    ),
    "legs-K1": Campaign(
        "K1, 12 joints, B-Human",
        "robot legs measure k1 --legs K1.onnx --legs-contract bhuman_k1",
    ),
    "legs-nao": Campaign(
        "NAO, 12 joints, B-Human",
        "robot legs measure ./nao --legs nao.onnx --legs-contract bhuman",
    ),
}


def settings_of(words: list[str]) -> dict[str, str]:
    """Return the study, or the command, and its changes, by path."""
    if words[0] == "robot":
        return {"command": " ".join(words)}
    sets = [b for a, b in zip(words, words[1:], strict=False) if a == "--set"]
    return {"study": words[0]} | dict(text.split("=", 1) for text in sets)


def measure(name: str, folder: Path, workers: int) -> dict[str, Any]:
    """Run one command to its end, or continue it; return its JSON object.

    Raises:
        CalledProcessError: If it fails.
    """
    words = shlex.split(STUDIES[name].words)
    more = ["--workers", str(workers), "--json"]
    if words[0] != "robot":
        words.insert(0, "study")
        more += ["--output", str(folder / f"{name}.sqlite")]
    command = [sys.executable, "-m", "stepaside", *words, *more]
    done = subprocess.run(command, check=True, stdout=subprocess.PIPE)
    found = dict(json.loads(done.stdout))
    return {"measured": found} if words[0] == "robot" else found


def main() -> None:
    """Measure the results that are named, one after the other."""
    asked = ArgumentParser(
        description=__doc__, formatter_class=RawDescriptionHelpFormatter
    )
    asked.add_argument("names", nargs="*", metavar="NAME")
    asked.add_argument("--list", action="store_true")
    asked.add_argument("--output", type=Path, default=RESULTS)
    asked.add_argument("--records", type=Path, default=Path("build/records"))
    asked.add_argument("--workers", type=int, default=1)
    given = asked.parse_args()
    for name in STUDIES if given.list else given.names:
        label, words = STUDIES[name]
        study = "" if words.startswith("robot ") else "study "
        command = f"stepaside {study}{words}"
        if given.list:
            print(f"{name}: {command}")
            continue
        found = measure(name, given.records, given.workers)
        settings = {"label": label, **settings_of(shlex.split(words))}
        file = given.output / f"{name}.json"
        write_result(file, header(settings, command), **found)


if __name__ == "__main__":
    main()
