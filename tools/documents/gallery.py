"""Make the pictures of the gallery and its page, from the examples.

Each entry is a list of commands, as a reader would type them, and the picture
that they write::

    python -m tools.documents.gallery          # all pictures, and the page
    python -m tools.documents.gallery 3 7      # some pictures
    python -m tools.documents.gallery --page   # only docs/gallery.md
"""

import shlex
import shutil
import subprocess
import sys
from argparse import ArgumentParser
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

from PIL import Image

ROOT = Path(__file__).parents[2]
PAGE, PICTURES = ROOT / "docs/gallery.md", ROOT / "docs/images/gallery"
WIDTH = 960  # of a picture, in [pixels]
INTRODUCTION = """# Gallery

Every picture is made by the commands below it (`python -m \
tools.documents.gallery`), which use the files in `examples/` and nothing \
else. Pursuers are red, evaders blue, bystanders grey.
"""


class Entry(NamedTuple):
    """One picture of the gallery.

    Attributes:
        title: Title.
        text: What it shows, and where to read on.
        commands: Commands that make it, in an empty folder beside a folder
            ``examples``.
        picture: File that they write.
    """

    title: str
    text: str
    commands: tuple[str, ...]
    picture: str

    @property
    def example(self) -> str:
        """File in ``examples/`` that the commands use; empty without one."""
        for word in shlex.split(" ".join(self.commands)):
            if word.startswith("examples/"):
                return word.split(":")[0]
        return ""


FILM = "--rate 8 --width 480 --height 270"
ENTRIES = (
    Entry(
        "Plan a maneuver",
        "Twenty footsteps of an evader, their ZMP and the bounded CoM, "
        "planned in closed form ([How it works](how-it-works.md)).",
        (
            "python examples/plan_maneuver.py",
            "stepaside theory plan --role evader --bearing=-50deg "
            "--first-foot right --figure plan.png",
        ),
        "plan.png",
    ),
    Entry(
        "Two unicycles",
        "The game without bodies: both end on one circle "
        "([Unicycles](unicycles.md)).",
        (
            "python examples/unicycle_games.py",
            "stepaside run unicycles --distance 2 --figure unicycles.png",
        ),
        "unicycles.png",
    ),
    Entry(
        "A duel",
        "Two NAOs in physics ([From Python](python.md)).",
        ("python examples/play_duel.py",),
        "duel.png",
    ),
    Entry(
        "Push a walking robot",
        "1.2 N s from the side while it walks; the plan begins anew from the "
        "measured motion ([Feedback](walking.md)).",
        (
            "python examples/change_gait.py 4",
            "stepaside run walk --push 1.2@5:90deg --body delayed "
            "--duration 9 --output pushed",
            "stepaside show pushed -o push.gif --set begin=4 --duration 4 "
            f"--speed 0.5 --camera follow {FILM}",
        ),
        "push.gif",
    ),
    Entry(
        "Your own evader",
        "A strategy of a few lines moves aside far away and backs off when "
        "the pursuer is near ([Strategies](strategies.md)).",
        (
            "stepaside duel --strategy examples/own_strategy.py:BackAndAside "
            "--seed 7 --duration 60 --output own",
        ),
        "own/duel.png",
    ),
    Entry(
        "Through a door",
        "A look-ahead evader leaves a dead end, and a pursuer follows "
        "([Rooms](obstacles.md)).",
        (
            "stepaside duel --room examples/rooms/narrow-door.toml "
            "--strategy look-ahead --duration 40 --output door",
            "stepaside show door -o door.gif --camera fixed --set begin=0 "
            "--duration 40 --speed 4 --rate 5 --width 400 --height 260",
        ),
        "door.gif",
    ),
    Entry(
        "Two pursuers",
        "Two robots pursue a third ([Games of many](games.md)).",
        ("stepaside run examples/two-pursuers.toml --seed 3 --output two",),
        "two/game.png",
    ),
    Entry(
        "Cyclic pursuit",
        "Three robots, each after the next, end on an equilateral triangle.",
        (
            "stepaside run examples/cyclic-pursuit.toml --level steps "
            "--output cycle",
        ),
        "cycle/game.png",
    ),
    Entry(
        "Through a crowd",
        "One robot among ten people, who keep clear of each other.",
        (
            "stepaside run examples/crowd.toml --level steps --seed 1 "
            "--output crowd",
        ),
        "crowd/game.png",
    ),
    Entry(
        "A person comes",
        "A person walks straight at a NAO, which steps aside with the fast "
        "gait ([People](people.md)).",
        (
            "stepaside duel --pursuer person --set person.speed=0.3 "
            "--gait fast "
            "--distance 2.5 --duration 25 --output person",
        ),
        "person/duel.png",
    ),
    Entry(
        "Train an evader",
        "Proximal policy optimisation in numpy, under a minute on one core "
        "([Learning](learning.md)).",
        ("python examples/train_evader.py",),
        "training-open.png",
    ),
    Entry(
        "Circles of any speeds and gains",
        "The circle over angle and ratios, of a faster pursuer "
        "([Unicycles](unicycles.md)).",
        (
            "stepaside theory circle --set pursuer_speed=2 "
            "--set evader_speed=1 --set pursuer_gain=1 --set evader_gain=4 "
            "--figure circles.png",
        ),
        "circles.png",
    ),
)


