"""Settings of one player, and what they imply where they are left open."""

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import pi
from typing import Any, Self, TypeVar

from ..core.entries import read_entries
from ..core.errors import ConfigurationError
from ..core.player_identity import PlayerIdentity, Role
from ..core.poses import Pose
from ..core.ranges import Range
from ..core.setting import REQUIRED, check_settings, setting
from ..locomotion.control_settings import ControlSettings, LegsSettings
from ..planning import PRESETS, GaitSettings
from ..robots.description import FILE, RobotDescription, load_robot
from ..sim.body_settings import BodySettings
from ..sim.person_settings import RADIUS, CrowdSettings, PersonSettings
from ..sim.physics_settings import SightSettings
from ..strategies import Evasion, load_strategy
from ..strategies.registry import (
    OF_EVASION,
    STRATEGIES,
    check_strategy_name,
)
from ..strategies.shield_settings import ShieldSettings

MOST_PLAYERS = 32  # of one game
PLAYER_NAME = re.compile(r"[a-z][a-z0-9-]{0,31}")
PLAYERS = PURSUER, EVADER = ("pursuer", "evader")  # of a duel
WALKER = "walker"  # player of a walk
PURSUIT, EVASION, STEP_ASIDE = "pursuit", "evasion", "step-aside"
BODY_KINDS = ("robot", "unicycle", "person")
SENSING = ("ideal", "cameras", "lidar")
IDEAL = BodySettings()
NAO_RADIUS = 0.14  # within which its body stands and sways, in [m]
POSITION = Range(-100.0, 100.0, "m", "the farthest initial distance")
TURN = Range(-2.0 * pi, 2.0 * pi, "rad", "a turn")
STRATEGY_NAMES = (
    f"{', '.join(STRATEGIES)}, with arguments like pursuit(gain=2), "
    "FILE.py:NAME for your own, or FILE.onnx for a learned one"
)
ALWAYS = {"name", "role", "team", "body", "target", "start"}
OF_TEMPLATE = {
    *("robot", "gait", "strategy", "evasion", "shield", "goal", "draws_goal")
}
USED_BY = {  # settings of a player that its kind of body uses
    "robot": ALWAYS | OF_TEMPLATE | {"control", "legs", "senses", "sight"},
    "unicycle": ALWAYS | OF_TEMPLATE,
    "person": ALWAYS | {"goal", "draws_goal", "person", "crowd"},
}


# Template of learned legs: speed [m/s], gain [1/s], and 0.4 s from decision to
# decision, in path time as in gait time. Their CoM is over the feet.
LEGS_GAIT: Mapping[str, Any] = {
    "speed": 0.5,
    "gain": 0.4,
    "stride": 0.2,
    "single_support": 0.3,
    "double_support": 0.1,
    "zmp_forward": 0.0,
}
PRESET = ""  # name of a preset among the entries that change it


@dataclass(frozen=True, slots=True, kw_only=True)
class RobotSettings:
    """Settings of a robot that plays: its gait, control and strategy."""

    robot: str = setting(
        "nao", "Name of a robot, or folder of its description"
    )
    gait: GaitSettings = setting(
        GaitSettings(), "Gait of a robot or a unicycle", presets=PRESETS
    )
    control: ControlSettings = setting(
        ControlSettings(), "Walking control of a robot"
    )
    legs: LegsSettings = setting(
        LegsSettings(), "Learned legs of a robot", needs=("body", "robot")
    )
    strategy: str = setting(
        "",
        "Strategy of a robot or a unicycle: "
        f"{STRATEGY_NAMES}; if empty, it walks to its goal if "
        "it has one, steps aside for people if it evades on learned legs, and "
        "else plays that of the paper for its role; a bystander stands",
        default_text="that of the paper; step-aside on learned legs against "
        "a person",
    )
    evasion: Evasion = setting(
        Evasion(),
        "Settings of the paper's evasion strategy",
        needs=("strategy", EVASION),
    )
    shield: ShieldSettings = setting(
        ShieldSettings(), "Shield of the player", needs=("shield.enabled", "")
    )

    def resolved_as(
        self,
        role: str,
        body: BodySettings = IDEAL,
        *,
        person: bool = False,
        walks: bool = True,
    ) -> Self:
        """Return the robot with strategy, trigger and control.

        A person may be an opponent; learned legs do not walk without physics.
        """
        strategy, evasion = self.strategy, self.evasion
        if not strategy and role == EVADER:
            # Learned legs step to every side.
            aside = person and walks and bool(self.legs.network)
            strategy = STEP_ASIDE if aside else EVASION
        elif not strategy:
            strategy = PURSUIT if role == PURSUER else "stand"
        elif strategy.startswith(f"{EVASION}("):
            made = load_strategy(strategy, evasion)
            assert isinstance(made, Evasion)
            strategy, evasion = EVASION, made
        if strategy in OF_EVASION and evasion.trigger is None:
            # People walk at any speed, and a distance suits only one: a robot
            # that is fast enough evades them by time to contact.
            soon = person and self.gait.is_fast
            evasion = replace(evasion, trigger="time" if soon else "distance")
        feedback, method = self.control.feedback, self.control.method
        fast = self.gait.is_fast
        if feedback is False and method in ("measured", "mpc"):
            raise ConfigurationError(
                f"control.method {method!r} needs feedback = true, got false"
            )
        if feedback is None:  # plans from the measured state need it, too
            planned = method in (None, "closed-form")
            feedback = fast or body != IDEAL or not planned
        if method is None:
            method = "measured" if feedback and not fast else "closed-form"
        control = replace(self.control, method=method, feedback=feedback)
        return replace(
            self, strategy=strategy, evasion=evasion, control=control
        )


