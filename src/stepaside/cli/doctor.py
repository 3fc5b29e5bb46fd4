"""``stepaside doctor``: what is installed here, and what is missing."""

import os
import platform
import sys
from importlib.metadata import PackageNotFoundError, requires, version
from importlib.util import find_spec
from re import match
from typing import Any

import click

from .. import __version__
from ..core.extras import EXTRAS
from .options import json_option
from .terminal import echo, print_json


@click.command("doctor")
@json_option
def doctor(as_json: bool) -> None:
    """Report what is installed, what is missing, and how to install it.

    Checks Python, the libraries that every command needs, the extras, and
    the off-screen graphics for cameras and films. Exit status 1 if something
    that every command needs is missing.
    """
    report = examine()
    if as_json:
        print_json(report)
    else:
        _print(report)
    if report["missing"]:
        sys.exit(1)


def examine() -> dict[str, Any]:
    """Return what is installed, by name, and what is missing."""
    libraries = {name: _version(name) for name in _requirements()}
    missing = [name for name, found in libraries.items() if found is None]
    extras = {
        name: [module for module in modules if find_spec(module) is None]
        for name, modules in sorted(EXTRAS.items())
    }
    return {
        "stepaside": __version__,
        "python": platform.python_version(),
        "platform": platform.platform(),
        "cores": len(os.sched_getaffinity(0))
        if hasattr(os, "sched_getaffinity")
        else os.cpu_count(),
        "libraries": libraries,
        "extras": {
            name: {"installed": not lacking, "missing_modules": lacking}
            for name, lacking in extras.items()
        },
        "graphics": None if "mujoco" in missing else _graphics(),
        "missing": missing,
    }


def _requirements() -> list[str]:
    """Return the names of the libraries that every command needs."""
    try:
        lines = requires("stepaside") or []
    except PackageNotFoundError:
        return []
    found = (match(r"[\w.-]+", x) for x in lines if "extra ==" not in x)
    return sorted(name[0] for name in found if name)


def _version(name: str) -> str | None:
    """Return the installed version of a distribution, or None."""
    try:
        return version(name)
    except PackageNotFoundError:
        return None


def _graphics() -> str:
    from ..sim.offscreen_rendering import choose_renderer

    return choose_renderer()


def _print(report: dict[str, Any]) -> None:
    echo(f"stepaside {report['stepaside']}, Python {report['python']}")
    echo(f"{report['platform']}, {report['cores']} cores")
    echo("\nlibraries")
    for name, found in report["libraries"].items():
        echo(f"  {name:12} {found or 'MISSING'}")
    echo("\nextras")
    for name, state in report["extras"].items():
        hint = f"pip install 'stepaside[{name}]'"
        lacking = ", ".join(state["missing_modules"])
        echo(
            f"  {name:12} "
            + ("installed" if state["installed"] else f"no {lacking}: {hint}")
        )
    graphics = report["graphics"]
    echo("\ngraphics")
    if graphics == "raycast":
        echo(
            "  none off screen: cameras are ray-cast at 160 px, and films "
            "need libegl1 or libosmesa6"
        )
    elif graphics is not None:
        echo(f"  {graphics}: cameras and films")
    echo()
    if report["missing"]:
        echo(f"missing: {', '.join(report['missing'])}; pip install stepaside")
    else:
        echo("every command can run; extras add what is listed above")
