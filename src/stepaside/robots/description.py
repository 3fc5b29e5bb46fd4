"""Descriptions of robots: a folder with a model and a short file."""

from __future__ import annotations

import tomllib
from collections.abc import Collection, Iterable
from dataclasses import dataclass, field, fields
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING

from ..errors import ModelError

if TYPE_CHECKING:
    import mujoco

FILE = "robot.toml"


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
        accent: Material whose colour tells robots apart.
        legs: Leg joints.
        standing: Angles of a natural stance, by joint, in [rad].
        speed_limits: Greatest speed of each actuated joint, in [rad/s].
        working_limits: Narrower ranges that joint motion keeps to, in
            [rad], by joint; knees stay bent by them. Optional.
    """

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

    def mjcf(self) -> str:
        """Text of the MuJoCo model."""
        return (self.folder / self.model).read_text(encoding="utf-8")

    def spec(self) -> mujoco.MjSpec:
        """Editable MuJoCo model."""
        import mujoco

        path = self.folder / self.model
        try:
            return mujoco.MjSpec.from_file(str(path))
        except ValueError as error:
            raise ModelError(f"{path} is no MuJoCo model: {error}") from error

    def compile(self) -> mujoco.MjModel:
        """Compile the model and check that it has what is described.

        Raises:
            ModelError: If MuJoCo cannot compile it, or it lacks a body,
                site, joint or actuator.
        """
        try:
            model = self.spec().compile()
        except ValueError as error:
            path = self.folder / self.model
            raise ModelError(f"{path} does not compile: {error}") from error
        self.check(
            {model.body(i).name for i in range(model.nbody)},
            {model.site(i).name for i in range(model.nsite)},
            {model.joint(i).name for i in range(model.njnt)},
            {model.actuator(i).name for i in range(model.nu)},
        )
        return model

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


def load_robot(robot: str | Path) -> RobotDescription:
    """Load a robot by name, or from a folder.

    Args:
        robot: Name of a robot of this package, or a folder that holds
            ``robot.toml`` and the model that it names.

    Raises:
        ModelError: If there is none, or its file has unknown, missing or
            ill-typed entries.
    """
    folder = Path(str(files(__package__))) / str(robot)
    if not (folder / FILE).is_file():
        folder = Path(robot)
    if not (folder / FILE).is_file():
        raise ModelError(
            f"robot must be one of {', '.join(known_robots())} or a folder "
            f"with a {FILE}, got {str(robot)!r}"
        )
    try:
        text = (folder / FILE).read_text(encoding="utf-8")
        entries = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise ModelError(f"{folder / FILE}: {error}") from error
    names = [f.name for f in fields(RobotDescription) if f.name != "folder"]
    for key in entries:
        if key not in names:
            raise ModelError(
                f"{folder / FILE}: unknown entry {key!r}; there are "
                f"{', '.join(names)}"
            )
    for key in names:
        if key not in entries and key != "working_limits":
            raise ModelError(f"{folder / FILE}: entry {key!r} is missing")
    entries["legs"] = tuple(entries["legs"])
    return RobotDescription(folder=folder, **entries)
