"""Descriptions of robots: a folder with a model and a short file."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import dataclass, field
from importlib.resources import files
from os.path import normpath
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..core.brief_repr import brief_repr
from ..core.errors import AnyPath, ModelError, as_path
from .description_file import read_entries
from .description_types import NO_OVERLAY, Overlay, ReferencePoint, SensorNames

if TYPE_CHECKING:
    import mujoco

FILE = "robot.toml"
REMEDY = "`stepaside robot init` writes an overlay that mends a model"


@dataclass(frozen=True, slots=True)
class RobotDescription:
    """A humanoid, as its folder describes it.

    Attributes:
        folder: Folder of the description.
        name: What people call it.
        model: File of its MuJoCo model in the folder.
        torso: Body that carries the free joint.
        left_foot: Site at the sole under the left ankle: the foot frame.
        right_foot: Site at the sole under the right ankle.
        accent: Material whose colour tells robots apart; empty if there is
            none, and the torso is coloured.
        legs: Leg joints.
        standing: Angles of a natural stance, by joint, in [rad].
        speed_limits: Greatest speed of each actuated joint, in [rad/s].
        working_limits: Narrower ranges that joint motion keeps to, in
            [rad], by joint; knees stay bent by them. Optional.
        gait: How it walks, as the gait of a configuration is written;
            what is left out is the paper's.
        sole: Outline of its soles, likewise.
        control: How it is controlled, likewise.
        game: Distances of its games, and its unit of pushes; see
            :class:`stepaside.games.robot_settings.RobotGameSettings`.
        sensors: Its sensors, by the names in the model.
        place: The point that stands for it, and how far it reaches.
        overlay: What is put on the model when it is read.
        lean: Roll of the torso towards a foot that the CoM is right over,
            in [rad]: it relieves the roll joint of that hip; 0 to 0.3.
    """

    __repr__ = brief_repr

    folder: Path
    name: str
    model: str
    torso: str
    left_foot: str
    right_foot: str
    accent: str
    legs: tuple[str, ...]
    standing: dict[str, float]
    speed_limits: dict[str, float]
    working_limits: dict[str, tuple[float, float]] = field(
        default_factory=dict
    )
    gait: dict[str, Any] = field(default_factory=dict)
    sole: dict[str, float] = field(default_factory=dict)
    control: dict[str, Any] = field(default_factory=dict)
    game: dict[str, float] = field(default_factory=dict)
    sensors: SensorNames = SensorNames()
    place: ReferencePoint = ReferencePoint()
    overlay: Overlay = NO_OVERLAY
    lean: float = 0.0

    @property
    def path(self) -> Path:
        """File of the model."""
        return self.path_of(self.model)

    def path_of(self, name: str) -> Path:
        """A path as the file of the description names it."""
        return Path(normpath(self.folder / name))

    def mjcf(self) -> str:
        """Text of the MuJoCo model, with what the overlay puts on it."""
        if self.overlay == NO_OVERLAY:
            return self.path.read_text(encoding="utf-8")
        spec = self.spec()
        spec.compile()
        text: str = spec.to_xml()
        return text

    def spec(self) -> mujoco.MjSpec:
        """Editable MuJoCo model, with what the overlay puts on it.

        Raises:
            ModelError: If the file is no model, or lacks what the overlay
                is put on.
        """
        from .model_reader import read_model

        try:
            spec = read_model(self.path)
        except ValueError as error:
            raise ModelError(
                f"{self.path} is no MuJoCo model: {error}"
            ) from error
        if self.overlay != NO_OVERLAY:
            from .model_overlay import put_overlay

            put_overlay(spec, self)
        return spec

    def compile(self) -> mujoco.MjModel:
        """Compile the model and check that it has what is described.

        Raises:
            ModelError: If MuJoCo cannot compile it, or it lacks a body,
                site, joint or actuator.
        """
        try:
            model = self.spec().compile()
        except ValueError as error:
            raise ModelError(
                f"{self.path} does not compile: {error}"
            ) from error
        self.check(
            {model.body(i).name for i in range(model.nbody)},
            {model.site(i).name for i in range(model.nsite)},
            {model.joint(i).name for i in range(model.njnt)},
            self._motors(model),
        )
        return model

    def _motors(self, model: mujoco.MjModel) -> set[str]:
        """Joints that have an actuator, by name.

        Raises:
            ModelError: If one has several, or an actuator moves no joint.
        """
        import mujoco

        motors: set[str] = set()
        for i in range(model.nu):
            if model.actuator_trntype[i] != mujoco.mjtTrn.mjTRN_JOINT:
                raise ModelError(
                    f"actuator {model.actuator(i).name!r} of {self.name} "
                    f"must move a joint; {REMEDY}"
                )
            joint = model.joint(model.actuator_trnid[i, 0]).name
            if joint in motors:
                raise ModelError(
                    f"joint {joint!r} of {self.name} must have one actuator, "
                    f"got several; {REMEDY}"
                )
            motors.add(joint)
        return motors

    def coupled_joints(self, model: mujoco.MjModel) -> dict[str, str]:
        """Joints that share a motor, as follower to leader.

        They are the equality constraints that say joint1 = joint2.

        Args:
            model: Compiled model of this robot alone.
        """
        import mujoco

        coupled = {}
        for i in range(model.neq):
            if model.eq_type[i] != mujoco.mjtEq.mjEQ_JOINT:
                continue
            follower = model.joint(model.eq_obj1id[i]).name
            leader = model.joint(model.eq_obj2id[i]).name
            if model.eq_data[i, :5].tolist() != [0.0, 1.0, 0.0, 0.0, 0.0]:
                raise ModelError(
                    f"joints {follower} and {leader} of {self.name} must be "
                    "coupled with polycoef 0 1 0 0 0, "
                    f"got {model.eq_data[i, :5].tolist()}"
                )
            coupled[follower] = leader
        return coupled

    def check(
        self,
        bodies: Collection[str],
        sites: Collection[str],
        joints: Collection[str],
        motors: Collection[str],
    ) -> None:
        """Check that a model has what is described.

        Args:
            bodies: Names of its bodies.
            sites: Names of its sites.
            joints: Names of its joints.
            motors: Names of its actuators.

        Raises:
            ModelError: If a body, site, joint or actuator is missing; names
                those that there are.
        """
        self._require("torso", [self.torso], "body", bodies)
        feet = [self.left_foot, self.right_foot]
        self._require("foot", feet, "site", sites)
        self._require("legs", self.legs, "joint", joints)
        self._require("standing", self.standing, "joint", joints)
        self._require("working_limits", self.working_limits, "joint", joints)
        self._require("speed_limits", self.speed_limits, "actuator", motors)
        self._require("actuator", motors, "speed limit", self.speed_limits)

    def _require(
        self,
        key: str,
        wanted: Iterable[str],
        kind: str,
        existing: Collection[str],
    ) -> None:
        for name in wanted:
            if name not in existing:
                raise ModelError(
                    f"{key} of {self.name}: there is no {kind} {name!r}; "
                    f"there are {', '.join(sorted(existing))}"
                )


def known_robots() -> list[str]:
    """Names of the robots that come with the package."""
    root = files(__package__)
    return sorted(p.name for p in root.iterdir() if (p / FILE).is_file())


def _is_file(path: Path) -> bool:
    """Whether a file is there; what can be no name of one is none."""
    try:
        return path.is_file()
    except (OSError, ValueError):
        return False


def load_robot(robot: AnyPath) -> RobotDescription:
    """Load a robot by name, or from a folder.

    Args:
        robot: Name of a robot of this package, or a folder that holds
            ``robot.toml`` and the model that it names.

    Raises:
        ModelError: If there is none, or its file has unknown, missing or
            ill-typed entries.
    """
    given = as_path(robot, "robot", ModelError)
    folder = Path(str(files(__package__))) / given
    if not _is_file(folder / FILE):
        folder = given
    if not _is_file(folder / FILE):
        raise ModelError(
            f"robot must be one of {', '.join(known_robots())} or a folder "
            f"with a {FILE}, got {str(robot)!r}"
        )
    return RobotDescription(folder=folder, **read_entries(folder / FILE))
