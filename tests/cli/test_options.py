"""Options of all commands: declared once, documented, from registries."""

import subprocess
import sys
from collections import defaultdict
from collections.abc import Iterable, Iterator
from dataclasses import fields
from typing import Any, Literal, get_args, get_origin, get_type_hints

import click
import pytest

from stepaside.cli.bound import AGAINST
from stepaside.cli.main import COMMANDS, main
from stepaside.cli.options.connection_options import MOTION_INTERFACES
from stepaside.cli.options.declaration import DeclaredOption, OptionDeclaration
from stepaside.cli.options.room_options import RECIPE
from stepaside.cli.options.value_kinds import NameType, WordOrValueType
from stepaside.cli.plan_settings import FEET, ROLES, PlanSettings
from stepaside.cli.serve import SIGHTS
from stepaside.cli.unicycle_options import STRATEGIES
from stepaside.cli.value_types import AngleType, NumberType
from stepaside.control.clearance.map_settings import MAPS, UNSEEN
from stepaside.core.setting import settings_of
from stepaside.games.duel_settings import SENSING, DuelSettings
from stepaside.games.walk_settings import WalkSettings
from stepaside.locomotion.zmp.control_settings import METHODS, TAILS
from stepaside.planning import PRESETS, GaitSettings
from stepaside.planning.swing import SwingProfile
from stepaside.report.figure_sizes import SHEETS
from stepaside.report.film_camera import VIEWS
from stepaside.sim.body_settings import BODIES
from stepaside.sim.camera_settings import OPTICS, RENDERERS
from stepaside.sim.pedestrian_models import FIGURES
from stepaside.sim.person_settings import PURSUERS
from stepaside.strategies.evasion import TRIGGERS
from stepaside.studies import robustness_campaign as robustness
from stepaside.studies.tournament_settings import LEVELS
from stepaside.theory.bound import DiscretisationScheme
from stepaside.theory.unicycle.unicycle_game import SideRule, TurningLaw

SETTINGS = {
    "duel": DuelSettings,
    "duels": DuelSettings,
    "play": DuelSettings,
    "serve": DuelSettings,
    "view": DuelSettings,
    "walk": WalkSettings,
    "robustness": WalkSettings,
    "plan": PlanSettings,
}
# Registry of each option, for all commands.
REGISTRIES: dict[str, Iterable[str]] = {
    "--figure-width": SHEETS,
    "--body": BODIES,
    "--gait": PRESETS,
    "--profile": get_args(get_type_hints(GaitSettings)["zmp_profile"]),
    "--swing-profile": get_args(SwingProfile),
    "--trigger": TRIGGERS,
    "--method": METHODS,
    "--mpc-tail": TAILS,
    "--sensing": SENSING,
    "--map": MAPS,
    "--unseen": UNSEEN,
    "--optics": OPTICS,
    "--renderer": RENDERERS,
    "--pursuer": PURSUERS,
    "--person-figure": FIGURES,
    "--level": LEVELS,
    "--role": ROLES,
    "--by": MOTION_INTERFACES,
    "--first-foot": FEET,
    "--kind": robustness.KINDS,
    "--strategy": STRATEGIES,
    "--law": [law.value for law in TurningLaw],
    "--side-rule": [rule.value for rule in SideRule],
    "--camera": VIEWS,
    "--sight": SIGHTS,
    "--against": AGAINST,
    "--scheme": [scheme.value for scheme in DiscretisationScheme],
}
# Number of meanings of names that have another meaning for unicycles, films
# or campaigns; each meaning is declared once.
SENSES = {
    "--aim": 2,
    "--angle": 2,
    "--bearing": 2,
    "--body": 2,
    "--boxes": 2,  # one makes a room, one the room of a duel
    "--delay": 2,
    "--discs": 2,
    "--distance": 2,
    "--door-width": 2,
    "--doors": 2,
    "--duration": 5,
    "--evader-speed": 2,
    "--evader-strategy": 2,
    "--farthest": 2,
    "--gain": 2,
    "--grid": 2,
    "--horizon": 2,
    "--hysteresis": 2,
    "--largest": 2,
    "--method": 2,
    "--nearest": 2,
    "--output": 3,
    "--polygons": 2,
    "--pursuer": 2,
    "--pursuer-gain": 2,
    "--pursuer-speed": 2,
    "--rate": 2,
    "--robot": 2,
    "--room": 2,
    "--role": 2,
    "--saturated": 2,
    "--seed": 2,
    "--seeds": 2,
    "--sensing": 2,
    "--side-hysteresis": 2,
    "--smallest": 2,
    "--speed": 3,
    "--strategy": 2,
    "--wait": 2,  # for clients, and for a robot
}


def options_of(name: str) -> list[click.Option]:
    context = click.Context(main)
    command = main.get_command(context, name)
    assert command is not None
    return [p for p in command.params if isinstance(p, click.Option)]


def every_option() -> Iterator[tuple[str, click.Option]]:
    for name in COMMANDS:
        for option in options_of(name):
            yield name, option


DECLARED = {
    option.declaration: SETTINGS[name]
    for name, option in every_option()
    if isinstance(option, DeclaredOption) and option.sets_settings
}


def told(name: str, option: click.Option) -> str:
    """Return the help of an option as it is shown."""
    command = main.get_command(click.Context(main), name)
    assert command is not None
    record = option.get_help_record(click.Context(command))
    assert record is not None
    return record[1]


