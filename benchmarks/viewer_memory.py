"""Keep a live page open for long and print what it costs.

Usage: python benchmarks/viewer_memory.py [minutes]

Two pages are opened and closed ten times over the given time (30 minutes by
default) while the duel runs at real time. Before that the duel runs as fast
as it goes, without and with one page. Needs Chromium.
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import shutil
import sys
from pathlib import Path
from time import perf_counter, sleep
from typing import Any

from playwright.sync_api import sync_playwright

from stepaside.report.viewer.page import Page
from stepaside.simulation import DuelSettings

PORT = 8741
CYCLES = 10
SPRINT = 10.0  # how long speed is measured, in [s]


class CountedPage(Page):
    """A page that counts its updates."""

    updates = 0

    def _refresh(self) -> None:
        super()._refresh()
        self.updates += 1


def resident() -> float:
    """Resident memory of this process, in [MB]."""
    for line in Path("/proc/self/status").read_text().splitlines():
        if line.startswith("VmRSS:"):
            return int(line.split()[1]) / 1024.0
    raise OSError("/proc/self/status has no VmRSS")


def watch(page: CountedPage, duration: float) -> tuple[float, float]:
    """Real-time factor and updates a second over a while, in [s]."""
    session = page.session
    began, updates = perf_counter(), page.updates
    time = session.duel.world.time
    while perf_counter() - began < duration:
        sleep(0.1)
        if session.outcome is not None:
            raise SystemExit(f"the duel ended: {session.outcome.value}")
    passed = perf_counter() - began
    return (
        (session.duel.world.time - time) / passed,
        (page.updates - updates) / passed,
    )


def visit(browser: Any) -> Any:
    """Open the page in a context of its own, and wait for its controls."""
    context = browser.new_context(viewport={"width": 640, "height": 420})
    tab = context.new_page()
    tab.goto(f"http://127.0.0.1:{PORT}")
    tab.get_by_text("simulated").first.wait_for(timeout=60_000)
    return context


def main() -> None:
    """Measure and print."""
    minutes = float(sys.argv[1]) if len(sys.argv) > 1 else 30.0
    began = perf_counter()
    page = CountedPage(DuelSettings(seed=7), host="127.0.0.1", port=PORT)
    page.start()
    print(f"serves after {perf_counter() - began:.1f} s (imports apart)")
    session = page.session
    session.running, session.speed = True, float("inf")
    factor, _ = watch(page, SPRINT)
    print(f"as fast as it goes, no page: {factor:.1f} x real time")
    with sync_playwright() as driver:
        browser = driver.chromium.launch(
            executable_path=shutil.which("chromium"),
            args=["--no-sandbox", "--enable-unsafe-swiftshader"],
        )
        context = visit(browser)
        factor, updates = watch(page, SPRINT)
        print(
            f"as fast as it goes, one page: {factor:.1f} x real time, "
            f"{updates:.0f} updates a second"
        )
        session.speed = 1.0
        factor, updates = watch(page, SPRINT)
        print(
            f"live, one page: {factor:.2f} x real time, "
            f"{updates:.0f} updates a second"
        )
        context.close()
        start = resident()
        print(f"resident at first: {start:.0f} MB", flush=True)
        began, most = perf_counter(), start
        for cycle in range(1, CYCLES + 1):
            contexts = [visit(browser) for _ in range(2)]
            due = began + (cycle - 0.2) * 60.0 * minutes / CYCLES
            left = max(due - perf_counter(), 2.0)
            factor, updates = watch(page, left)
            for context in contexts:
                context.close()
            due += 0.2 * 60.0 * minutes / CYCLES
            sleep(max(due - perf_counter(), 0.5))
            most = max(most, resident())
            print(
                f"two pages, time {cycle}: {factor:.2f} x real time, "
                f"{updates:.0f} updates a second, "
                f"resident {resident():.0f} MB",
                flush=True,
            )
        browser.close()
    print(
        f"growth over {(perf_counter() - began) / 60.0:.1f} minutes: "
        f"{resident() - start:.0f} MB, at most {most - start:.0f} MB"
    )
    page.close()


if __name__ == "__main__":
    main()
