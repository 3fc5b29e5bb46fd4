"""Test when a robot that walks by itself must rest."""

import re
from math import inf, nan, pi, radians
from typing import Any

import pytest

from stepaside.core.poses import Pose
from stepaside.drivers.watchdog import Watchdog
from stepaside.perception.measurement import RobotState, Sighting

from velocity_fakes import report  # isort: skip

STAMP = 7e8  # robot's clocks need not show our time


def settled(**settings: Any) -> Watchdog:
    """A watchdog that has heard enough, the last time at 0.2 s."""
    dog = Watchdog(**settings)
    for i in range(5):
        said = dog.check(report(STAMP + 0.05 * i), 0.05 * i)
    assert said == ""
    return dog


def test_a_robot_moves_only_after_some_good_reports() -> None:
    dog = Watchdog()
    assert dog.check(None, 0.0) == "no odometry received yet"
    said = [dog.check(report(STAMP + 0.05 * i), 0.05 * i) for i in range(4)]
    assert said == 2 * ["waiting for more odometry"] + 2 * [""]


def test_silence_is_borne_up_to_the_limit_and_then_warms_up_anew() -> None:
    dog = settled()
    assert dog.check(None, 0.44) == ""
    assert "no odometry for 0.26 s" in dog.check(None, 0.46)
    assert dog.silent == pytest.approx(0.26)
    assert "waiting for more" in dog.check(report(STAMP + 0.3), 0.5)


def test_simulated_time_may_stand_still() -> None:
    dog = settled(paced=False)
    assert dog.check(None, 9.0) == ""
    assert dog.silent == pytest.approx(8.8)
    assert dog.check(report(STAMP + 60.0), 9.01) == ""


def test_a_report_with_the_stamp_of_the_last_one_is_none() -> None:
    dog = settled()
    frozen = report(STAMP + 0.25)
    assert dog.check(frozen, 0.25) == ""
    assert dog.check(frozen, 0.45) == ""
    said = dog.check(frozen, 0.52)
    assert said == "no odometry for 0.27 s: the stamp stays at 700000000.250 s"
    assert "the stamp stays at" in dog.check(None, 5.0)
    assert dog.silent == pytest.approx(4.75)
    assert "waiting for more" in dog.check(report(STAMP + 5.0), 5.05)
    told = dog.check(None, 6.0)
    assert told.startswith("no odometry for") and "stamp" not in told


def test_a_repeated_report_may_bring_a_hindrance() -> None:
    dog = settled(paced=False)
    again = report(STAMP + 0.2)
    assert dog.check(again, 0.3) == ""
    hindered = again._replace(hindrance="another commands")
    assert dog.check(hindered, 0.35) == "another commands"
    assert dog.check(again, 0.4) == ""


@pytest.mark.parametrize(
    ("pose", "said"),
    [
        (Pose(50.0, 0.0, 0.0), "position jumped by 50.00 m in 0.050 s"),
        (Pose(0.0, 0.0, 2.0), "heading jumped by 2.00 rad in 0.050 s"),
        (Pose(0.0, 0.0, 90.0), "heading must .* got 90.0: is it in degrees"),
        (Pose(0.4, 0.0, 0.5), ""),
    ],
)
def test_a_pose_that_jumps_stops_the_robot(pose: Pose, said: str) -> None:
    dog = settled()
    told = dog.check(report(STAMP + 0.25, pose=pose), 0.25)
    assert re.search(f"^odometry: the {said}", told) if said else not told
    then = dog.check(report(STAMP + 0.3, pose=pose), 0.3)
    assert bool(then) == bool(said)


def test_a_turn_through_pi_is_no_jump() -> None:
    dog = Watchdog()
    for i, theta in enumerate((3.13, 3.13, 3.13, -3.13)):
        turned = report(STAMP + 0.05 * i, pose=Pose(0.0, 0.0, theta))
        said = dog.check(turned, 0.05 * i)
    assert said == ""


@pytest.mark.parametrize("bad", [nan, inf])
@pytest.mark.parametrize("place", ["time", "x", "theta"])
def test_odometry_that_is_no_number_stops_the_robot(
    place: str, bad: float
) -> None:
    dog = settled()
    values = {"time": STAMP + 0.25, "x": 0.0, "theta": 0.0} | {place: bad}
    pose = Pose(values["x"], 0.0, values["theta"])
    sick = RobotState(
        values["time"], pose=pose, sighting=Sighting(STAMP, 0.0, 1.0)
    )
    assert "must be finite" in dog.check(sick, 0.25)
    assert "waiting for more" in dog.check(report(STAMP + 0.3), 0.3)


