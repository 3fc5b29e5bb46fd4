"""Test that README and docs/ say what was measured, and nothing else."""

import re
from pathlib import Path

import pytest
from campaigns import STUDIES

from tools.documents.blocks import BLOCK
from tools.documents.document import complaints, documents
from tools.documents.pictures import IMAGES, PICTURES, drawn_from
from tools.documents.store import ROOT, Store

# Tables that hold no measurements: words, sources, settings, symbols.
NOT_MEASURED = {
    ("docs/configuration.md", "open setting"),
    ("docs/interfaces.md", "part"),
    ("docs/guides.md", "I want to"),
    ("docs/reference.md", "page"),
    ("docs/shield.md", "bound"),
    ("docs/shield-proof.md", "statement"),
    ("docs/shield.md", "what"),
    ("docs/games.md", "level"),
    ("docs/games.md", "strategy"),
    ("docs/campaigns.md", "`--executor`"),
    ("docs/commands.md", "command"),
    ("docs/conventions.md", "frame"),
    ("docs/conventions.md", "generator"),
    ("docs/conventions.md", "symbol"),
    ("docs/conventions.md", "term"),
    ("docs/conventions.md", "what"),
    ("docs/robot-safety.md", "what fails"),
    ("docs/departures.md", "what"),
    ("docs/people.md", "reaction"),
    ("docs/export.md", "`FORMAT`"),
    ("docs/export.md", "topic"),
    ("docs/images/README.md", "picture"),
    ("docs/nao.md", "data"),
    ("docs/installation.md", "extra"),
    ("docs/robots-real.md", "topic"),
    ("docs/robot-safety.md", "event"),
    ("docs/code.md", "package"),
    ("docs/code.md", "to change"),
    ("docs/learning.md", "environment"),
    ("docs/learning.md", "setting"),
    ("docs/legs-contract.md", "entry"),
    ("docs/legs-contract.md", "name"),
    ("docs/run-folder.md", "`outcome`"),
    ("docs/run-folder.md", "array"),
    ("docs/run-folder.md", "entry"),
    ("docs/run-folder.md", "file"),
    ("docs/sensing.md", "parameter"),
    ("docs/strategy-reference.md", "`Intent`"),
    ("docs/strategy-reference.md", "`Knowledge`"),
    ("docs/strategy-reference.md", "metadata"),
    ("docs/strategies.md", "name"),
    ("docs/strategy-reference.md", "term"),
    ("docs/strategies.md", "argument of `pursuit`"),
    ("docs/unicycles.md", "symbol"),
    ("docs/departures.md", "where"),
    ("docs/viewer.md", "command"),
    ("docs/walking.md", "effect"),
    ("docs/paper-figures.md", "the paper"),
}
DOCUMENTS = [*documents(), IMAGES / "README.md"]
HEAD = re.compile(r"^\|(.*)\|\n\|[-:| ]+\|$", re.MULTILINE)
FENCE = re.compile(r"^```([^\n]*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
LINK = re.compile(r"\]\((?!https?:|#)([^)#\s]+)")
PATH = re.compile(
    r"(?<![\w/])(?:docs|tools|tests)/[\w/-]+\.(?:md|py|json|png)"
)
STORE = Store()


def name_of(file: Path) -> str:
    return str(file.relative_to(ROOT))


def outside_of_blocks(file: Path) -> str:
    return BLOCK.sub("", file.read_text(encoding="utf-8"))


@pytest.mark.parametrize("file", DOCUMENTS, ids=name_of)
def test_a_document_says_what_the_results_say(file: Path) -> None:
    """Where this fails, ``make figures`` writes the document anew."""
    assert not complaints(file, STORE)


def test_every_table_of_measurements_is_made() -> None:
    found = {
        (name_of(file), head[1].split("|")[0].strip())
        for file in DOCUMENTS
        for head in HEAD.finditer(outside_of_blocks(file))
    }
    assert found == NOT_MEASURED


def test_every_printed_figure_is_made() -> None:
    """Fences without a language hold output; with one, what to type."""
    for file in DOCUMENTS:
        for fence in FENCE.finditer(outside_of_blocks(file)):
            assert fence[1] or not re.search(r"\d", fence[2]), (file, fence[2])


@pytest.mark.parametrize("name", sorted(PICTURES))
def test_a_picture_shows_the_results(name: str) -> None:
    assert drawn_from(IMAGES / name) == PICTURES[name].source(STORE)


def test_every_picture_is_shown_and_says_how_it_was_made() -> None:
    shown = {
        (file.parent / link).resolve()
        for file in DOCUMENTS
        for link in LINK.findall(file.read_text(encoding="utf-8"))
    }
    page = (IMAGES / "README.md").read_text(encoding="utf-8")
    pictures = [f for f in IMAGES.iterdir() if f.suffix not in ("", ".md")]
    assert pictures
    for file in pictures:
        assert file.resolve() in shown, f"no document shows {file.name}"
        assert f"`{file.name}`" in page, (
            f"nothing says how {file.name} is made"
        )


@pytest.mark.parametrize("file", DOCUMENTS, ids=name_of)
def test_what_a_document_links_to_exists(file: Path) -> None:
    for link in LINK.findall(file.read_text(encoding="utf-8")):
        assert (file.parent / link).exists(), link


def test_every_file_that_text_or_code_names_exists() -> None:
    files = [*DOCUMENTS, *(ROOT / "src").rglob("*.py")]
    files += [*(ROOT / "tools" / "benchmarks").glob("*.py"), ROOT / "Makefile"]
    for file in files:
        for path in PATH.findall(file.read_text(encoding="utf-8")):
            assert (ROOT / path).exists(), f"{name_of(file)} names {path}"


@pytest.mark.parametrize("name", STORE.names())
def test_a_result_names_the_command_that_makes_it_again(name: str) -> None:
    result = STORE.result(name)
    program, *words = result["command"].split()
    assert not any(word.startswith("/") for word in words), result["command"]
    assert result["libraries"] and result["settings"]
    if program == "python" and words[0] == "-m":
        module = ROOT / words[1].replace(".", "/")
        files = (module / "__main__.py", module.with_suffix(".py"))
        assert any(file.exists() for file in files), result["command"]
    elif program == "python":
        assert (ROOT / words[0]).exists(), result["command"]
    elif program == "make":
        rules = (ROOT / "Makefile").read_text(encoding="utf-8")
        assert f"\n{words[0]}:" in rules, result["command"]
    else:
        from stepaside.cli.main import COMMANDS

        assert program == "stepaside" and words[0] in COMMANDS


@pytest.mark.parametrize("name", sorted({*STUDIES} & {*STORE.names()}))
def test_a_study_was_measured_by_the_command_of_today(name: str) -> None:
    result = STORE.result(name)
    assert result["command"].endswith(f" {STUDIES[name].words}")
    assert result.get("done") == result.get("planned")


def test_every_place_to_change_exists() -> None:
    page = (ROOT / "docs" / "code.md").read_text(encoding="utf-8")
    table = page.split("## Where to change")[1].split("\n## ")[0]
    places = re.findall(r"`([a-z]+/[a-z0-9_/]+\.\w+)`", table)
    assert len(places) >= 14
    for place in places:
        assert (ROOT / "src" / "stepaside" / place).exists(), place
    for name, place in re.findall(r"`(_\w+)` in `(\S+)`", table):
        text = (ROOT / "src" / "stepaside" / place).read_text("utf-8")
        assert f"def {name}(" in text, (name, place)
