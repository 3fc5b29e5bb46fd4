"""Public functions and classes, called with invalid arguments."""

import warnings
from collections.abc import Callable, Iterator, Mapping
from dataclasses import fields, is_dataclass
from pathlib import Path
from random import Random
from typing import Any

import numpy as np

import stepaside
from stepaside import Direction, Foot, GaitSettings, RelativeStart
from stepaside.core.errors import StepAsideError
from stepaside.core.ranges import Range
from stepaside.core.setting import ranges_of

from .case import Case
from .values import any_value, around

PLAN: dict[str, Any] = {
    "bearing": 0.3,
    "direction": Direction.BACKWARD,
    "first_foot": Foot.LEFT,
    "standing": True,
}
GAME: dict[str, Any] = {
    "pursuer_speed": 1.0,
    "evader_speed": 1.0,
    "pursuer_gain": 0.5,
    "evader_gain": 0.5,
    "angle": 1.5,
}
START = {"distance": 2.0, "pursuer_error": 0.2, "bearing": -0.1}


def _planner() -> Any:
    return stepaside.ManeuverPlanner(GaitSettings())


def _sample(times: Any) -> Any:
    return _planner().plan(**PLAN).sample(times).com


def _simulate(duration: Any, capture_distance: Any) -> Any:
    game: Any = stepaside.make_game(**GAME)
    start = RelativeStart(2.0, 0.2, -0.1)
    run = stepaside.simulate(
        game, start, duration, capture_distance=capture_distance
    )
    return run.closest_distance


def _play(starts: Any, duration: Any, step: Any) -> Any:
    game: Any = stepaside.make_game(**GAME)
    return stepaside.play_games(
        game, starts, duration, step=step
    ).closest_distance


# Functions of the door, with what they should be given; settings are found.
CALLS: Mapping[str, tuple[Callable[..., Any], Mapping[str, Any]]] = {
    "plan": (lambda **given: _planner().plan(**given).margin(), PLAN),
    "plan.sample": (_sample, {"times": [0.0, 0.1]}),
    "make_game": (lambda **given: stepaside.make_game(**given), GAME),
    "find_circle": (
        lambda **given: stepaside.find_circle(**given).exists,
        GAME,
    ),
    "RelativeStart": (lambda **given: RelativeStart(**given), START),
    "certify": (
        lambda **given: stepaside.certify(
            stepaside.make_game(**GAME, side_rule="latched"),
            RelativeStart(**given),
        ),
        START,
    ),
    "play_games": (
        _play,
        {"starts": [[2.0, 0.2, -0.1]], "duration": 1.0, "step": 0.1},
    ),
    "simulate": (_simulate, {"duration": 1.0, "capture_distance": 1e-6}),
    "load_robot": (lambda name: stepaside.load_robot(name), {"name": "nao"}),
    "load_run": (
        lambda folder: stepaside.load_run(folder),
        {"folder": Path("none")},
    ),
    "load_strategy": (
        lambda name: stepaside.load_strategy(name),
        {"name": "evasion"},
    ),
    "load_configuration": (
        lambda path: stepaside.load_configuration(path),
        {"path": Path("none")},
    ),
    "Push": (
        lambda **given: stepaside.Push(**given),
        {"impulse": 1.0, "time": 1.0, "direction": 0.0},
    ),
}


def call_cases(random: Random, _: Path) -> Iterator[Case]:
    """Yield calls with invalid arguments, without end."""
    known = [(name, arg) for name, (_, good) in CALLS.items() for arg in good]
    own = [
        (kind, field.name)
        for kind in map(vars_of_door, stepaside.__all__)
        if isinstance(kind, type) and is_dataclass(kind)
        for field in fields(kind)
        if field.name in ranges_of(kind) or isinstance(field.default, bool)
    ]
    while True:
        name, arg = random.choice(known)
        yield _call(name, arg, any_value(random))
        kind, field = random.choice(own)
        allowed = ranges_of(kind).get(field)
        value = any_value(random)
        if allowed is not None and random.random() < 0.3:
            value = float(random.choice(around(allowed)))
        yield _setting(kind, field, value, allowed)


def vars_of_door(name: str) -> Any:
    """Return the object of a public name."""
    return getattr(stepaside, name)


def _call(name: str, arg: str, value: Any) -> Case:
    call, good = CALLS[name]

    def run(_: Path) -> str:
        number = isinstance(good[arg], float | list)
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                found = call(**{**good, arg: value})
        except StepAsideError as error:
            return "" if len(str(error)) < 1000 else "more than a line"
        except (TypeError, AttributeError) as error:
            return "" if not number else f"no words of ours: {error!r}"
        numbers = found if isinstance(found, float | np.ndarray) else 0.0
        finite = bool(np.isfinite(numbers).all())
        return "" if finite else f"accepted nonsense: {found}"

    return Case("calls", f"{name}({arg}={_short(value)})", run)


def _setting(kind: Any, name: str, value: Any, allowed: Range | None) -> Case:
    def run(_: Path) -> str:
        try:
            kind(**{name: value})
        except StepAsideError as error:
            return "" if len(str(error)) < 1000 else "more than a line"
        except TypeError as error:
            needs = "required" in str(error)  # a class without defaults
            return "" if needs else f"no words of ours: {error}"
        good = (
            isinstance(value, bool)
            if allowed is None
            else allowed.holds(value)
        )
        return "" if good else "accepted nonsense"

    return Case("calls", f"{kind.__name__}({name}={_short(value)})", run)


def _short(value: Any) -> str:
    if isinstance(value, int) and abs(value) > 2**64:
        return "an integer of many digits"
    return repr(value)[:60]
