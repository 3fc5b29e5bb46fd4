"""Let axe-core look at the live, the replayed and the written page.

It comes from the npm registry and is not kept here::

    npm pack axe-core && tar xf axe-core-*.tgz
    python tools/checks/accessibility.py --axe package/axe.min.js

Prints for each page which rules fail, and where. The exit status is 1 if one
does.
"""

import shutil
from argparse import ArgumentParser
from itertools import product
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from click.testing import CliRunner
from playwright.sync_api import sync_playwright

from stepaside.cli.main import main as stepaside
from stepaside.games.duel_settings import DuelSettings
from stepaside.games.run_archive import load_run
from stepaside.report.replay_page import write_page
from stepaside.report.viewer.live_page import Page
from stepaside.report.viewer.replay_viewer import ReplayPage

WAIT = 200_000  # in [ms]
DESK, PHONE = {"width": 1280, "height": 720}, {"width": 390, "height": 844}
SHOWN = 6  # places of a rule that are printed
BLIND = """for (const kind of [WebGLRenderingContext, WebGL2RenderingContext])
  for (const name of Object.getOwnPropertyNames(kind.prototype))
    if (/^draw/.test(name)) kind.prototype[name] = () => {};"""


def look(page: Any, axe: str) -> list[tuple[str, list[str]]]:
    """Return the rules that fail on a page, with the failing elements."""
    page.evaluate(axe)
    found = page.evaluate("axe.run(document)")["violations"]
    return [
        (
            f"{rule['id']} ({rule['impact']})",
            [where(node) for node in rule["nodes"]],
        )
        for rule in found
    ]


def where(node: Any) -> str:
    """Return a failing element, with its colours if they are the cause."""
    told = " ".join(map(str, node["target"]))
    data = node["any"][0].get("data") if node["any"] else None
    if isinstance(data, dict) and "contrastRatio" in data:
        told += " {fgColor} on {bgColor}: {contrastRatio}".format(**data)
    return told


def tell(name: str, rules: list[tuple[str, list[str]]]) -> None:
    """Print the failures of a page."""
    print(f"{name}: {len(rules)} rules fail")
    for rule, places in rules:
        print(f"  {rule}: {len(places)} places")
        for place in sorted({each[-90:] for each in places})[:SHOWN]:
            print(f"    {place}")


def main() -> int:
    """Check each page in light and dark mode, on a desktop and a phone."""
    asked = ArgumentParser(description=__doc__)
    asked.add_argument("--axe", type=Path, required=True)
    axe = asked.parse_args().axe.read_text(encoding="utf-8")
    failing = 0
    with TemporaryDirectory() as place, sync_playwright() as driver:
        folder = Path(place) / "run"
        words = ["duel", "--duration", "3", "--output", str(folder)]
        if CliRunner().invoke(stepaside, words).exit_code:
            raise SystemExit("no duel was played")
        run, file = load_run(folder), Path(place) / "run.html"
        write_page(run, file)
        live = Page(DuelSettings(), host="127.0.0.1", port=8781)
        replay = ReplayPage(run, port=8785)
        browser = driver.chromium.launch(
            executable_path=shutil.which("chromium"),
            args=["--no-sandbox", "--enable-unsafe-swiftshader"],
        )
        address = "http://127.0.0.1:{}".format
        links = {
            "live page": address(live.server.get_port()),
            "replayed page": address(replay.server.get_port()),
            "written page": file.as_uri(),
        }
        live.start()
        replay.start()
        for name, link in links.items():
            for light, phone in product(("light", "dark"), (False, True)):
                page = browser.new_page(
                    color_scheme=light,
                    has_touch=phone,
                    viewport=PHONE if phone else DESK,
                )
                page.set_default_timeout(WAIT)
                page.add_init_script(BLIND)
                page.goto(link)
                page.get_by_text("distance").first.wait_for()
                if light == "dark" and name != "written page":
                    button = page.get_by_role("button", name="dark").first
                    button.dispatch_event("click")
                    page.wait_for_timeout(2000)
                rules = look(page, axe)
                failing += len(rules)
                tell(f"{name}, {light}{', phone' * phone}", rules)
                page.close()
        browser.close()
        live.close()
        replay.close()
    return int(failing > 0)


if __name__ == "__main__":
    raise SystemExit(main())