def file_of(number: int) -> Path:
    """Return the file of the picture of an entry, counted from 1."""
    entry = ENTRIES[number - 1]
    name = Path(entry.picture).name
    stem = entry.title.lower().replace(" ", "-").replace(",", "")
    return PICTURES / f"{number:02}-{stem}{Path(name).suffix}"


def page() -> str:
    """Return the text of the page."""
    parts = [INTRODUCTION]
    for number, entry in enumerate(ENTRIES, start=1):
        picture = file_of(number).relative_to(PAGE.parent)
        commands = "\n".join(entry.commands)
        parts.append(
            f"## {number}. {entry.title}\n\n{entry.text}\n\n"
            f"![{entry.title}]({picture.as_posix()})\n\n"
            f"```sh\n{commands}\n```\n"
        )
    return "\n".join(parts)


def make_picture(number: int) -> None:
    """Run the commands of an entry and store its picture."""
    entry = ENTRIES[number - 1]
    with TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "examples").symlink_to(ROOT / "examples")
        for command in entry.commands:
            words = shlex.split(command)
            words[:1] = {
                "python": [sys.executable],
                "stepaside": [sys.executable, "-m", "stepaside"],
            }[words[0]]
            print(f"{number}: {command}", flush=True)
            subprocess.run(
                words, cwd=folder, check=True, stdout=subprocess.DEVNULL
            )
        store(folder / entry.picture, file_of(number))


def store(picture: Path, file: Path) -> None:
    """Store a picture, a PNG in the width of the page with few colours."""
    if picture.suffix != ".png":
        shutil.copyfile(picture, file)
        return
    with Image.open(picture) as image:
        size = WIDTH, round(image.height * WIDTH / image.width)
        small = image.convert("RGB").resize(size, Image.Resampling.LANCZOS)
        small.quantize(192).save(file, optimize=True)


def main() -> None:
    """Make what was asked for."""
    parser = ArgumentParser(
        prog="python -m tools.documents.gallery", description=__doc__
    )
    parser.add_argument("numbers", type=int, nargs="*")
    parser.add_argument("--page", action="store_true")
    given = parser.parse_args()
    PICTURES.mkdir(parents=True, exist_ok=True)
    if not given.page:
        for number in given.numbers or range(1, len(ENTRIES) + 1):
            make_picture(number)
    PAGE.write_text(page(), encoding="utf-8")


if __name__ == "__main__":
    main()
