"""Test the safety state machine: states, transitions, reasons."""

from typing import Any

import pytest

from stepaside.drivers.safety import (
    FALL,
    LONGEST_REACH,
    LONGEST_STOP,
    WARM_UP,
    Safety,
    SafetyInputs,
    SafetyState,
)

MOVING = [s for s in SafetyState if s is not SafetyState.LIMP]


def seen(time: float = 0.0, **changes: Any) -> SafetyInputs:
    return SafetyInputs(time)._replace(**changes)


def press(machine: Safety, time: float = 0.0) -> SafetyState:
    machine.frame(seen(time, chest_pressed=True))
    return machine.frame(seen(time))


def warm() -> Safety:
    machine = Safety()
    for _ in range(WARM_UP):
        machine.frame(seen())
    return machine


def at(state: SafetyState) -> Safety:
    """A machine in a state, since time zero."""
    machine = warm()
    if state is SafetyState.REACHING:
        return machine
    machine.frame(seen(reached=True))
    if state is SafetyState.READY:
        return machine
    press(machine)
    if state is SafetyState.WALKING:
        return machine
    press(machine)
    if state is SafetyState.STOPPING:
        return machine
    machine.halted(0.0)
    if state is SafetyState.RESTING:
        return machine
    machine.frame(seen(reached=True))
    return machine


@pytest.mark.parametrize("state", SafetyState)
def test_every_state_can_be_reached(state: SafetyState) -> None:
    assert at(state).state is state


def test_the_first_frames_cause_no_motion() -> None:
    machine = Safety()
    for _ in range(WARM_UP - 1):
        assert machine.frame(seen(reached=True)) is SafetyState.LIMP
    assert machine.frame(seen()) is SafetyState.REACHING


def test_only_walking_and_stopping_are_moved_by_control() -> None:
    movers = {state for state in SafetyState if state.moves_by_control}
    assert movers == {SafetyState.WALKING, SafetyState.STOPPING}


def test_the_button_acts_once_when_released() -> None:
    machine = at(SafetyState.READY)
    for _ in range(5):
        assert machine.frame(seen(chest_pressed=True)) is SafetyState.READY
    assert machine.frame(seen()) is SafetyState.WALKING
    for _ in range(5):
        assert machine.frame(seen()) is SafetyState.WALKING
    assert machine.reason == "chest button"


@pytest.mark.parametrize(
    ("state", "after"),
    [
        (SafetyState.LIMP, SafetyState.REACHING),
        (SafetyState.REACHING, SafetyState.RESTING),
        (SafetyState.READY, SafetyState.WALKING),
        (SafetyState.WALKING, SafetyState.STOPPING),
        (SafetyState.STOPPING, SafetyState.RESTING),
        (SafetyState.RESTING, SafetyState.RESTING),
    ],
)
def test_the_button_starts_stops_and_wakes(
    state: SafetyState, after: SafetyState
) -> None:
    assert press(at(state)) is after


@pytest.mark.parametrize("state", MOVING)
def test_a_robot_that_falls_goes_limp(state: SafetyState) -> None:
    machine = at(state)
    assert machine.frame(seen(tilt=0.99 * FALL)) is state
    assert machine.frame(seen(tilt=1.01 * FALL)) is SafetyState.LIMP
    assert "falls" in machine.reason


def test_a_robot_that_lies_does_not_get_up_by_the_button() -> None:
    machine = at(SafetyState.LIMP)
    machine.frame(seen(tilt=1.5, chest_pressed=True))
    assert machine.frame(seen(tilt=1.5)) is SafetyState.LIMP
    assert "falls" in machine.reason
    assert press(machine) is SafetyState.REACHING


@pytest.mark.parametrize("hot", [{"status": 2}, {"temperature": 81.0}])
@pytest.mark.parametrize(
    ("state", "after"),
    [
        (SafetyState.WALKING, SafetyState.STOPPING),
        (SafetyState.READY, SafetyState.RESTING),
        (SafetyState.REACHING, SafetyState.RESTING),
        (SafetyState.RESTING, SafetyState.RESTING),
        (SafetyState.LIMP, SafetyState.LIMP),
    ],
)
def test_a_hot_robot_comes_to_rest(
    state: SafetyState, after: SafetyState, hot: dict[str, Any]
) -> None:
    machine = at(state)
    assert machine.frame(seen(**hot)) is after
    assert machine.frame(seen(**hot)) is after


