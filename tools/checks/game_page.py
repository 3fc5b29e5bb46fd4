"""Compare the page that plays with Python, and measure it, in Chromium.

    python -m tools.checks.game_page --seeds 7 11 --pictures artefacts
    python -m tools.checks.game_page --robot g1 --legs fastsac_g1_29dof.onnx

npm fetches MuJoCo's WebAssembly build and, for learned legs, ONNX Runtime;
``--engine`` and ``--runtime`` take their packages.
Chromium renders in software unless the machine has a graphics card.
"""

import argparse
import json
import shutil
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from playwright.sync_api import sync_playwright

from stepaside.games.duel import run_duel
from stepaside.games.duel_settings import DuelSettings
from stepaside.games.robot_settings import with_legs, with_robot
from stepaside.report.game_page import write_game_page
from tools.static_server import served_folder

SECONDS = 20.0  # of each game
SIZES = ((1280, 720), (1920, 1080), (390, 844))
WAIT = 200_000  # in [ms]


def greatest_distance(rows: np.ndarray, settings: DuelSettings) -> float:
    """Return the greatest distance of a torso from Python's, in [m]."""
    run = run_duel(settings)
    at = np.searchsorted(run.times, rows[:, 0] - 1e-6)
    apart = [
        np.linalg.norm(run.tracks[name].torso[at, :2] - columns, axis=1).max()
        for name, columns in zip(
            run.players, (rows[:, 1:3], rows[:, 3:5]), strict=True
        )
    ]
    return float(max(apart))


def settings_of(robot: str, legs: str, seed: int) -> DuelSettings:
    """Return the settings of a duel of a robot, also on learned legs."""
    settings = DuelSettings(seed=seed, duration=SECONDS)
    if robot != settings.robot:
        settings = with_robot(settings, robot)
    return with_legs(settings, legs) if legs else settings


def picture(page: Any, size: tuple[int, int], folder: Path) -> None:
    """Let a page play for some seconds, and keep what is seen."""
    page.set_viewport_size({"width": size[0], "height": size[1]})
    page.wait_for_timeout(6000)
    page.screenshot(path=folder / f"game-{size[0]}x{size[1]}.png")
    print(f"  {size[0]}x{size[1]}: {page.inner_text('#rate')}")


def main() -> None:
    """Compare, then measure."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seeds", type=int, nargs="+", default=[7, 11])
    parser.add_argument("--engine", type=Path)
    parser.add_argument("--runtime", type=Path)
    parser.add_argument("--robot", default="nao")
    parser.add_argument("--legs", default="")
    parser.add_argument("--pictures", type=Path)
    options = parser.parse_args()
    chromium = shutil.which("chromium") or shutil.which("chromium-browser")
    flags = ["--no-sandbox", "--enable-unsafe-swiftshader"]
    with TemporaryDirectory() as root, sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=chromium, args=flags)
        for seed in options.seeds:
            folder = Path(root) / str(seed)
            settings = settings_of(options.robot, options.legs, seed)
            write_game_page(settings, folder, options.engine, options.runtime)
            size = sum(file.stat().st_size for file in folder.iterdir())
            with served_folder(folder) as address:
                page = browser.new_page(viewport={"width": 390, "height": 844})
                page.set_default_timeout(WAIT)
                page.goto(address)
                if options.legs:
                    page.wait_for_selector("#policy:not([hidden])")
                    page.set_input_files("#network", options.legs)
                loaded = page.evaluate("stepaside.loaded")
                took = page.evaluate(
                    f"""async () => {{ const began = performance.now();
                      globalThis.rows = await stepaside.simulate({SECONDS});
                      return (performance.now() - began) / 1000; }}"""
                )
                rows = np.array(
                    json.loads(page.evaluate("JSON.stringify(rows)"))
                )
                apart = greatest_distance(rows, settings)
                print(
                    f"seed {seed}: {rows[-1, 0]:g} s, within {apart:.2g} m of "
                    f"Python; {took:.1f} s to compute; loaded in {loaded:.1f} "
                    f"s; folder {size / 1e6:.1f} MB"
                )
                if options.pictures and seed == options.seeds[-1]:
                    page.get_by_role("button", name="Start again").click()
                    for each in SIZES:
                        picture(page, each, options.pictures)
                page.close()
        browser.close()


if __name__ == "__main__":
    main()
