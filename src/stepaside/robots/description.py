"""Robot description: a folder with a MuJoCo model and a TOML file."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from copy import deepcopy
from dataclasses import dataclass
from functools import lru_cache
from importlib.resources import files
from os import R_OK, access
from os.path import normpath
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..core.entries import load_entries, read_entries
from ..core.errors import AnyPath, ModelError, as_path
from ..core.player_identity import Colour
from ..core.ranges import Range
from ..core.setting import REQUIRED, check_settings, setting
from .description_types import (
    NO_OVERLAY,
    Overlay,
    ReferencePoint,
    RobotGames,
    SensorNames,
)

if TYPE_CHECKING:
    import mujoco

FILE = "robot.toml"
PUBLISHED = ("stiffness", "damping", "default_posture")
LEAN_LIMIT = 0.3  # greatest lean of a torso, in [rad]
REMEDY = "`stepaside robot init` writes an overlay that adds what is missing"


@dataclass(frozen=True, slots=True)
class RobotDescription:
    """Description of a humanoid robot: its folder, and its ``robot.toml``."""

    folder: Path
    name: str = setting(REQUIRED, "Display name")
    model: str = setting(
        REQUIRED, "File of the MuJoCo model, relative to the folder"
    )
    torso: str = setting(REQUIRED, "Body that carries the free joint")
    left_foot: str = setting(
        REQUIRED, "Site at the sole under the left ankle: the foot frame"
    )
    right_foot: str = setting(
        REQUIRED, "Site at the sole under the right ankle"
    )
    accent: str = setting(
        REQUIRED,
        "Material whose colour tells robots apart; empty to colour the torso",
    )
    legs: tuple[str, ...] = setting(REQUIRED, "Leg joints")
    standing: dict[str, float] = setting(
        REQUIRED,
        "Joint angles of the standing posture, by joint",
        Range(-100.0, 100.0, "rad", "some turns"),
    )
    speed_limits: dict[str, float] = setting(
        REQUIRED,
        "Speed limit of each actuated joint",
        Range(0.0, 1e6, "rad/s", "above zero", above=True),
    )
    working_limits: dict[str, tuple[float, float]] = setting(
        dict[str, tuple[float, float]](),
        "Joint ranges of inverse kinematics, by joint, narrower than those "
        "of the model, so that knees stay bent",
        Range(-100.0, 100.0, "rad", "some turns"),
    )
    gait: dict[str, Any] = setting(
        dict[str, Any](),
        "Gait, as in a configuration; the paper's values by default",
    )
    sole: dict[str, float] = setting(
        dict[str, float](), "Outline of the soles, likewise"
    )
    control: dict[str, Any] = setting(
        dict[str, Any](), "Walking control, likewise"
    )
    game: RobotGames = setting(
        RobotGames(), "Distances of games, and units of pushes"
    )
    sensors: SensorNames = setting(
        SensorNames(), "Names of the sensors in the model"
    )
    place: ReferencePoint = setting(
        ReferencePoint(), "Reference point and reach"
    )
    overlay: Overlay = setting(
        NO_OVERLAY, "Elements that are added to the model when it is read"
    )
    locomotion: dict[str, Any] = setting(
        dict[str, Any](),
        "Walking policy and its contract; see "
        ":mod:`stepaside.locomotion.policy.contract_reader`",
    )
    body: dict[str, Any] = setting(
        dict[str, Any](),
        "Errors of its body that differ from NAO's, in the bodies other than "
        "the ideal one; see :class:`.BodySettings`",
    )
    published: dict[str, dict[str, float]] = setting(
        dict[str, dict[str, float]](),
        "Gains and posture that its model publishes, by joint, for policies "
        f"that do not bring their own: {', '.join(PUBLISHED)}",
    )
    lean: float = setting(
        0.0,
        "Roll of the torso with the CoM over one foot, which relieves the "
        "roll joint of that hip",
        Range(0.0, LEAN_LIMIT, "rad", "beyond, it bows"),
    )

    def __post_init__(self) -> None:
        check_settings(self, ModelError)
        for name in self.published:
            if name not in PUBLISHED:
                raise ModelError(
                    f"unknown entry published.{name}; there are "
                    f"{', '.join(PUBLISHED)}"
                )
        for name, (low, high) in self.working_limits.items():
            if not low < high:
                raise ModelError(
                    f"working_limits.{name} must be [low, high] with "
                    f"low < high [rad], got [{low}, {high}]"
                )

    @property
    def path(self) -> Path:
        """File of the model."""
        return self.path_of(self.model)

    def path_of(self, name: str) -> Path:
        """Resolve a path that is relative to the folder."""
        return Path(normpath(self.folder / name))

    def mjcf(self) -> str:
        """Return the MuJoCo model with its overlay, as MJCF text."""
        if self.overlay == NO_OVERLAY:
            return self.path.read_text(encoding="utf-8")
        spec = self.spec()
        spec.compile()
        text: str = spec.to_xml()
        return text

    def spec(self, colour: Colour | None = None) -> mujoco.MjSpec:
        """Return the editable model with its overlay, and a colour."""
        import mujoco

        try:  # MuJoCo does not find includes of a relative path
            spec = mujoco.MjSpec.from_file(str(self.path.resolve()))
        except ValueError:  # as of another version
            from .model_reader import read_model

            spec = read_model(self.path)
        if self.overlay != NO_OVERLAY:
            from .model_overlay import put_overlay

            put_overlay(
                spec,
                self.overlay,
                torso=self.torso,
                feet=(self.left_foot, self.right_foot),
                sole=self.sole,
                sensors=self.sensors,
                path=self.path,
                mesh_folders=[self.path_of(x) for x in self.overlay.meshes],
            )
        if colour is not None:
            self._paint(spec, colour)
        return spec

    def _paint(self, spec: mujoco.MjSpec, colour: Colour) -> None:
        """Set the colour of the accent of a model, or of its torso."""
        if self.accent:
            accent = spec.material(self.accent)
            if accent is not None:
                accent.rgba = colour
            return
        torso = spec.body(self.torso)
        # A torso that is only a joint of others is coloured by their shapes.
        shapes = torso.geoms or [g for c in torso.bodies for g in c.geoms]
        for geom in shapes:
            geom.material, geom.rgba = "", colour

    def compile(self, colour: Colour | None = None) -> mujoco.MjModel:
        """Compile the model and check it against the description."""
        from .model_reader import motors_of

        try:
            model = self.spec(colour).compile()
        except ValueError as error:
            raise ModelError(
                f"{self.path} does not compile: {error}"
            ) from error
        self.check(
            {model.body(i).name for i in range(model.nbody)},
            {model.site(i).name for i in range(model.nsite)},
            {model.joint(i).name for i in range(model.njnt)},
            motors_of(model, self.name, REMEDY),
        )
        return model

    def check(
        self,
        bodies: Collection[str],
        sites: Collection[str],
        joints: Collection[str],
        motors: Collection[str],
    ) -> None:
        """Check that a model has all elements that the description names."""
        feet, limits = [self.left_foot, self.right_foot], self.speed_limits
        required: list[tuple[str, Iterable[str], str, Collection[str]]] = [
            ("torso", [self.torso], "body", bodies),
            ("foot", feet, "site", sites),
            ("legs", self.legs, "joint", joints),
            ("standing", self.standing, "joint", joints),
            ("working_limits", self.working_limits, "joint", joints),
            ("speed_limits", limits, "actuator", motors),
            ("actuator", motors, "speed limit", limits),
        ]
        for key, names, kind, existing in required:
            for name in names:
                if name not in existing:
                    raise ModelError(
                        f"{key} of {self.name}: there is no {kind} {name!r}; "
                        f"there are {', '.join(sorted(existing))}"
                    )


def known_robots() -> list[str]:
    """Return the names of the robots that come with the package."""
    root = files(__package__)
    return sorted(p.name for p in root.iterdir() if (p / FILE).is_file())


def load_robot(robot: AnyPath) -> RobotDescription:
    """Load a robot by name, or from a folder.

    Args:
        robot: Name of a robot of this package, or a folder with a
            ``robot.toml``; ``./nao`` is a folder.
    """
    given = as_path(robot, "robot", ModelError)
    folder = Path(str(files(__package__))) / given
    if str(robot).startswith("."):
        folder = given.absolute()
    elif not (folder / FILE).is_file():
        folder = given
    if not (folder / FILE).is_file():
        raise ModelError(
            f"robot must be one of {', '.join(known_robots())} or a folder "
            f"with a {FILE} (stepaside robot init MODEL writes one), got "
            f"{str(robot)!r}"
        )
    file = folder / FILE
    content = file.read_bytes() if access(file, R_OK) else b""
    return deepcopy(_read(folder, content))  # its tables are mutable


@lru_cache(maxsize=16)
def _read(folder: Path, content: bytes) -> RobotDescription:
    """Read a description; the content of its file says whether it changed."""
    file = folder / FILE
    entries = load_entries(file, ModelError)
    if "folder" in entries:
        raise ModelError(f"{file}: unknown entry folder")
    return read_entries(
        RobotDescription,
        entries | {"folder": folder},
        str(file),
        error=ModelError,
    )