def test_stamps_that_go_back_or_outrun_the_clock_stop_the_robot() -> None:
    told = settled().check(report(STAMP + 0.1), 0.25)
    assert "went back in time by 0.100 s" in told
    dog = settled()
    assert dog.check(report(STAMP + 0.34), 0.25) == ""  # 90 ms ahead
    assert "ahead of the clock" in dog.check(report(STAMP + 0.41), 0.3)


def test_a_lead_is_made_up_for_by_waiting() -> None:
    dog = settled()
    assert dog.check(report(STAMP + 0.34), 0.25) == ""
    assert dog.check(report(STAMP + 0.40), 0.40) == ""
    assert dog.check(report(STAMP + 0.55), 0.46) == ""


def test_reports_that_fall_behind_the_clock_stop_the_robot() -> None:
    """One that is late by itself, or a clock that drifts, does not."""
    dog = settled()
    for i in range(1, 600):
        now = 0.2 + 0.0509 * i
        assert dog.check(report(STAMP + 0.2 + 0.05 * i), now) == ""
    late = settled()
    for i in range(1, 21):
        now = 0.2 + 0.06 * i
        assert late.check(report(STAMP + 0.2 + 0.05 * i), now) == ""
    said = [
        late.check(report(STAMP + 1.2 + 0.05 * i), 1.4 + 0.1 * i)
        for i in range(1, 20)
    ]
    assert said[3] == "" and "s behind the clock" in said[-1]
    stays = late.check(report(STAMP + 2.2), 3.35)
    assert "s behind the clock" in stays


@pytest.mark.parametrize(("begins", "late"), [(0.8, 30), (1.27, 40)])
def test_a_pose_that_stays_while_the_robot_is_to_move_stops_it(
    begins: float, late: int
) -> None:
    """Until it changes; a robot that is to stand may stay where it is."""
    dog, there = settled(start_support=begins), Pose(0.3, 0.0, 0.0)

    def checked(first: int, count: int, pose: Pose, moves: bool) -> list[str]:
        return [
            dog.check(
                report(STAMP + 0.05 * i, pose=pose), 0.05 * i, moves=moves
            )
            for i in range(first, first + count)
        ]

    assert not any(checked(5, 60, there, False))
    said = checked(64, 41, there, True)
    assert said[late - 2] == "" and "pose does not change" in said[late]
    assert "pose does not change" in checked(105, 9, there, False)[-1]
    assert checked(114, 4, Pose(0.3, 1e-9, 0.0), False)[-1] == ""


@pytest.mark.parametrize(
    ("seen", "said"),
    [
        (None, "opponent not detected"),
        (Sighting(STAMP + 0.25, nan, 1.0), "must be finite"),
        (Sighting(STAMP + 0.25, 0.0, inf), "must be finite"),
        (Sighting(nan, 0.0, 1.0), "must be finite"),
        (Sighting(STAMP + 0.25, radians(-238.0), 1.0), "got -238 deg"),
        (Sighting(STAMP + 0.25, 3.15, 1.0), "bearing of the sighting must"),
        (Sighting(STAMP + 0.25, pi, 1.0), ""),
        (Sighting(STAMP + 0.25, -pi, 1.0), ""),
        (Sighting(STAMP + 0.25, 0.0, -1.0), "distance of the sighting must"),
        (Sighting(STAMP + 0.25, 0.0, 2e3), "got 2000 m"),
        (Sighting(STAMP + 0.4, 0.0, 1.0), "0.15 s in the future"),
        (Sighting(STAMP - 0.36, 0.0, 1.0), "is 0.6 s old"),
        (Sighting(STAMP - 0.2, 0.0, 1.0), ""),
    ],
)
def test_only_a_fresh_true_sighting_is_one_to_act_upon(
    seen: Sighting | None, said: str
) -> None:
    dog = settled()
    told = dog.check(report(STAMP + 0.25, sighting=seen), 0.25)
    assert (said in told) if said else not told
