"""Test the safety state machine: states, transitions, reasons."""

from collections.abc import Callable
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


def test_the_first_frames_cause_no_motion() -> None:
    machine = Safety()
    for _ in range(WARM_UP - 1):
        assert machine.frame(seen(reached=True)) is SafetyState.LIMP
    assert machine.frame(seen()) is SafetyState.REACHING


def test_the_button_acts_once_when_released() -> None:
    machine = at(SafetyState.READY)
    for _ in range(5):
        assert machine.frame(seen(chest_pressed=True)) is SafetyState.READY
    assert machine.frame(seen()) is SafetyState.WALKING
    for _ in range(5):
        assert machine.frame(seen()) is SafetyState.WALKING
    assert machine.reason == "chest button"


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


# What happens, and the states after it: of one that was limp, reaching,
# ready, walking, stopping and resting.
EVENTS: dict[str, tuple[Callable[[Safety], object], str]] = (
    {
        "nothing": (
            lambda m: m.frame(
                seen(status=1, temperature=79, tilt=0.99 * FALL)
            ),
            "limp reaching ready walking stopping resting",
        ),
        "button": (press, "reaching resting walking stopping resting resting"),
        "fall": (
            lambda m: m.frame(seen(tilt=1.01 * FALL)),
            "limp limp limp limp limp limp",
        ),
        "hot": (
            lambda m: [m.frame(seen(status=2)) for _ in range(2)],
            "limp resting resting stopping stopping resting",
        ),
        "hot by degrees": (
            lambda m: m.frame(seen(temperature=81.0)),
            "limp resting resting stopping stopping resting",
        ),
        "critical heat": (
            lambda m: m.frame(seen(status=3)),
            "limp limp limp limp limp limp",
        ),
        "failure": (
            lambda m: m.fail("no valid frame for 0.1 s", 0.0),
            "limp limp limp limp limp limp",
        ),
        "rest": (
            lambda m: m.rest("asked to", 0.0),
            "limp resting resting stopping stopping resting",
        ),
        "halted": (
            lambda m: m.halted(0.0),
            "limp reaching ready walking resting resting",
        ),
        "too late": (
            lambda m: m.frame(seen(0.1 + max(LONGEST_REACH, LONGEST_STOP))),
            "limp limp ready walking resting limp",
        ),
    }
    | {
        name: (
            lambda m, changes=changes: lasting(m, LASTING, **changes),
            "limp resting resting stopping stopping resting",
        )
        for name, (changes, _) in TO_REST.items()
    }
    | {
        name: (
            lambda m, changes=changes: lasting(m, LASTING, **changes),
            "limp reaching ready stopping stopping resting",
        )
        for name, (changes, _) in TO_STAND.items()
    }
)


@pytest.mark.parametrize("event", EVENTS)
def test_each_event_leads_from_each_state_to_a_safe_one(event: str) -> None:
    happens, after = EVENTS[event]
    for state, then in zip(SafetyState, after.split(), strict=True):
        machine = at(state)
        happens(machine)
        assert machine.state.value == then, state


def test_a_robot_that_lies_does_not_get_up_by_the_button() -> None:
    machine = at(SafetyState.LIMP)
    machine.frame(seen(tilt=1.5, chest_pressed=True))
    assert machine.frame(seen(tilt=1.5)) is SafetyState.LIMP
    assert "falls" in machine.reason
    assert press(machine) is SafetyState.REACHING


def test_a_hot_robot_that_has_rested_goes_limp_and_stays_so() -> None:
    machine = at(SafetyState.RESTING)
    for changes in ({"reached": True}, {"chest_pressed": True}, {}):
        assert machine.frame(seen(status=2, **changes)) is SafetyState.LIMP


@pytest.mark.parametrize(
    ("state", "longest", "after"),
    [
        (SafetyState.REACHING, LONGEST_REACH, SafetyState.LIMP),
        (SafetyState.RESTING, LONGEST_REACH, SafetyState.LIMP),
        (SafetyState.STOPPING, LONGEST_STOP, SafetyState.RESTING),
    ],
)
def test_what_takes_too_long_is_given_up(
    state: SafetyState, longest: float, after: SafetyState
) -> None:
    machine = at(state)
    assert machine.frame(seen(longest)) is state
    assert machine.frame(seen(longest + 0.1)) is after


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