def test_a_hot_robot_that_has_rested_goes_limp_and_stays_so() -> None:
    machine = at(SafetyState.RESTING)
    assert machine.frame(seen(status=2, reached=True)) is SafetyState.LIMP
    assert (
        machine.frame(seen(status=2, chest_pressed=True)) is SafetyState.LIMP
    )
    assert machine.frame(seen(status=2)) is SafetyState.LIMP


@pytest.mark.parametrize("state", MOVING)
def test_critical_heat_goes_limp(state: SafetyState) -> None:
    assert at(state).frame(seen(status=3)) is SafetyState.LIMP


def test_a_little_heat_is_borne() -> None:
    machine = at(SafetyState.WALKING)
    assert (
        machine.frame(seen(status=1, temperature=79.0)) is SafetyState.WALKING
    )


@pytest.mark.parametrize("state", [SafetyState.REACHING, SafetyState.RESTING])
def test_a_posture_that_is_not_reached_in_time_is_given_up(
    state: SafetyState,
) -> None:
    machine = at(state)
    assert machine.frame(seen(LONGEST_REACH)) is state
    assert machine.frame(seen(LONGEST_REACH + 0.1)) is SafetyState.LIMP
    assert "took too long" in machine.reason


def test_control_that_does_not_stop_is_stopped() -> None:
    machine = at(SafetyState.STOPPING)
    assert machine.frame(seen(LONGEST_STOP)) is SafetyState.STOPPING
    assert machine.frame(seen(LONGEST_STOP + 0.1)) is SafetyState.RESTING


def test_halting_matters_only_to_a_robot_that_stops() -> None:
    for state in SafetyState:
        machine = at(state)
        machine.halted(0.0)
        stops = state is SafetyState.STOPPING
        assert machine.state is (SafetyState.RESTING if stops else state)


@pytest.mark.parametrize("state", MOVING)
def test_a_failure_makes_the_robot_limp_with_a_reason(
    state: SafetyState,
) -> None:
    machine = at(state)
    machine.fail("no valid frame for 0.1 s", 0.0)
    assert machine.state is SafetyState.LIMP
    assert machine.reason == "no valid frame for 0.1 s"


def test_rest_stops_a_walking_and_lowers_a_standing_robot() -> None:
    for state, after in (
        (SafetyState.WALKING, SafetyState.STOPPING),
        (SafetyState.READY, SafetyState.RESTING),
        (SafetyState.REACHING, SafetyState.RESTING),
        (SafetyState.LIMP, SafetyState.LIMP),
    ):
        machine = at(state)
        machine.rest("asked to", 0.0)
        assert machine.state is after


def lasting(
    machine: Safety, duration: float, begin: float = 1.0, **changes: Any
) -> SafetyState:
    """Return the state after frames over a duration, 12 ms apart."""
    count = round(duration / 0.012)
    for i in range(count + 1):
        state = machine.frame(seen(begin + 0.012 * i, **changes))
    return state


# What each sensor reads when something is wrong, and a word of the reason.
TO_REST: dict[str, tuple[dict[str, Any], str]] = {
    "battery": ({"charge": 0.09}, "battery"),
    "empty": ({"charge": 0.0}, "battery"),
    "current": ({"current": 1.1}, "current"),
}
TO_STAND: dict[str, tuple[dict[str, Any], str]] = {
    "lifted": ({"load": 0.0}, "are lifted"),
    "nearly_lifted": ({"load": 0.45}, "are lifted"),
    "bumper": ({"bumper": True}, "bumper"),
    "dead": ({"force": (0.0, 0.0, 0.0)}, "accelerometer"),
    "upside_down": ({"force": (0.0, 0.0, -9.81)}, "accelerometer"),
    "sideways": ({"force": (0.0, 9.81, 0.5)}, "accelerometer"),
    "beyond_range": ({"force": (0.0, 0.0, 56.0)}, "accelerometer"),
    "frozen": ({"frozen": 1.0}, "accelerometer"),
}
LASTING = 0.75  # longer than any condition has to last, in [s]


