r"""Let people who steer at it, or feint, chase a robot on learned legs.

The robot is a matador. People come from twelve directions, with three turning
radii, for 40 s each; bodies pass through each other. Whoever feints does so by
the distance and duration with which a search in the template, the point that
stands for the legs, came closest to it::

    python tools/benchmarks/legs_chasers.py g1 fastsac_g1_29dof.onnx
    python tools/benchmarks/legs_chasers.py g1 g1.onnx --sensing lidar \
        --like docs/results/legs-chasers.json

With ``--like`` the feints of an earlier result are played again. An
interrupted run continues.
"""

import json
from dataclasses import dataclass, replace
from functools import cache
from math import pi, tau
from pathlib import Path
from typing import Any

import numpy as np
from benchmark_options import ask
from resumable_jobs import finished, gather

from stepaside.core.random_streams import named_generator
from stepaside.games.duel_settings import SENSING, DuelSettings
from stepaside.games.forecast import forecast
from stepaside.games.recorded_game import run_duel
from stepaside.games.robot_settings import with_legs, with_robot
from stepaside.locomotion.control_settings import LegsSettings
from stepaside.locomotion.policy.policy_legs import load_legs
from stepaside.robots.description import load_robot
from stepaside.sim.camera_settings import (
    DEPTH_CAMERAS,
    CameraSettings,
)
from stepaside.sim.person_settings import PersonSettings
from stepaside.studies.result_files import header, write_result
from stepaside.theory.value.closed_forms import guaranteed_distance

RADII = (2.5, 4.0, 8.0)  # of the turns of people, in [m]
DIRECTIONS = 12
PEOPLE = ("steer", "feint")
SPEED = 1.4  # of people, in [m/s]
STEERING = 10.0  # gain of people, in [1/s]: they turn at their limit
DISTANCE = 8.0  # at first, in [m]
DURATION = 40.0  # of a duel, in [s]
NEAREST, FARTHEST = 1.0, 6.0  # distance at which people feint, in [m]
SHORTEST, LONGEST = 0.2, 1.5  # duration of a feint, in [s]
CANDIDATES = 12  # feints drawn for each person
REFINED = 6  # variations of the best of them
SPREAD = 0.15  # of a variation, relative to the ranges


@dataclass(frozen=True, slots=True)
class Chase:
    """One chase.

    Attributes:
        robot: Folder of the robot.
        network: File of its policy.
        sensing: Sensing of the robot.
        cameras: Its cameras, with the sensing of cameras.
        radius: Smallest turning radius of the person, in [m].
        direction: Number of the direction that the person comes from.
        feints: Whether the person feints.
        seed: Seed of the search for a feint.
        known: Distance [m] and duration [s] of a feint that was found
            before; without one it is searched.
    """

    robot: str
    network: str
    sensing: str
    cameras: CameraSettings
    radius: float
    direction: int
    feints: bool
    seed: int
    known: tuple[float, float] | None = None

    def settings(self, feint_at: float = 0.0, feint: float = 0.6) -> Any:
        """Return the duel with a feint at a distance [m] of a time [s]."""
        base = _base(self.robot, self.network)
        return replace(
            base,
            sensing=self.sensing,
            cameras=self.cameras,
            person=PersonSettings(
                "steer",
                SPEED,
                STEERING,
                turning_radius=self.radius,
                feint_at=feint_at,
                feint=feint,
                solid=False,
            ),
            start=replace(
                base.start,
                distance=DISTANCE,
                pursuer_offset=0.0,
                evader_offset=pi - tau * self.direction / DIRECTIONS,
            ),
        )

    def hardest(self) -> Any:
        """Return the duel whose feint brings the person closest."""
        name = f"chaser {self.radius:g} m, direction {self.direction}"
        generator = named_generator(self.seed, name)
        best, least = generator.random(3), np.inf
        for i in range(CANDIDATES + REFINED):
            drawn = generator.random(3)
            if i >= CANDIDATES:
                drawn = best + SPREAD * generator.standard_normal(3)
                drawn = np.clip(drawn, 0.0, 1.0)
            closest = forecast(self._feinting(drawn)).min_distance_m
            if closest is not None and closest < least:
                best, least = drawn, closest
        return self._feinting(best)

    def _feinting(self, shares: Any) -> Any:
        """Return the duel at shares of the ranges. Shape (3,)."""
        feint_at = NEAREST + shares[0] * (FARTHEST - NEAREST)
        feint = SHORTEST + shares[1] * (LONGEST - SHORTEST)
        side = 1.0 if shares[2] < 0.5 else -1.0
        return self.settings(round(feint_at, 3), round(side * feint, 3))


@cache
def _base(robot: str, network: str) -> DuelSettings:
    """Return what all chases of a robot have in common."""
    return replace(
        with_legs(with_robot(DuelSettings(), robot), network),
        duration=DURATION,
        pursuer="person",
        evader_strategy="matador",
    )


def play(chase: Chase) -> dict[str, Any]:
    """Return how one chase ended."""
    if chase.known is not None:
        settings = chase.settings(*chase.known)
    else:
        settings = chase.hardest() if chase.feints else chase.settings()
    run = run_duel(settings)
    return {
        "turning_radius_m": chase.radius,
        "direction": chase.direction,
        "feints": chase.feints,
        "feint_at_m": settings.person.feint_at,
        "feint_s": settings.person.feint if chase.feints else 0.0,
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
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--like", type=Path, help="earlier results")
    parser.add_argument("--people", choices=PEOPLE, nargs="+", default=PEOPLE)
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
            "seed": asked.seed,
        }
    )
    where = str(asked.robot), str(asked.network), asked.sensing, cameras
    known = {}
    if asked.like is not None:
        earlier = json.loads(asked.like.read_text(encoding="utf-8"))
        known = {
            (row["turning_radius_m"], row["direction"]): (
                row["feint_at_m"],
                row["feint_s"],
            )
            for row in earlier["chases"]
            if row["feints"]
        }
    jobs = {
        f"{radius:g} m from {i}{', feints' if feints else ''}": Chase(
            *(*where, radius, i, feints, asked.seed),
            known=known.get((radius, i)) if feints else None,
        )
        for feints in (False, True)
        if PEOPLE[feints] in asked.people
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
