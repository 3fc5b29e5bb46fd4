"""Simulate people approaching and passing a robot that sees, with fast gait.

They do not wear the colours of a robot, so colour images contain no
detections: two images per second are ray cast. Depth images and sonar have
their usual rates::

    python tools/benchmarks/camera_people.py --speed 0.8 --seeds 1:6
    python tools/benchmarks/camera_people.py --speed 0.5 --seeds 1:6 \
        --body hardware
    python tools/benchmarks/camera_people.py --sensing lidar
"""

from argparse import Namespace
from dataclasses import replace

from benchmark_options import ask, seeds_of
from resumable_jobs import finished, gather

from stepaside.games.walk_settings import WalkSettings
from stepaside.locomotion.zmp.control_settings import STABILISED
from stepaside.planning import PRESETS
from stepaside.sim.body_settings import BODIES
from stepaside.sim.camera_settings import CameraSettings, ColourSettings
from stepaside.studies.people_statistics import passing_rows, people_rows
from stepaside.studies.person_encounters import (
    Encounter,
    base_settings,
    encounters,
    play_encounter,
)
from stepaside.studies.result_files import header, write_result

AHEAD = (0, 45, -45, 90, -90)  # directions they come from, in [deg]
BEHIND = (135, -135, 180)
AIMED = (0.0, 0.3)  # lateral offset of the path from the robot, in [m]
BY = (1.2, -1.2)
CAMERAS = CameraSettings(colour=ColourSettings(renderer="raycast", rate=2.0))


def grid(
    sensing: str,
    body: str,
    speed: float,
    seeds: range,
    bearings: tuple[int, ...],
    *offsets: float,
) -> list[Encounter]:
    """Return encounters at one speed from several directions."""
    walk = WalkSettings(
        seed=seeds.start,
        gait=PRESETS["fast"],
        body=BODIES[body],
        control=STABILISED,
    )
    return [
        replace(each, base=replace(each.base, cameras=CAMERAS))
        for each in encounters(
            base_settings(walk),
            (sensing,),
            seeds,
            speeds=(speed,),
            bearings=bearings,
            offsets=offsets,
        )
    ]


def _name(asked: Namespace) -> str:
    end = "" if asked.body == "ideal" else f"-{asked.body}"
    return f"people-{asked.sensing}{end}.json"


def main() -> None:
    """Simulate the encounters and write the results."""
    asked = ask(__doc__, _name)
    asked.add_argument("--speed", type=float, default=0.8)
    asked.add_argument("--seeds", type=seeds_of, default="1:3")
    asked.add_argument("--body", choices=BODIES, default="ideal")
    asked.add_argument(
        "--sensing", choices=("cameras", "lidar"), default="cameras"
    )
    asked.add_argument("--workers", type=int)
    arguments = asked.parse_args()
    speed, seeds, body = arguments.speed, arguments.seeds, arguments.body
    # Cameras never detect people from behind.
    behind = seeds if arguments.sensing == "lidar" else seeds[:1]
    output, how = arguments.output, (arguments.sensing, body, speed)
    groups = {
        "ahead": grid(*how, seeds, AHEAD, *AIMED),
        "behind": grid(*how, behind, BEHIND, AIMED[0]),
        "past": grid(*how, seeds, AHEAD, *BY),
    }
    jobs = {each.key: each for group in groups.values() for each in group}
    settings = {
        "body": body,
        **({} if how[0] == "cameras" else {"sensing": how[0]}),
        "speed_m_s": speed,
        "seeds": [seeds.start, seeds.stop],
    }
    head = header(settings)
    rows = gather(output, head, jobs, play_encounter, arguments.workers)
    found = {
        name: [(each, rows[each.key]) for each in group]
        for name, group in groups.items()
    }
    came = [
        {"from": name, **people_rows(found[name])[0]}
        for name in ("ahead", "behind")
    ]
    passed = passing_rows(found["past"])[0]
    each = [
        {
            "bearing_deg": who.bearing,
            "offset_m": who.offset,
            "seed": who.seed,
            **rows[key],
        }
        for key, who in jobs.items()
    ]
    write_result(output, head, came=came, passed=passed, rows=each)
    finished(output)


if __name__ == "__main__":
    main()
