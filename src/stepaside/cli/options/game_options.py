"""Options of a game: how it starts, who plays, what the evader does."""

from collections.abc import Collection
from math import inf
from typing import TYPE_CHECKING, Any

import click

from .declaration import OptionDeclaration, OptionGroup
from .strategy_type import EVADER_STRATEGY, PURSUER_STRATEGY

if TYPE_CHECKING:
    from ...sim.camera_settings import RoomObject


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


def _things() -> "dict[bool, list[RoomObject]]":
    from ...sim.camera_settings import CLUTTER

    return {True: list(CLUTTER), False: []}


SEED = OptionDeclaration(
    "--seed", "Of every random draw.", "seed", kind=click.INT
)
DURATION = OptionDeclaration("--duration", "Simulated time", "duration", "s")
ROBOT = OptionDeclaration(
    "--robot", "Robot, or the folder of its description.", "robot"
)
RUN = OptionGroup("Run", (SEED, DURATION, ROBOT))
ROBOTS = OptionGroup(
    "Robots (each with the gait and the control of its description)",
    (
        OptionDeclaration(
            "--pursuer-robot",
            "Robot of the pursuer, if it is another one than --robot.",
            "pursuer_robot",
        ),
        OptionDeclaration(
            "--evader-robot",
            "Robot of the evader, likewise.",
            "evader_robot",
        ),
    ),
)
DRAWN: dict[str, Any] = {"drawn": None}
START = OptionGroup(
    "Start (what is not given, the seed draws)",
    (
        OptionDeclaration(
            "--distance",
            "Distance {unit} between the robots.",
            "start.distance",
            "m",
            words=DRAWN,
        ),
        OptionDeclaration(
            "--pursuer-offset",
            "Heading of the pursuer from the evader",
            "start.pursuer_offset",
            "rad",
            words=DRAWN,
        ),
        OptionDeclaration(
            "--evader-offset",
            "Heading of the evader from the pursuer",
            "start.evader_offset",
            "rad",
            words=DRAWN,
        ),
    ),
)
STRATEGY = OptionGroup(
    "Strategy",
    (
        EVADER_STRATEGY,
        PURSUER_STRATEGY,
        OptionDeclaration(
            "--angle",
            "Angle {unit} of evasion: 90deg moves aside, 0 moves back.",
            "strategy.angle",
            "rad",
        ),
        OptionDeclaration(
            "--saturated/--no-saturated",
            "Whether the evader turns by (6), or by (4).",
            "strategy.saturated",
        ),
        OptionDeclaration(
            "--trigger",
            "What begins evasion: a distance, or the time until somebody who "
            "walks on would be near; time by default where a person comes "
            "and the gait is fast.",
            "strategy.trigger",
            registry=_triggers,
            tells_default=False,
        ),
        OptionDeclaration(
            "--contact-time",
            "Time {unit} to contact at which evasion begins; {default} by "
            "default.",
            "strategy.contact_time",
            "s",
        ),
        OptionDeclaration(
            "--clearance",
            "Distance {unit} that counts as contact then; {default} by "
            "default.",
            "strategy.clearance",
            "m",
        ),
        OptionDeclaration(
            "--calmest",
            "Least share of the gait's step rate at which it walks while that "
            "leaves the other room; {default} by default.",
            "strategy.calmest",
            "1",
        ),
        OptionDeclaration(
            "--safety-radius",
            "Distance {unit} at which evasion begins; {default} by default.",
            "strategy.safety_radius",
            "m",
        ),
        OptionDeclaration(
            "--release-distance",
            "Distance {unit} at which evasion ends; {default} by default.",
            "strategy.release_distance",
            "m",
            words={"never": inf},
        ),
        OptionDeclaration(
            "--side-hysteresis",
            "How far {unit} the pursuer's bearing must be past a change of "
            "sign for the evader's side to change.",
            "strategy.side_hysteresis",
            "rad",
            more_names=("--hysteresis",),
        ),
    ),
)
SENSING = OptionDeclaration(
    "--sensing",
    "Whether they are told where the other is, or see it.",
    "sensing",
    registry=_senses,
)
SIGHT = OptionGroup(
    "Sight (where they are told)",
    (
        SENSING,
        OptionDeclaration(
            "--bearing-noise",
            "Standard deviation of the bearing",
            "sight.bearing_noise",
            "rad",
        ),
        OptionDeclaration(
            "--distance-noise",
            "Standard deviation of the distance",
            "sight.distance_noise",
            "m",
        ),
        OptionDeclaration(
            "--delay", "From seeing to knowing", "sight.delay", "s"
        ),
        OptionDeclaration(
            "--rate",
            "Sightings a second",
            "sight.rate",
            "1/s",
            words={"every-tick": inf},
        ),
    ),
)
LATENCY = OptionDeclaration(
    "--camera-latency",
    "Added to that of the cameras",
    "cameras.added_latency",
    "s",
)
OPTICS = OptionDeclaration(
    "--optics",
    "Which NAO's top camera.",
    "cameras.colour.optics",
    registry=_optics,
)
SENSES = OptionGroup("Senses", (SENSING, LATENCY, OPTICS))
CAMERAS = OptionGroup(
    "Cameras and room (where they see)",
    (
        OptionDeclaration(
            "--drop-frames",
            "Share of images that never arrive",
            "cameras.drop_frames",
            "1",
        ),
        LATENCY,
        OPTICS,
        OptionDeclaration(
            "--renderer",
            "What draws the images.",
            "cameras.colour.renderer",
            registry=_renderers,
        ),
        OptionDeclaration(
            "--clutter/--no-clutter",
            "Boxes and a white figure stand about.",
            "room.things",
            registry=_things,
        ),
        OptionDeclaration(
            "--walls",
            "Distance {unit} of the walls from the middle; 0 for none.",
            "room.walls",
            "m",
        ),
    ),
)
PERSON = OptionGroup(
    "Who comes",
    (
        OptionDeclaration(
            "--pursuer",
            "Another robot, or a person.",
            "pursuer",
            registry=_pursuers,
        ),
        OptionDeclaration(
            "--person-path",
            "steer, straight, visits, or a CSV file of time,x,y.",
            "person.path",
        ),
        OptionDeclaration(
            "--person-speed", "Of the walk", "person.speed", "m/s"
        ),
        OptionDeclaration(
            "--person-gain", "Of the steering", "person.gain", "1/s"
        ),
        OptionDeclaration(
            "--person-miss",
            "How far {unit} beside the evader a straight walk aims.",
            "person.miss",
            "m",
        ),
        OptionDeclaration(
            "--person-halt-after",
            "Way {unit} after which the person stands; {default} by default.",
            "person.halt_after",
            "m",
            words={"never": inf},
        ),
        OptionDeclaration(
            "--person-turn-after",
            "Way {unit} after which the person turns; {default} by default.",
            "person.turn_after",
            "m",
            words={"never": inf},
        ),
        OptionDeclaration(
            "--person-turn", "By how much", "person.turn", "rad"
        ),
        OptionDeclaration(
            "--person-backward/--no-person-backward",
            "Whether the person walks backward.",
            "person.backward",
        ),
        OptionDeclaration(
            "--person-figure", "Who comes.", "person.figure", registry=_figures
        ),
    ),
)