@pytest.mark.parametrize(("changes", "word"), TO_REST.values(), ids=TO_REST)
@pytest.mark.parametrize(
    ("state", "after"),
    [
        (SafetyState.WALKING, SafetyState.STOPPING),
        (SafetyState.STOPPING, SafetyState.STOPPING),
        (SafetyState.READY, SafetyState.RESTING),
        (SafetyState.REACHING, SafetyState.RESTING),
        (SafetyState.RESTING, SafetyState.RESTING),
        (SafetyState.LIMP, SafetyState.LIMP),
    ],
)
def test_a_robot_that_must_not_go_on_stops_and_rests(
    state: SafetyState, after: SafetyState, changes: dict[str, Any], word: str
) -> None:
    machine = at(state)
    assert lasting(machine, LASTING, **changes) is after
    if state not in (SafetyState.STOPPING, SafetyState.RESTING):
        assert word in machine.reason
    machine.halted(2.0)
    rests = (SafetyState.WALKING, SafetyState.STOPPING)
    assert machine.state is (SafetyState.RESTING if state in rests else after)


@pytest.mark.parametrize(("changes", "word"), TO_STAND.values(), ids=TO_STAND)
def test_a_robot_that_may_stand_but_not_walk_stops_and_stands(
    changes: dict[str, Any], word: str
) -> None:
    machine = at(SafetyState.WALKING)
    assert lasting(machine, LASTING, **changes) is SafetyState.STOPPING
    assert word in machine.reason
    machine.halted(2.0)
    assert machine.state is SafetyState.READY and word in machine.reason
    # Nothing but the button lets it walk on, and not while that lasts.
    machine.frame(seen(2.1, chest_pressed=True, **changes))
    assert machine.frame(seen(2.2, **changes)) is SafetyState.READY
    assert word in machine.reason
    assert lasting(machine, LASTING, 3.0) is SafetyState.READY
    assert press(machine, 5.0) is SafetyState.WALKING


@pytest.mark.parametrize(
    "state", [SafetyState.REACHING, SafetyState.READY, SafetyState.LIMP]
)
@pytest.mark.parametrize(("changes", "word"), TO_STAND.values(), ids=TO_STAND)
def test_a_robot_that_may_not_walk_may_take_its_stance(
    changes: dict[str, Any], word: str, state: SafetyState
) -> None:
    assert lasting(at(state), LASTING, **changes) is state


@pytest.mark.parametrize("name", [*TO_REST, *TO_STAND])
def test_every_third_frame_alone_is_no_reason_to_stop(name: str) -> None:
    changes, _ = (TO_REST | TO_STAND)[name]
    machine = at(SafetyState.WALKING)
    for i in range(400):
        odd = changes if i % 3 == 0 else {}
        assert (
            machine.frame(seen(1.0 + 0.012 * i, **odd)) is SafetyState.WALKING
        )


def test_readings_of_a_walk_meet_no_condition() -> None:
    machine = at(SafetyState.WALKING)
    for i in range(400):
        lands = i % 40 == 0
        state = machine.frame(
            seen(
                1.0 + 0.012 * i,
                load=0.3 if lands else 5.0,
                current=1.5 if lands else 0.5,
                force=(4.0, -3.0, 2.0 if lands else 12.0),
                frozen=0.1,
                charge=0.11,
            )
        )
        assert state is SafetyState.WALKING


def test_a_worse_reason_while_it_stops_makes_it_rest() -> None:
    machine = at(SafetyState.WALKING)
    lasting(machine, LASTING, bumper=True)
    lasting(machine, LASTING, 2.0, charge=0.05)
    machine.halted(3.0)
    assert machine.state is SafetyState.RESTING


def test_the_worst_of_several_reasons_counts() -> None:
    machine = at(SafetyState.WALKING)
    everything: dict[str, Any] = {"load": 0.0, "charge": 0.01, "tilt": 1.0}
    assert lasting(machine, LASTING, **everything) is SafetyState.LIMP
    assert "falls" in machine.reason
