"""Places that are full, or gone, when a command comes to write."""

import resource
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path
from random import Random
from time import sleep

from .case import Case
from .moments import MAIN, WALKS, Trial, start, unwhole

PLACE = "place"  # folder that everything goes to
WRITES = {
    "duel": "duel --duration=0.5 --output=place/run",
    "duels": "duels --seeds=0:2 --duration=0.2 --workers=1 --output=place",
    "map": "map --grid=4 --distances=2 --figure=place/map.png",
    "circle": "circle --starts=2 --figure=place/f.png --sweep=place/s.png",
    "plan": "plan --role=evader --bearing=0.3 --figure=place/plan.pdf",
    "bound": "bound --grid=16 --refine=0 --games=0 --horizon=0.1 "
    "--output=place/table.npz --figure=place/bound.png",
    "replay": "replay run --html=place/page.html --gif=place/film.gif "
    "--strip=place/strip.png --duration=0.1",
    "compare": "compare run --output=place/both.svg",
    "room": "room --discs=2 --output=place/room.toml --figure=place/r.png",
    "robot show": "robot show nao --output=place/model.xml",
    "walk": "walk --duration=0.5 --output=place/run --figure=place/walk.png",
    "unicycles": "unicycles --duration=1 --figure=place/game.svg",
    "tournament": "tournament --seeds=0:2 --duration=1 --evader=aside "
    "--room=open --workers=1 --output=place --figure=place/front.png",
    "robustness": f"robustness {WALKS} --output=place",
    "reproduce": "",
}
# They write when others have played, or after minutes of walking.
APART = {"serve", "robot check", "robot init"}
REFUSED = 2


def place_cases(random: Random, run: Path) -> Iterator[Case]:
    """Each command, with little room or a folder that goes, without end."""
    while True:
        for name in WRITES:
            room = random.choice([0, 10, 1000, 10_000, 50_000])
            yield _case(name, run, room, None)
            yield _case(name, run, None, random.random())


def _case(name: str, run: Path, room: int | None, gone: float | None) -> Case:
    words = (*MAIN, *WRITES[name].split())
    if name == "reproduce":
        words = ("-m", "tests.fuzz.short_reproduce", PLACE)

    def try_it(folder: Path) -> str:
        (folder / PLACE).mkdir()
        shutil.copytree(run, folder / "run")
        process = start(Trial(words, str), folder)
        if room is not None:
            limits = (room, resource.RLIM_INFINITY)
            resource.prlimit(process.pid, resource.RLIMIT_FSIZE, limits)
        if gone is not None:
            sleep(6.0 * gone)
            shutil.rmtree(folder / PLACE, ignore_errors=True)
        try:
            _, said = process.communicate(timeout=240.0)
        except subprocess.TimeoutExpired:
            process.kill()
            process.communicate()
            return "hang"
        if "Traceback" in said:
            return f"traceback: {said[-700:]!r}"
        if process.returncode not in (0, REFUSED):
            return f"status {process.returncode}: {said[-300:]!r}"
        own = [e for e in said.splitlines() if e.startswith("stepaside:")]
        if process.returncode == REFUSED and not own:
            return f"no word: {said[-300:]!r}"
        return unwhole(folder, killed=False)

    what = f"{room} bytes of room" if gone is None else f"gone at {gone:.2f}"
    return Case(f"places of {name}", f"{name}, {what}", try_it, 300.0)
