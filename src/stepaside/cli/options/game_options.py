"""Options of a game: how it starts, who plays, what the evader does."""

from collections.abc import Collection
from math import inf
from typing import TYPE_CHECKING, Any

import click

from .declaration import Declaration, Group
from .strategy_type import EVADER_STRATEGY, PURSUER_STRATEGY

if TYPE_CHECKING:
    from ...sim.camera_settings import Thing


def _senses() -> Collection[str]:
    from ...games.duel_settings import SENSING

    return SENSING


def _triggers() -> Collection[str]:
    from ...strategies.evasion import TRIGGERS

    return TRIGGERS


def _pursuers() -> Collection[str]:
    from ...sim.person_settings import PURSUERS

    return PURSUERS


def _figures() -> Collection[str]:
    from ...sim.pedestrian_models import FIGURES

    return tuple(FIGURES)


def _optics() -> Collection[str]:
    from ...sim.camera_settings import OPTICS

    return tuple(OPTICS)


def _renderers() -> Collection[str]:
    from ...sim.camera_settings import RENDERERS

    return RENDERERS


def _things() -> "dict[bool, list[Thing]]":
    from ...sim.camera_settings import CLUTTER

    return {True: list(CLUTTER), False: []}


SEED = Declaration("--seed", "Of every random draw.", "seed", kind=click.INT)
DURATION = Declaration("--duration", "Simulated time", "duration", "s")
ROBOT = Declaration(
    "--robot", "Robot, or the folder of its description.", "robot"
)
RUN = Group("Run", (SEED, DURATION, ROBOT))
ROBOTS = Group(
    "Robots (each with the gait and the control of its description)",
    (
        Declaration(
            "--pursuer-robot",
            "Robot of the pursuer, if it is another one than --robot.",
            "pursuer_robot",
        ),
        Declaration(
            "--evader-robot",
            "Robot of the evader, likewise.",
            "evader_robot",
        ),
    ),
)
DRAWN: dict[str, Any] = {"drawn": None}
START = Group(
    "Start (what is not given, the seed draws)",
    (
        Declaration(
            "--distance",
            "Distance {unit} between the robots.",
            "start.distance",
            "m",
            words=DRAWN,
        ),
        Declaration(
            "--pursuer-offset",
            "Heading of the pursuer from the evader",
            "start.pursuer_offset",
            "rad",
            words=DRAWN,
        ),
        Declaration(
            "--evader-offset",
            "Heading of the evader from the pursuer",
            "start.evader_offset",
            "rad",
            words=DRAWN,
        ),
    ),
)
STRATEGY = Group(
    "Strategy",
    (
        EVADER_STRATEGY,
        PURSUER_STRATEGY,
        Declaration(
            "--angle",
            "Angle {unit} of evasion: 90deg moves aside, 0 moves back.",
            "strategy.angle",
            "rad",
        ),
        Declaration(
            "--saturated/--no-saturated",
            "Whether the evader turns by (6), or by (4).",
            "strategy.saturated",
        ),
        Declaration(
            "--trigger",
            "What begins evasion: a distance, or the time until somebody who "
            "walks on would be near; time by default where a person comes "
            "and the gait is fast.",
            "strategy.trigger",
            registry=_triggers,
            tells_default=False,
        ),
        Declaration(
            "--contact-time",
            "Time {unit} to contact at which evasion begins; {default} by "
            "default.",
            "strategy.contact_time",
            "s",
        ),
        Declaration(
            "--clearance",
            "Distance {unit} that counts as contact then; {default} by "
            "default.",
            "strategy.clearance",
            "m",
        ),
        Declaration(
            "--calmest",
            "Least share of the gait's step rate at which it walks while that "
            "leaves the other room; {default} by default.",
            "strategy.calmest",
            "1",
        ),
        Declaration(
            "--safety-radius",
            "Distance {unit} at which evasion begins; {default} by default.",
            "strategy.safety_radius",
            "m",
        ),
        Declaration(
            "--release-distance",
            "Distance {unit} at which evasion ends; {default} by default.",
            "strategy.release_distance",
            "m",
            words={"never": inf},
        ),
        Declaration(
            "--side-hysteresis",
            "How far {unit} the pursuer's bearing must be past a change of "
            "sign for the evader's side to change.",
            "strategy.side_hysteresis",
            "rad",
            more_names=("--hysteresis",),
        ),
    ),
)
SENSING = Declaration(
    "--sensing",
    "Whether they are told where the other is, or see it.",
    "sensing",
    registry=_senses,
)
SIGHT = Group(
    "Sight (where they are told)",
    (
        SENSING,
        Declaration(
            "--bearing-noise",
            "Standard deviation of the bearing",
            "sight.bearing_noise",
            "rad",
        ),
        Declaration(
            "--distance-noise",
            "Standard deviation of the distance",
            "sight.distance_noise",
            "m",
        ),
        Declaration("--delay", "From seeing to knowing", "sight.delay", "s"),
        Declaration(
            "--rate",
            "Sightings a second",
            "sight.rate",
            "1/s",
            words={"every-tick": inf},
        ),
    ),
)
LATENCY = Declaration(
    "--camera-latency",
    "Added to that of the cameras",
    "cameras.added_latency",
    "s",
)
OPTICS = Declaration(
    "--optics",
    "Which NAO's top camera.",
    "cameras.colour.optics",
    registry=_optics,
)
SENSES = Group("Senses", (SENSING, LATENCY, OPTICS))
CAMERAS = Group(
    "Cameras and room (where they see)",
    (
        Declaration(
            "--drop-frames",
            "Share of images that never arrive",
            "cameras.drop_frames",
            "1",
        ),
        LATENCY,
        OPTICS,
        Declaration(
            "--renderer",
            "What draws the images.",
            "cameras.colour.renderer",
            registry=_renderers,
        ),
        Declaration(
            "--clutter/--no-clutter",
            "Boxes and a white figure stand about.",
            "room.things",
            registry=_things,
        ),
        Declaration(
            "--walls",
            "Distance {unit} of the walls from the middle; 0 for none.",
            "room.walls",
            "m",
        ),
    ),
)
PERSON = Group(
    "Who comes",
    (
        Declaration(
            "--pursuer",
            "Another robot, or a person.",
            "pursuer",
            registry=_pursuers,
        ),
        Declaration(
            "--person-path",
            "steer, straight, visits, or a CSV file of time,x,y.",
            "person.path",
        ),
        Declaration("--person-speed", "Of the walk", "person.speed", "m/s"),
        Declaration("--person-gain", "Of the steering", "person.gain", "1/s"),
        Declaration(
            "--person-miss",
            "How far {unit} beside the evader a straight walk aims.",
            "person.miss",
            "m",
        ),
        Declaration(
            "--person-halt-after",
            "Way {unit} after which the person stands; {default} by default.",
            "person.halt_after",
            "m",
            words={"never": inf},
        ),
        Declaration(
            "--person-turn-after",
            "Way {unit} after which the person turns; {default} by default.",
            "person.turn_after",
            "m",
            words={"never": inf},
        ),
        Declaration("--person-turn", "By how much", "person.turn", "rad"),
        Declaration(
            "--person-backward/--no-person-backward",
            "Whether the person walks backward.",
            "person.backward",
        ),
        Declaration(
            "--person-figure", "Who comes.", "person.figure", registry=_figures
        ),
    ),
)
