"""Static folder with a page on which a duel is played in the browser."""

import json
import subprocess
import tarfile
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from shutil import which
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any, cast

from ..core.atomic_output import atomic_draft, check_folder
from ..core.errors import ConfigurationError
from ..games.duel import Duel, run_duel
from ..games.duel_circle import circle_of_theory
from ..games.duel_settings import DuelSettings
from ..games.policy_player import PolicyPlayer
from ..robots.description import load_robot
from ..robots.tree_cache import load_tree
from .game_script import check_playable, game_data, game_script
from .replay_page import SHARED, page_data, template
from .text_escaping import fill_page

if TYPE_CHECKING:
    from ..games.walker import RobotPlayer

ENGINE = "@mujoco/mujoco@3.14.0"  # the version that the tests play with
ENGINE_FILES = ("mujoco.js", "mujoco.wasm")
RUNTIME = "onnxruntime-web@1.30.0"  # for robots on learned legs
RUNTIME_FILES = (
    "dist/ort.wasm.min.mjs",
    "dist/ort-wasm-simd-threaded.mjs",
    "dist/ort-wasm-simd-threaded.wasm",
)
RECORDED = 20.0  # duration of the recording, in [s]
FOOTPRINTS = 400  # that are drawn of each player
PATIENCE = 300.0  # for the package, in [s]
NOTICE = """\
mujoco.js and mujoco.wasm: MuJoCo's WebAssembly build, {engine} on npm,
Apache License 2.0, Google DeepMind.
three.js, within index.html: MIT license; its notice stands before it.
"""
RUNTIME_NOTICE = """\
ort*: ONNX Runtime, {runtime} on npm, MIT license, Microsoft.
"""


def write_game_page(
    settings: DuelSettings,
    folder: Path,
    package: Path | None = None,
    runtime: Path | None = None,
) -> None:
    """Write the page of a duel.

    Args:
        settings: Settings of the duel; the page shows it as a recording
            until the game has loaded.
        folder: Folder of the page; made if it does not exist.
        package: Package of MuJoCo's WebAssembly build as npm packs it;
            fetched by npm if not given.
        runtime: Likewise ONNX Runtime, for robots on learned legs.

    Raises:
        ConfigurationError: If a page cannot play the duel, or npm or a
            package is missing.
        OutputError: If a file cannot be written.
    """
    check_playable(settings)
    check_folder(folder, new=False)
    legs = settings.robot_of("pursuer").legs.walks
    page = template("play.html", (*SHARED, "game.js", "legs.js", "play.js"))
    notice = NOTICE.format(engine=ENGINE)
    with TemporaryDirectory() as name:
        temporary = Path(name)
        files = packed_files(
            package or fetch_package(temporary, ENGINE), ENGINE, ENGINE_FILES
        )
        if legs:
            notice += RUNTIME_NOTICE.format(runtime=RUNTIME)
            files |= packed_files(
                runtime or fetch_package(temporary, RUNTIME),
                *(RUNTIME, RUNTIME_FILES),
            )
    duel = Duel(settings)
    script, data = game_script(duel), game_data(duel)
    page = page.replace('"use strict";\n', f'"use strict";\n{script}\n', 1)
    run = run_duel(replace(settings, duration=RECORDED))
    recorded = page_data(run) | template_data(duel)
    contents = {
        "index.html": fill_page(page, {"NAME": "play"}, recorded).encode(),
        "game.json": json.dumps(data, allow_nan=False).encode(),
        "NOTICE.txt": notice.encode(),
        **files,
    }
    folder.mkdir(parents=True, exist_ok=True)
    for name, content in contents.items():
        with atomic_draft(folder / name) as draft:
            draft.write_bytes(content)


def template_data(duel: Duel) -> dict[str, Any]:
    """Return the values of a page that depend on the robots."""
    settings, first = duel.settings, cast("RobotPlayer", duel.pursuer)
    gait, robot = first.scheme.gait, settings.robot_of("pursuer").robot
    circle = circle_of_theory(settings)
    radius = circle.radius_evader_m if circle.exists else None
    mass = load_tree(load_robot(robot)).mass
    return {
        "footprints": 0 if isinstance(first, PolicyPlayer) else FOOTPRINTS,
        "circle": radius and [0.0, 0.0, radius],
        "template": {
            "speed": gait.speed,
            "gain": gait.gain,
            "near": settings.start.near,
            "far": settings.start.far,
            "weight": mass / load_tree(load_robot("nao")).mass,
        },
    }


def fetch_package(folder: Path, name: str) -> Path:
    """Fetch a package with npm.

    Args:
        folder: Folder in which npm leaves the package.
        name: Name and version of the package.

    Returns:
        The package.

    Raises:
        ConfigurationError: If npm is missing or cannot fetch it.
    """
    npm = which("npm")
    if npm is None:
        raise ConfigurationError(
            f"a page needs npm, which comes with Node.js, to fetch {name}"
        )
    try:
        done = subprocess.run(
            [npm, "pack", name, "--silent"],
            cwd=folder,
            capture_output=True,
            text=True,
            timeout=PATIENCE,
            check=False,
        )
    except subprocess.TimeoutExpired:
        raise ConfigurationError(
            f"npm did not fetch {name} within {PATIENCE:g} s"
        ) from None
    file = name.lstrip("@").replace("/", "-").replace("@", "-") + ".tgz"
    if done.returncode != 0 or not (folder / file).exists():
        raise ConfigurationError(
            f"npm could not fetch {name}; the registry must be reachable"
        )
    return folder / file


def packed_files(
    package: Path, name: str, files: Sequence[str]
) -> dict[str, bytes]:
    """Return files of a package by their last name.

    Args:
        package: Package as npm packs it.
        name: Its name and version, for messages.
        files: Files to read.

    Raises:
        ConfigurationError: If it cannot be read or lacks a file.
    """
    found: dict[str, bytes] = {}
    try:
        with tarfile.open(package) as archive:
            for file in files:
                member = archive.extractfile(f"package/{file}")
                if member is not None:
                    found[Path(file).name] = member.read()
    except (OSError, KeyError, tarfile.TarError) as error:
        raise ConfigurationError(
            f"{package} is no package of {name}: {error}"
        ) from error
    return found
