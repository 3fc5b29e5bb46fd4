"""Let people who steer at it chase a robot on learned legs.

The robot is a matador. People come from twelve directions, with three turning
radii, for 40 s each; bodies pass through each other::

    python tools/benchmarks/legs_chasers.py g1 fastsac_g1_29dof.onnx
    python tools/benchmarks/legs_chasers.py g1 g1.onnx --sensing lidar

An interrupted run continues.
"""

from dataclasses import dataclass, replace
from functools import cache
from math import pi, tau
from pathlib import Path
from typing import Any

from benchmark_options import ask
from result_files import header, write_result
from resumable_jobs import finished, gather

from stepaside.games.forecast import forecast
from stepaside.games.game_settings import GameSettings, duel, read_game
from stepaside.games.player_settings import SENSING
from stepaside.games.recorded_game import run_game
from stepaside.locomotion.control_settings import LegsSettings
from stepaside.locomotion.policy.policy_legs import load_legs
from stepaside.robots.description import load_robot
from stepaside.sim.camera_settings import (
    DEPTH_CAMERAS,
    CameraSettings,
)
from stepaside.sim.person_settings import PersonSettings
from stepaside.theory.value.chauffeur import guaranteed_distance

RADII = (2.5, 4.0, 8.0)  # of the turns of people, in [m]
DIRECTIONS = 12
SPEED = 1.4  # of people, in [m/s]
STEERING = 10.0  # gain of people, in [1/s]: they turn at their limit
DISTANCE = 8.0  # at first, in [m]
DURATION = 40.0  # of a duel, in [s]


@dataclass(frozen=True, slots=True)
class Chase:
    """One chase, from one of the directions, with a turning radius [m]."""

    robot: str
    network: str
    sensing: str
    cameras: CameraSettings
    radius: float
    direction: int

    @property
    def settings(self) -> Any:
        """Settings of the duel."""
        base = _base(self.robot, self.network)
        return base.changed(
            senses=self.sensing,
            cameras=self.cameras,
            person=PersonSettings(
                "steer",
                SPEED,
                STEERING,
                turning_radius=self.radius,
                solid=False,
            ),
            start=replace(
                base.start,
                distance=DISTANCE,
                pursuer_offset=0.0,
                evader_offset=pi - tau * self.direction / DIRECTIONS,
            ),
        )


@cache
def _base(robot: str, network: str) -> GameSettings:
    """Return what all chases of a robot have in common."""
    return read_game(
        {"robot": robot, "legs": {"network": network}}, base=duel()
    ).changed(
        duration=DURATION,
        pursuer={"body": "person"},
        evader={"strategy": "matador"},
    )


def play(chase: Chase) -> dict[str, Any]:
    """Return how one chase ended."""
    run = run_game(chase.settings)
    return {
        "turning_radius_m": chase.radius,
        "direction": chase.direction,
        "outcome": run.outcome.value,
        "duration_s": run.duration,
        "triggered_at_s": run.summary.triggered_at_s,
        "closest_m": run.summary.min_distance_m,
        "template_closest_m": forecast(run.settings).min_distance_m,
    }


def main() -> None:
    """Play and write the results."""
    parser = ask(
        __doc__,
        lambda given: (
            "legs-chasers.json"
            if given.sensing == "ideal"
            else f"legs-chasers-{'rear-' * given.rear_camera}"
            f"{given.sensing}"
            f"{'' if given.depth_camera == 'xtion' else '-d455'}.json"
        ),
    )
    parser.add_argument("robot", type=Path)
    parser.add_argument("network", type=Path)
    parser.add_argument("--sensing", choices=SENSING, default="ideal")
    parser.add_argument("--rear-camera", action="store_true")
    parser.add_argument(
        "--depth-camera", choices=DEPTH_CAMERAS, default="xtion"
    )
    parser.add_argument("--workers", type=int, default=1)
    asked = parser.parse_args()
    if asked.rear_camera and asked.sensing != "cameras":
        parser.error("--rear-camera requires --sensing cameras")
    cameras = CameraSettings(
        depth=DEPTH_CAMERAS[asked.depth_camera],
        rear_camera=asked.rear_camera,
    )
    chosen = {
        "depth_camera": asked.depth_camera,
        "rear_camera": cameras.rear_camera,
    }
    head = header(
        {
            "robot": asked.robot.name,
            "network": asked.network.name,
            "sensing": asked.sensing,
            **{name: value for name, value in chosen.items() if value},
            "speed_m_s": SPEED,
            "directions": DIRECTIONS,
            "duration_s": DURATION,
            "strategy": "matador",
        }
    )
    where = str(asked.robot), str(asked.network), asked.sensing, cameras
    jobs = {
        f"{radius:g} m from {i}": Chase(*where, radius, i)
        for radius in RADII
        for i in range(DIRECTIONS)
    }
    legs = load_legs(
        LegsSettings(str(asked.network)), load_robot(asked.robot), tick=0.02
    )
    low, high = legs.velocities.forward
    slower = min(-low, high)
    chases = gather(asked.output, head, jobs, play, asked.workers)
    write_result(
        asked.output,
        head,
        slower_m_s=slower,
        closed_form_m={
            f"{radius:g}": radius * guaranteed_distance(slower / SPEED)
            for radius in RADII
        },
        chases=list(chases.values()),
    )
    finished(asked.output)


if __name__ == "__main__":
    main()
