"""Options of a game: initial poses, players, strategies and sensing."""

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


def _clutter() -> "dict[bool, list[RoomObject]]":
    from ...sim.camera_settings import CLUTTER

    return {True: list(CLUTTER), False: []}


SEED = OptionDeclaration("--seed", "Random seed.", "seed", kind=click.INT)
DURATION = OptionDeclaration("--duration", "Simulated time", "duration", "s")
ROBOT = OptionDeclaration(
    "--robot", "Name of a robot, or folder of its description.", "robot"
)
RUN = OptionGroup("Run", (SEED, DURATION, ROBOT))
ROBOTS = OptionGroup(
    "Robots (each with the gait and control of its description)",
    (
        OptionDeclaration(
            "--pursuer-robot",
            "Robot of the pursuer; that of --robot by default.",
            "pursuer_robot",
        ),
        OptionDeclaration(
            "--evader-robot",
            "Robot of the evader; that of --robot by default.",
            "evader_robot",
        ),
    ),
)
DRAWN: dict[str, Any] = {"drawn": None}
START = OptionGroup(
    "Initial poses (drawn from the seed unless given)",
    (
        OptionDeclaration(
            "--distance",
            "Initial distance between the robots",
            "start.distance",
            "m",
            words=DRAWN,
        ),
        OptionDeclaration(
            "--pursuer-offset",
            "Heading of the pursuer, relative to its line of sight to the "
            "evader",
            "start.pursuer_offset",
            "rad",
            words=DRAWN,
        ),
        OptionDeclaration(
            "--evader-offset",
            "Heading of the evader, relative to its line of sight to the "
            "pursuer",
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
            "Evasion angle {unit}: 90deg moves aside, 0 moves back.",
            "strategy.angle",
            "rad",
        ),
        OptionDeclaration(
            "--saturated/--no-saturated",
            "Turn the evader by eq. (6) instead of eq. (4).",
            "strategy.saturated",
        ),
        OptionDeclaration(
            "--trigger",
            "Condition that triggers evasion: distance, or predicted time to "
            "contact.  [default: time for a person and a fast gait, else "
            "distance]",
            "strategy.trigger",
            registry=_triggers,
            shows_default=False,
        ),
        OptionDeclaration(
            "--contact-time",
            "Time to contact at which evasion begins, with --trigger time",
            "strategy.contact_time",
            "s",
        ),
        OptionDeclaration(
            "--clearance",
            "Distance {unit} that counts as contact, with --trigger time.",
            "strategy.clearance",
            "m",
        ),
        OptionDeclaration(
            "--calmest",
            "Minimum step rate, as a fraction of the gait's, when a slow "
            "evasion keeps enough clearance",
            "strategy.calmest",
            "1",
        ),
        OptionDeclaration(
            "--safety-radius",
            "Distance at which evasion begins, with --trigger distance",
            "strategy.safety_radius",
            "m",
        ),
        OptionDeclaration(
            "--release-distance",
            "Distance at which evasion ends",
            "strategy.release_distance",
            "m",
            words={"never": inf},
        ),
        OptionDeclaration(
            "--side-hysteresis",
            "Angle by which the pursuer's bearing must exceed a change of "
            "sign before the evader changes side",
            "strategy.side_hysteresis",
            "rad",
            aliases=("--hysteresis",),
        ),
    ),
)
SENSING = OptionDeclaration(
    "--sensing",
    "Sensing of opponents: true poses (ideal), or detection in simulated "
    "camera images.",
    "sensing",
    registry=_senses,
)
SIGHT = OptionGroup(
    "Sightings (--sensing ideal)",
    (
        SENSING,
        OptionDeclaration(
            "--bearing-noise",
            "Standard deviation of the bearing noise",
            "sight.bearing_noise",
            "rad",
        ),
        OptionDeclaration(
            "--distance-noise",
            "Standard deviation of the distance noise",
            "sight.distance_noise",
            "m",
        ),
        OptionDeclaration(
            "--delay", "Latency of a sighting", "sight.delay", "s"
        ),
        OptionDeclaration(
            "--rate",
            "Rate of sightings",
            "sight.rate",
            "1/s",
            words={"every-tick": inf},
        ),
    ),
)
LATENCY = OptionDeclaration(
    "--camera-latency",
    "Latency in addition to that of the camera",
    "cameras.added_latency",
    "s",
)
OPTICS = OptionDeclaration(
    "--optics",
    "NAO version whose top camera is simulated.",
    "cameras.colour.optics",
    registry=_optics,
)
SENSES = OptionGroup("Sensing", (SENSING, LATENCY, OPTICS))
CAMERAS = OptionGroup(
    "Cameras (--sensing cameras)",
    (
        OptionDeclaration(
            "--drop-frames",
            "Fraction of images that are lost",
            "cameras.drop_frames",
            "1",
        ),
        LATENCY,
        OPTICS,
        OptionDeclaration(
            "--renderer",
            "Renderer of the camera images.",
            "cameras.colour.renderer",
            registry=_renderers,
        ),
        OptionDeclaration(
            "--clutter/--no-clutter",
            "Add boxes and a white mannequin as visual distractors.",
            "room.things",
            registry=_clutter,
        ),
        OptionDeclaration(
            "--walls",
            "Distance of the visible walls from the centre {unit}; 0 for "
            "none.",
            "room.walls",
            "m",
        ),
    ),
)
PERSON = OptionGroup(
    "Pursuing person",
    (
        OptionDeclaration(
            "--pursuer",
            "Kind of pursuer.",
            "pursuer",
            registry=_pursuers,
        ),
        OptionDeclaration(
            "--person-path",
            "Path of the person: steer (pursue the evader), straight, visits "
            "(random visits), or a CSV file with columns time,x,y.",
            "person.path",
        ),
        OptionDeclaration(
            "--person-speed",
            "Walking speed of the person",
            "person.speed",
            "m/s",
        ),
        OptionDeclaration(
            "--person-gain",
            "Steering gain of the person",
            "person.gain",
            "1/s",
        ),
        OptionDeclaration(
            "--person-miss",
            "Lateral offset of a straight path from the evader",
            "person.miss",
            "m",
        ),
        OptionDeclaration(
            "--person-halt-after",
            "Path length after which the person halts",
            "person.halt_after",
            "m",
            words={"never": inf},
        ),
        OptionDeclaration(
            "--person-turn-after",
            "Path length after which the person turns",
            "person.turn_after",
            "m",
            words={"never": inf},
        ),
        OptionDeclaration(
            "--person-turn", "Angle of that turn", "person.turn", "rad"
        ),
        OptionDeclaration(
            "--person-backward/--no-person-backward",
            "Let the person walk backward.",
            "person.backward",
        ),
        OptionDeclaration(
            "--person-figure",
            "Body model of the person.",
            "person.figure",
            registry=_figures,
        ),
    ),
)
