"""``stepaside doctor``: what is installed here, and what is missing."""

import platform
import sys
from importlib.metadata import PackageNotFoundError, requires, version
from importlib.util import find_spec
from re import match
from typing import Any

import click

from .. import __version__
from ..core.extras import EXTRAS
from .terminal import echo, json_option, print_json


@click.command("doctor")
@json_option
def doctor(as_json: bool) -> None:
    """Report what is installed, what is missing, and how to install it.

    Checks Python, the libraries that every command needs, the extras, and
    the off-screen graphics for cameras and films. Exit status 1 if something
    that every command needs is missing.
    """
    libraries = {name: _version(name) for name in _requirements()}
    missing = [name for name, found in libraries.items() if found is None]
    extras = {
        name: [module for module in modules if find_spec(module) is None]
        for name, modules in sorted(EXTRAS.items())
    }
    graphics = None
    if "mujoco" not in missing:
        from ..sim.offscreen_rendering import choose_renderer

        graphics = choose_renderer()
    report: dict[str, Any] = {
        "stepaside": __version__,
        "python": platform.python_version(),
        "platform": platform.platform(),
        "libraries": libraries,
        "extras": {
            name: {"installed": not lacking, "missing_modules": lacking}
            for name, lacking in extras.items()
        },
        "graphics": graphics,
        "missing": missing,
    }
    if as_json:
        print_json(report)
    else:
        _print(report)
    if missing:
        sys.exit(1)


def _requirements() -> list[str]:
    """Return the names of the libraries that every command needs."""
    try:
        lines = requires("stepaside") or []
    except PackageNotFoundError:
        return []
    found = (match(r"[\w.-]+", x) for x in lines if "extra ==" not in x)
    return sorted(name[0] for name in found if name)


def _version(name: str) -> str | None:
    try:
        return version(name)
    except PackageNotFoundError:
        return None


def _print(report: dict[str, Any]) -> None:
    echo(f"stepaside {report['stepaside']}, Python {report['python']}, "
         f"{report['platform']}")  # fmt: skip
    for name, found in report["libraries"].items():
        echo(f"  {name:12} {found or 'MISSING: pip install stepaside'}")
    echo("extras")
    for name, state in report["extras"].items():
        lacking = ", ".join(state["missing_modules"])
        hint = f"no {lacking}: pip install 'stepaside[{name}]'"
        echo(f"  {name:12} {hint if lacking else 'installed'}")
    graphics = report["graphics"]
    if graphics == "raycast":
        graphics = "none off screen: cameras are ray-cast at 160 px, and "
        graphics += "films need libegl1 or libosmesa6"
    echo(f"graphics: {graphics}")
