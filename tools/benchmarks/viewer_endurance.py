"""Keep a live page open for long and measure its cost.

Two pages are opened and closed ten times over the given time while the duel
runs in real time. Before that the duel runs at full speed, without and with
one page. Requires Chromium::

    python tools/benchmarks/viewer_endurance.py --minutes 30
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import shutil
from pathlib import Path
from time import perf_counter, sleep
from typing import Any

from benchmark_options import ask, machine
from playwright.sync_api import sync_playwright

from stepaside.games import DuelSettings
from stepaside.report.viewer.live_page import Page
from stepaside.studies.result_files import header, write_result

PORT = 8741
CYCLES = 10
SPRINT = 10.0  # time over which speed is measured, in [s]


class CountedPage(Page):
    """Page that counts its updates."""

    updates = 0

    def refresh(self) -> None:
        """Count the updates of the page."""
        super().refresh()
        self.updates += 1


def resident() -> float:
    """Return the resident memory of this process, in [MB]."""
    for line in Path("/proc/self/status").read_text().splitlines():
        if line.startswith("VmRSS:"):
            return int(line.split()[1]) / 1024.0
    raise OSError("/proc/self/status has no VmRSS")


def watch(page: CountedPage, duration: float) -> dict[str, float]:
    """Return real-time factor and updates per second over a time in [s]."""
    session = page.session
    began, updates = perf_counter(), page.updates
    time = session.match.world.time
    while perf_counter() - began < duration:
        sleep(0.1)
        if session.outcome is not None:
            raise SystemExit(f"the duel ended: {session.outcome.value}")
    passed = perf_counter() - began
    return {
        "real_time_factor": (session.match.world.time - time) / passed,
        "updates_per_s": (page.updates - updates) / passed,
    }


def visit(browser: Any) -> Any:
    """Open the page in a new browser context, and wait for its controls."""
    context = browser.new_context(viewport={"width": 640, "height": 420})
    tab = context.new_page()
    tab.goto(f"http://127.0.0.1:{PORT}")
    tab.get_by_text("simulated").first.wait_for(timeout=60_000)
    return context


def come_and_go(
    page: CountedPage, browser: Any, minutes: float
) -> dict[str, Any]:
    """Return the memory while two pages are opened and closed repeatedly."""
    first = most = resident()
    began, cycles = perf_counter(), []
    for cycle in range(1, CYCLES + 1):
        contexts = [visit(browser) for _ in range(2)]
        due = began + (cycle - 0.2) * 60.0 * minutes / CYCLES
        found = watch(page, max(due - perf_counter(), 2.0))
        for context in contexts:
            context.close()
        due += 0.2 * 60.0 * minutes / CYCLES
        sleep(max(due - perf_counter(), 0.5))
        most = max(most, resident())
        cycles.append({**found, "resident_mb": resident()})
        print(f"two pages, time {cycle}: {cycles[-1]}", flush=True)
    return {
        "first_mb": first,
        "last_mb": resident(),
        "greatest_mb": most,
        "minutes": (perf_counter() - began) / 60.0,
        "least_real_time_factor": min(c["real_time_factor"] for c in cycles),
        "least_updates_per_s": min(c["updates_per_s"] for c in cycles),
        "cycles": cycles,
    }


def main() -> None:
    """Measure and write the results."""
    asked = ask(__doc__, "viewer.json")
    asked.add_argument("--minutes", type=float, default=30.0)
    arguments = asked.parse_args()
    page = CountedPage(DuelSettings(seed=7), port=PORT)
    page.start()
    session = page.session
    session.running, session.speed = True, float("inf")
    live: dict[str, Any] = {"alone": watch(page, SPRINT)}
    live["alone"]["updates_per_s"] = None
    with sync_playwright() as driver:
        browser = driver.chromium.launch(
            executable_path=shutil.which("chromium"),
            args=["--no-sandbox", "--enable-unsafe-swiftshader"],
        )
        context = visit(browser)
        live["one_page"] = watch(page, SPRINT)
        session.speed = 1.0
        live["real_time"] = watch(page, SPRINT)
        context.close()
        print(live, flush=True)
        memory = come_and_go(page, browser, arguments.minutes)
        browser.close()
    page.close()
    settings = {"seed": 7, "minutes": arguments.minutes, "cycles": CYCLES}
    write_result(
        arguments.output,
        header(settings),
        machine=machine(),
        live=live,
        memory=memory,
    )


if __name__ == "__main__":
    main()
