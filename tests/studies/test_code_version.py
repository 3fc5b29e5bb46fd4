"""Test the fingerprints that results are kept under."""

import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from stepaside.studies import (
    claim_jobs as jobs,
)
from stepaside.studies import (
    code_version as version,
)
from stepaside.studies import (
    duel_campaign as duels,
)
from stepaside.studies import (
    robustness_campaign as trial_results,
)
from stepaside.studies import (
    tournament_settings,
)
from stepaside.studies.code_version import (
    PHYSICS,
    PLANNER,
    ROOT,
    UNICYCLES,
    code_version,
    library_versions,
)
from stepaside.studies.dependencies import dependencies

FILES = {
    "__init__.py": "",
    "front/__init__.py": "if TYPE_CHECKING:\n    from .door import open\n"
    "    from .other import shut\nelse:\n    __getattr__ = None\n",
    "front/door.py": '"""Doc."""\nfrom ..deep.down import X\n',
    "front/other.py": "",
    "front/data.toml": "y = 1\n",
    "deep/__init__.py": "from . import always\n",
    "deep/always.py": "",
    "deep/down.py": "def f():\n    try:\n"
    "        from stepaside.lazy import a\n"
    "    finally:\n        import stepaside.plain.one\n",
    "deep/table/values.csv": "1\n",
    "lazy.py": "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n"
    "    from . import types_alone\nfrom os import path\n",
    "types_alone.py": "",
    "plain/__init__.py": "from .two import *\n",
    "plain/one.py": "",
    "plain/two.py": "",
    "beside.py": "Z = 1\n",
    "play.py": "from .front import open\n",
    "whole.py": "from . import front\n",
}
UNUSED = ("beside", "types_alone", "front/other", "whole")


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """Small package in place of this one."""
    for name, text in FILES.items():
        (tmp_path / name).parent.mkdir(exist_ok=True, parents=True)
        (tmp_path / name).write_text(text)
    monkeypatch.setattr(version, "ROOT", tmp_path)
    yield tmp_path
    code_version.cache_clear()


def fingerprint(*modules: str) -> str:
    code_version.cache_clear()
    return code_version(modules)


def edit(file: Path) -> None:
    """Change what a file does, or holds."""
    file.write_text(file.read_text() + "\nadded = 1\n")


@pytest.mark.parametrize("name", FILES)
def test_a_version_changes_with_all_that_is_imported_and_nothing_else(
    package: Path, name: str
) -> None:
    before = fingerprint("play")
    edit(package / name)
    unused = name.removesuffix(".py") in UNUSED
    assert (fingerprint("play") == before) is unused


def test_a_package_that_is_used_as_a_whole_depends_on_its_public_names(
    package: Path,
) -> None:
    found = dependencies(package, ["whole"])
    assert {package / "front/other.py", package / "lazy.py"} <= found


@pytest.mark.parametrize("name", ["front/new.py", "front/new/data.json"])
def test_all_files_of_a_folder_count(package: Path, name: str) -> None:
    before = fingerprint("front")
    (package / name).parent.mkdir(exist_ok=True)
    (package / name).write_text("")
    assert fingerprint("front") != before


def test_comments_and_layout_do_not_change_a_version(package: Path) -> None:
    before = fingerprint("play")
    file = package / "front" / "door.py"
    file.write_text(
        '"""Other doc."""\n# why\nfrom   ..deep.down import (\n    X\n)\n'
    )
    assert fingerprint("play") == before


def test_a_missing_module_is_named(package: Path) -> None:
    with pytest.raises(FileNotFoundError, match="'attic'"):
        fingerprint("attic")


PLAYED = """
import sys
from dataclasses import replace
from stepaside.games.duel_settings import DuelSettings
from stepaside.studies import duel_record as duels
from stepaside.strategies.registry import STRATEGIES
for settings in (
    DuelSettings(duration=0.1),
    DuelSettings(duration=0.1, evader_strategy="look-ahead"),
    DuelSettings(duration=0.1, sensing="cameras"),
    DuelSettings(duration=0.1, pursuer="person"),
):
    duels.play_record(settings)
for name in sys.modules:
    if name.split(".")[0] == "stepaside":
        print(sys.modules[name].__file__)
"""


def test_a_duel_loads_no_module_that_its_version_leaves_out() -> None:
    """The interpreter is asked which modules a game needs."""
    told = subprocess.run(
        [sys.executable, "-c", PLAYED],
        capture_output=True,
        text=True,
        check=True,
        timeout=300,
        env=os.environ | {"NUMBA_DISABLE_JIT": "1"},  # it loads the same
    )
    loaded = {Path(line) for line in told.stdout.split()}
    assert ROOT / "theory" / "laws.py" in loaded
    assert loaded <= dependencies(ROOT, duels.MODULES)


@pytest.mark.parametrize(
    ("name", "modules", "changes"),
    [
        ("strategies/search/turn_search.py", duels.MODULES, True),
        ("robots/nao/model.xml", duels.MODULES, True),
        ("theory/unicycle/certificate.py", duels.MODULES, True),
        ("cli.py", duels.MODULES, False),
        ("cli/duels.py", duels.MODULES, False),
        ("drivers/lola/wire.py", duels.MODULES, False),
        ("report/page/page.js", duels.MODULES, False),
        ("theory/laws.py", PHYSICS, True),
        ("theory/laws.py", UNICYCLES, True),
        ("theory/laws.py", PLANNER, True),
        ("sim/servos.py", UNICYCLES, False),
        ("theory/laws.py", trial_results.MODULES, True),
        ("theory/bound/value_solver.py", tournament_settings.MODULES, True),
        ("core/constants.py", jobs.DUELS, True),
        ("theory/bound/value_table.py", jobs.EVADING, True),
        ("control/scheme.py", jobs.PLANS, False),
    ],
)
def test_results_depend_on_the_code_that_makes_them(
    name: str, modules: tuple[str, ...], changes: bool
) -> None:
    assert (ROOT / name in dependencies(ROOT, modules)) is changes


def test_records_of_duels_are_made_again_with_other_laws(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    copy = tmp_path / "stepaside"
    shutil.copytree(ROOT, copy, ignore=shutil.ignore_patterns("__pycache__"))
    monkeypatch.setattr(version, "ROOT", copy)
    found = [fingerprint(*duels.MODULES)]
    for name in (
        "theory/laws.py",
        "core/constants.py",
        "theory/bound/upwind_scheme.py",
    ):
        edit(copy / name)
        found.append(fingerprint(*duels.MODULES))
    edit(copy / "report" / "duel_figure.py")
    assert len(set(found)) == len(found)
    assert fingerprint(*duels.MODULES) == found[-1]
    code_version.cache_clear()


def test_a_missing_library_has_no_version() -> None:
    found = library_versions(["numpy", "no-such-library"])
    assert found["numpy"] and found["no-such-library"] is None
