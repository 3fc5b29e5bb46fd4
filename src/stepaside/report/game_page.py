"""Static folder with a page on which a duel is played in the browser."""

import json
import subprocess
import tarfile
from dataclasses import replace
from pathlib import Path
from shutil import which
from tempfile import TemporaryDirectory

from ..core.atomic_output import atomic_draft, check_folder
from ..core.errors import ConfigurationError
from ..games.duel import Duel, run_duel
from ..games.duel_circle import circle_of_theory
from ..games.duel_settings import DuelSettings
from .game_script import check_playable, game_data, game_script
from .replay_page import SHARED, page_data, template
from .text_escaping import fill_page

ENGINE = "@mujoco/mujoco@3.14.0"  # the version that the tests play with
ENGINE_FILES = ("mujoco.js", "mujoco.wasm")
RECORDED = 20.0  # duration of the recording, in [s]
FOOTPRINTS = 400  # that are drawn of each player
PATIENCE = 300.0  # for the package, in [s]
NOTICE = """\
mujoco.js and mujoco.wasm: MuJoCo's WebAssembly build, {engine} on npm,
Apache License 2.0, Google DeepMind.
three.js, within index.html: MIT license; its notice stands before it.
"""


def write_game_page(
    settings: DuelSettings, folder: Path, package: Path | None = None
) -> None:
    """Write the page of a duel.

    Args:
        settings: Settings of the duel; the page shows it as a recording
            until the game has loaded.
        folder: Folder of the page; made if it does not exist.
        package: Package of MuJoCo's WebAssembly build as npm packs it;
            fetched by npm if not given.

    Raises:
        ConfigurationError: If a page cannot play the duel, or npm or the
            package is missing.
        OutputError: If a file cannot be written.
    """
    check_playable(settings)
    check_folder(folder, new=False)
    page = template("play.html", (*SHARED, "game.js", "play.js"))
    with TemporaryDirectory() as temporary:
        engine = engine_files(package or fetch_engine(Path(temporary)))
    duel = Duel(settings)
    script, data = game_script(duel), game_data(duel)
    page = page.replace('"use strict";\n', f'"use strict";\n{script}\n', 1)
    run = run_duel(replace(settings, duration=RECORDED))
    circle = circle_of_theory(settings)
    radius = circle.radius_evader_m if circle.exists else None
    recorded = page_data(run) | {
        "footprints": FOOTPRINTS,
        "circle": radius and [0.0, 0.0, radius],
    }
    contents = {
        "index.html": fill_page(page, {"NAME": "play"}, recorded).encode(),
        "game.json": json.dumps(data, allow_nan=False).encode(),
        "NOTICE.txt": NOTICE.format(engine=ENGINE).encode(),
        **engine,
    }
    folder.mkdir(parents=True, exist_ok=True)
    for name, content in contents.items():
        with atomic_draft(folder / name) as draft:
            draft.write_bytes(content)


def fetch_engine(folder: Path) -> Path:
    """Fetch the package of MuJoCo's WebAssembly build with npm.

    Args:
        folder: Folder in which npm leaves the package.

    Returns:
        The package.

    Raises:
        ConfigurationError: If npm is missing or cannot fetch it.
    """
    npm = which("npm")
    if npm is None:
        raise ConfigurationError(
            "a page needs npm, which comes with Node.js, to fetch MuJoCo's "
            f"WebAssembly build ({ENGINE})"
        )
    try:
        done = subprocess.run(
            [npm, "pack", ENGINE, "--silent"],
            cwd=folder,
            capture_output=True,
            text=True,
            timeout=PATIENCE,
            check=False,
        )
    except subprocess.TimeoutExpired:
        raise ConfigurationError(
            f"npm did not fetch {ENGINE} within {PATIENCE:g} s"
        ) from None
    packages = sorted(folder.glob("*.tgz"))
    if done.returncode != 0 or not packages:
        raise ConfigurationError(
            f"npm could not fetch {ENGINE}; the registry must be reachable"
        )
    return packages[0]


def engine_files(package: Path) -> dict[str, bytes]:
    """Return the files of MuJoCo's WebAssembly build by name.

    Args:
        package: Package as npm packs it.

    Raises:
        ConfigurationError: If it cannot be read or lacks a file.
    """
    found: dict[str, bytes] = {}
    try:
        with tarfile.open(package) as archive:
            for name in ENGINE_FILES:
                member = archive.extractfile(f"package/{name}")
                if member is not None:
                    found[name] = member.read()
    except (OSError, KeyError, tarfile.TarError) as error:
        raise ConfigurationError(
            f"{package} is no package of {ENGINE}: {error}"
        ) from error
    return found
