"""Take screenshots of the pages for docs/images, in a headless browser.

Simulation time stands still for each screenshot, so that the result does not
depend on the speed of the machine::

    python -m tools.documents.photographs            # all of them
    python -m tools.documents.photographs page.gif   # some

``view.png`` is a live page with cameras, ``page.gif`` an animation of one on
which the pursuer is pushed by hand, ``replay.png`` the offline page.
"""

from argparse import ArgumentParser
from collections.abc import Iterator
from contextlib import contextmanager
from io import BytesIO
from math import pi
from pathlib import Path
from shutil import which
from tempfile import TemporaryDirectory
from typing import Any

from PIL import Image
from playwright.sync_api import sync_playwright

from stepaside.games.game_settings import GameSettings, duel
from stepaside.games.recorded_game import run_game
from stepaside.report.replay_page import write_page
from stepaside.report.viewer.live_page import Page

from .pictures import IMAGES

DESK = {"width": 1280, "height": 720}
LANCZOS = Image.Resampling.LANCZOS
SMALL = (640, 360)  # of a film, in [pixels]
WAIT = 200_000  # in [ms]
DRAWN = """() => new Promise((told) => requestAnimationFrame(
  () => requestAnimationFrame(told)))"""
SEEN_AT = 12.0  # moment of the live page with cameras, in [s]
FILMED, PUSHED = (6.0, 16.0), 10.0  # in [s]
EACH, RATE = 0.2, 8  # time between pictures in [s]; pictures a second


@contextmanager
def live(browser: Any, settings: GameSettings) -> Iterator[tuple[Page, Any]]:
    """Serve a page and open it."""
    served = Page(settings, port=8890)
    served.start()
    try:
        page = opened(browser, f"http://127.0.0.1:{served.server.get_port()}")
        page.get_by_text("s simulated").first.wait_for()
        page.locator(".mantine-Notification-closeButton").first.click()
        yield served, page
    finally:
        served.close()


def opened(browser: Any, link: str) -> Any:
    """Open the page at a link."""
    page = browser.new_page(viewport=DESK)
    page.set_default_timeout(WAIT)
    page.goto(link)
    return page


def show(served: Page, page: Any, time: float) -> None:
    """Advance the duel to a time in [s], and wait until the page shows it."""
    passed = time - served.session.world.time
    if passed > 0.0:
        served.session.step(passed)
    page.get_by_text(f"{time:.1f} s simulated").first.wait_for()
    page.wait_for_timeout(500)  # plots come twice a second
    page.evaluate(DRAWN)


def view(browser: Any) -> None:
    """Take a screenshot of the live page with cameras."""
    seen = duel(seed=7, senses="cameras")
    with live(browser, seen) as (served, page):
        show(served, page, SEEN_AT)
        page.screenshot(path=IMAGES / "view.png")


def film(browser: Any) -> None:
    """Record the live page while the evader moves aside and is pushed."""
    begin, end = FILMED
    times = [begin + k * EACH for k in range(round((end - begin) / EACH))]
    frames = []
    with live(browser, duel(seed=7)) as (served, page):
        for time in times:
            show(served, page, time)
            if abs(time - PUSHED) < 0.5 * EACH:
                served.session.push("pursuer", 0.6, 0.5 * pi)
            shot = Image.open(BytesIO(page.screenshot()))
            small = shot.convert("RGB").resize(SMALL, LANCZOS)
            frames.append(small)
    palette = frames[-1].quantize(128)
    drawn = [frame.quantize(palette=palette) for frame in frames]
    drawn[0].save(
        IMAGES / "page.gif",
        save_all=True,
        append_images=drawn[1:],
        duration=round(1000 / RATE),
        loop=0,
        optimize=True,
    )


def replay(browser: Any) -> None:
    """Take a screenshot of the offline page at its end."""
    with TemporaryDirectory() as place:
        file = Path(place) / "run.html"
        write_page(run_game(duel(seed=7, duration=60.0)), file)
        page = opened(browser, file.as_uri())
        page.get_by_text("distance").first.wait_for()
        page.keyboard.press("End")
        page.wait_for_timeout(2000)
        page.evaluate(DRAWN)
        page.screenshot(path=IMAGES / "replay.png")


TAKEN = {
    "view.png": view,
    "page.gif": film,
    "replay.png": replay,
}


def main() -> None:
    """Take the requested screenshots."""
    asked = ArgumentParser(prog="python -m tools.documents.photographs")
    asked.add_argument("names", nargs="*", choices=[*TAKEN, []])
    names = asked.parse_args().names or list(TAKEN)
    with sync_playwright() as driver:
        browser = driver.chromium.launch(
            executable_path=which("chromium"),
            args=["--no-sandbox", "--enable-unsafe-swiftshader"],
        )
        for name in names:
            TAKEN[name](browser)
            print(f"took docs/images/{name}")
        browser.close()


if __name__ == "__main__":
    main()