@dataclass(frozen=True, slots=True)
class PlayerSettings(RobotSettings):
    """Settings of one player."""

    name: str = setting(
        REQUIRED, "Name of the player: lower case, digits and hyphens"
    )
    role: str = setting(
        "bystander", "Role of the player", names=tuple(r.value for r in Role)
    )
    team: str = setting("", "Team of the player; that of its role if empty")
    body: str = setting(
        "robot",
        "Body of the player: a robot, its template unicycle, or a person",
        names=BODY_KINDS,
    )
    target: str = setting(
        "",
        "Name of the player that it plays against; the nearest opponent if "
        "empty",
    )
    start: tuple[float, ...] = setting(
        (),
        "Initial position (x, y) [m] and heading [rad] in the world; drawn "
        "from the seed if empty, and in a duel that of the game's start",
    )
    goal: tuple[float, ...] = setting(
        (), "Position (x, y) in the world that the player walks to [m]"
    )
    draws_goal: bool = setting(
        False,
        "Draw the goal from the seed, at least a third of the longer side "
        "of the room away from the start",
    )
    senses: str = setting(
        "ideal",
        "Sensing of other players by a robot: true poses (ideal), or "
        "detection in simulated camera images, or of people in the scans of "
        "a simulated lidar",
        names=SENSING,
    )
    sight: SightSettings = setting(
        SightSettings(), "Errors of ideal sensing", needs=("senses", "ideal")
    )
    person: PersonSettings = setting(
        PersonSettings(),
        "Motion of a person without a goal",
        needs=("body", "person"),
    )
    crowd: CrowdSettings = setting(
        CrowdSettings(),
        "Motion of a person with a goal",
        needs=("body", "person"),
    )

    def __post_init__(self) -> None:
        """Validate ranges, name and combinations of settings."""
        if not isinstance(self.name, str) or not PLAYER_NAME.fullmatch(
            self.name
        ):
            raise ConfigurationError(
                "player name must be lower case letters, digits and hyphens, "
                f"at most 32, got {self.name!r:.40}"
            )
        check_settings(self)
        if self.strategy:
            check_strategy_name(self.strategy, recorded=True)
        for name, count in (("start", 3), ("goal", 2)):
            values = getattr(self, name)
            if len(values) not in (0, count):
                raise ConfigurationError(
                    f"{name} must have {count} numbers, got {len(values)}"
                )
            for value, allowed in zip(
                values, (POSITION, POSITION, TURN), strict=False
            ):
                allowed.check(value, name)

    @property
    def identity(self) -> PlayerIdentity:
        """Name, role and team."""
        return PlayerIdentity(
            self.name, Role(self.role), self.team or self.role
        )

    @property
    def pose(self) -> Pose | None:
        """Initial pose in the world; None if it is drawn."""
        return Pose(*self.start) if self.start else None

    @property
    def radius(self) -> float:
        """Radius of the body among people, in [m].

        That of a robot is NAO's, relative to the heights of their CoM.
        """
        if self.body == "person":
            return RADIUS
        return NAO_RADIUS * load_robot(self.robot).game.length_unit

    @property
    def decides(self) -> bool:
        """Whether it has a strategy: a robot or a unicycle."""
        return self.body in ("robot", "unicycle")

    def resolved(
        self,
        body: BodySettings = IDEAL,
        *,
        person: bool = False,
        walks: bool = True,
    ) -> Self:
        """Return the player with nothing left open; see the base."""
        if not self.decides:
            return self
        own = self
        if not self.strategy and (self.goal or self.draws_goal):
            own = replace(self, strategy="goal")
        return own.resolved_as(self.role, body, person=person, walks=walks)