@pytest.mark.parametrize("name", COMMANDS)
def test_every_option_has_a_meaning_and_a_unit(name: str) -> None:
    for option in options_of(name):
        text = told(name, option)
        assert len(text.split("[default")[0].strip()) > 5, option.opts
        assert "{" not in text, option.opts
        kind: Any = option.type
        if isinstance(kind, WordOrValueType):
            kind = kind.kind
        if isinstance(kind, NumberType):
            assert f"[{kind.unit}]" in text, option.opts
        if isinstance(kind, AngleType):
            assert "[rad]" in text, option.opts


@pytest.mark.parametrize("name", COMMANDS)
def test_every_flag_can_be_switched_off(name: str) -> None:
    for option in options_of(name):
        assert option.is_flag == bool(option.secondary_opts), option.opts


@pytest.mark.parametrize("name", COMMANDS)
def test_every_choice_comes_from_a_registry(name: str) -> None:
    for option in options_of(name):
        assert not isinstance(option.type, click.Choice), "typed by hand"
        if isinstance(option.type, NameType):
            wanted = tuple(REGISTRIES[option.opts[0]])
            if (name, option.opts[0]) == ("robustness", "--method"):
                wanted = robustness.METHODS
            assert option.type.choices == wanted, option.opts


def test_shared_options_are_declared_once() -> None:
    """One declaration per name and meaning; SENSES lists the exceptions."""
    by_name: dict[str, set[object]] = defaultdict(set)
    takers: dict[str, int] = defaultdict(int)
    by_path: dict[str, set[OptionDeclaration]] = defaultdict(set)
    for _, option in every_option():
        declaration: Any = getattr(option, "declaration", option)
        for spelling in option.opts:
            by_name[spelling].add(declaration)
            takers[spelling] += 1
        if declaration in DECLARED:
            by_path[declaration.path].add(declaration)
    found = {name: len(s) for name, s in by_name.items() if len(s) > 1}
    assert found == SENSES
    # These are actually shared.
    for name in ("--friction", "--stride", "--config", "--workers"):
        assert takers[name] > 2, name
    assert all(len(s) == 1 for s in by_path.values())


@pytest.mark.parametrize("name", SETTINGS)
def test_commands_with_robots_take_a_file_and_the_gait(name: str) -> None:
    spelled = {word for option in options_of(name) for word in option.opts}
    assert spelled >= {"--config", "--print-config", "--gait"}
    assert spelled >= {
        f"--{field.name.replace('_', '-')}"
        for field in fields(GaitSettings)
        if field.name not in ("gravity", "sole", "horizon")
    }
    assert ("--horizon" in spelled) == (name != "plan")


def entry(kind: Any, path: str) -> tuple[Any, str]:
    """Return type and description of a configuration entry."""
    for name in path.split("."):
        owner, kind = kind, get_type_hints(kind)[name]
    return kind, settings_of(owner)[path.split(".")[-1]].text


def test_declarations_agree_with_the_settings() -> None:
    assert len(DECLARED) > 60
    for declaration, settings in DECLARED.items():
        if declaration.path.startswith(RECIPE):
            continue  # these generate the entry of the room
        hint, text = entry(settings, declaration.path)
        assert text, f"{declaration.path}: no description in the settings"
        kinds = set(get_args(hint)) or {hint}
        if float in kinds:
            assert declaration.unit, declaration.path
            if "[" in text:
                assert f"[{declaration.unit}]" in text, declaration.path
        elif int in kinds:
            assert declaration.kind is click.INT, declaration.path
        elif bool in kinds:
            assert declaration.is_flag, declaration.path
        elif get_origin(hint) is Literal:
            assert isinstance(declaration.type, NameType), declaration.path
            assert declaration.type.choices == get_args(hint)


def test_list_of_commands_imports_nothing() -> None:
    """Neither a command nor numpy."""
    code = (
        "import sys; from stepaside.cli.main import main\n"
        "try: main(['--help'])\n"
        "except SystemExit: pass\n"
        "bad = {m for m in sys.modules if m.startswith('stepaside.cli.')}"
        "\nbad -= {'stepaside.cli.main'}"
        "\nassert not bad and 'numpy' not in sys.modules, bad"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_commands_are_declared_without_heavy_imports() -> None:
    """Settings, registries and MuJoCo are imported on use."""
    numeric = ("unicycles", "circle", "map", "bound")
    code = f"""if True:
        import sys
        from importlib import import_module
        heavy = {{"mujoco", "scipy", "matplotlib", "numpy"}}
        for name in {sorted(COMMANDS, key=lambda name: name in numeric)}:
            if name in {numeric}:
                heavy.discard("numpy")
            import_module(f"stepaside.cli.{{name}}")
            bad = heavy & set(sys.modules)
            assert not bad, (name, bad)
        """
    subprocess.run([sys.executable, "-c", code], check=True)


def test_duel_without_figure_imports_no_plotting() -> None:
    """Matplotlib and SciPy would double the import time."""
    code = """if True:
        import sys
        from stepaside.cli.main import main
        try:
            main(["duel", "--duration", "0.02", "--json"])
        except SystemExit as left:
            assert not left.code
        bad = {"matplotlib", "scipy"} & set(sys.modules)
        assert not bad, bad
        """
    subprocess.run(
        [sys.executable, "-c", code], check=True, stdout=subprocess.DEVNULL
    )