def settings_from_description(description: RobotDescription) -> RobotSettings:
    """Return robot, gait, control, legs and safety radius of a description."""
    source = str(description.folder / FILE)
    gait: dict[str, Any] = dict(description.gait)
    network = description.locomotion.get("network", "")
    if network:
        network = str(description.path_of(network))
        gait |= LEGS_GAIT
    if description.sole:
        gait["sole"] = dict(description.sole)
    return RobotSettings(
        robot=str(description.folder),
        gait=read_entries(GaitSettings, gait, f"{source}, gait"),
        control=read_entries(
            ControlSettings, dict(description.control), f"{source}, control"
        ),
        legs=LegsSettings(network),
        evasion=Evasion(safety_radius=description.game.safety_radius),
    )


def nested(
    changes: Mapping[str, Any], below: Mapping[str, Any] | None = None
) -> dict[str, Any]:
    """Return nested entries with changes by name with dots.

    A preset, like ``body = "hardware"``, below changes of its entries
    becomes the entry with an empty name among them.
    """
    found = dict(below or {})
    for name, value in changes.items():
        head, dot, rest = name.partition(".")
        if dot or isinstance(value, dict):
            own = found.get(head, {})
            own = own if isinstance(own, dict) else {PRESET: own}
            found[head] = nested({rest: value} if dot else value, own)
        else:
            found[head] = value
    return found


def settings_of(
    kind: type[Any],
    entries: Mapping[str, Any],
    source: str = "",
    *,
    base: Any = None,
) -> Any:
    """Return settings from nested entries.

    ``robot`` and ``legs.network`` bring gait and control of the robot, and
    ``gait`` may be the name of a preset.
    """
    left = dict(entries)
    base = kind() if base is None else base
    if isinstance(base, RobotSettings):
        if isinstance(left.get("robot"), str):
            base = _with_robot(base, left["robot"])
        legs = left.get("legs", {})
        if isinstance(legs, Mapping) and legs.get("network"):
            base = replace(base, gait=replace(base.gait, **LEGS_GAIT))
    if hasattr(base, "gait") and (
        preset := take_preset(left, "gait", PRESETS)
    ):
        robot = getattr(base, "robot", "nao")
        brought = settings_from_description(load_robot(robot)).gait
        if brought != PRESETS["nao"]:
            raise ConfigurationError(
                f"gait {preset} requires a robot with NAO's gait: its lengths "
                f"and times are NAO's, but {robot} has its own"
            )
        base = replace(base, gait=PRESETS[preset])
    return read_entries(kind, left, source, base=base)


R = TypeVar("R", bound=RobotSettings)


def _with_robot(base: R, robot: str) -> R:
    """Return settings with gait, control, legs and radius of a robot."""
    own = settings_from_description(load_robot(robot))
    control, radius = own.control, own.evasion.safety_radius
    if not control.feedback:  # the robot needs none, but a body may
        control = replace(control, method=None, feedback=None)
    return replace(
        base,
        robot=robot,
        gait=own.gait,
        control=control,
        legs=own.legs,
        evasion=replace(base.evasion, safety_radius=radius),
    )


def take_preset(
    entries: dict[str, Any], name: str, presets: Mapping[str, Any]
) -> str:
    """Return the preset that an entry names, which leaves its changes."""
    given = entries.get(name)
    changes = dict(given) if isinstance(given, Mapping) else {}
    preset = changes.pop(PRESET, given)
    if not isinstance(preset, str) or preset not in presets:
        return ""
    entries[name] = changes
    return preset
