"""Written and live pages in a real browser; pictures go to ``artefacts``."""

import json
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner

from injection_strings import HOSTILE
from stepaside.cli.main import main
from stepaside.core.errors import visible
from stepaside.games.game_settings import duel
from stepaside.games.run_archive import load_run
from stepaside.games.settings_reader import dump_configuration
from stepaside.report.replay_page import write_page
from stepaside.report.scene import RunScene
from stepaside.sim.person_settings import PersonSettings

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
ARTEFACTS = Path(__file__).parent.parent / "artefacts"
WAIT = 200_000  # more than a browser on a busy machine ever takes, in [ms]
OPTIONS = ["--no-sandbox", "--enable-unsafe-swiftshader"]
PAUSE = 100  # between two frames of a page that does not look, in [ms]
LIDS = """{
globalThis.looking = false;
globalThis.draws = 0;
const prototype = HTMLCanvasElement.prototype, context = prototype.getContext;
prototype.getContext = function (kind, options) {
  return context.call(this, kind, {...options, antialias: false});
};
const first = 1e9, ask = requestAnimationFrame, drop = cancelAnimationFrame;
globalThis.requestAnimationFrame = (call) => globalThis.looking ? ask(call)
  : first + setTimeout(() => call(performance.now()), @@PAUSE@@);
globalThis.cancelAnimationFrame = (number) =>
  number < first ? drop(number) : clearTimeout(number - first);
for (const kind of [WebGLRenderingContext, WebGL2RenderingContext])
  for (const name of Object.getOwnPropertyNames(kind.prototype))
    if (/^draw(Arrays|Elements|Range)/.test(name)) {
      const draw = kind.prototype[name];
      kind.prototype[name] = function (...all) {
        if (!globalThis.looking) return;
        globalThis.draws += 1;
        draw.apply(this, all);
      };
    }
}""".replace("@@PAUSE@@", str(PAUSE))
FRAMES = """() => new Promise((told) => requestAnimationFrame(
  () => requestAnimationFrame(told)))"""


@contextmanager
def launched(*options: str) -> Iterator[Any]:
    """A browser with these options."""
    import pytest

    playwright = pytest.importorskip("playwright.sync_api")
    ARTEFACTS.mkdir(exist_ok=True)
    with playwright.sync_playwright() as driver:
        chromium = driver.chromium.launch(
            executable_path=CHROMIUM,
            headless=True,
            args=[*options] or OPTIONS,
            timeout=WAIT,
        )
        yield chromium
        chromium.close()


def open_page(
    browser: Any, *, width: int = 640, height: int = 420, **options: Any
) -> Any:
    """Page that waits long for whatever it waits for, with its eyes shut.

    Args:
        browser: The browser.
        width: Of the page, in [pixels].
        height: Likewise.
        options: Of the context in which it opens.
    """
    page = browser.new_page(
        viewport={"width": width, "height": height}, **options
    )
    page.set_default_timeout(WAIT)
    page.add_init_script(LIDS)
    return page


@contextmanager
def looking(page: Any) -> Iterator[None]:
    """Let a page draw for a while."""
    page.evaluate("looking = true")
    try:
        yield
    finally:
        page.evaluate("looking = false")


def keep_picture(page: Any, name: str) -> None:
    """Look at a page, and keep what is seen in ``artefacts``.

    A page that draws only what changed draws again when it is resized.
    """
    size = page.viewport_size
    page.set_viewport_size({**size, "height": size["height"] - 1})
    page.evaluate(FRAMES)
    with looking(page):
        page.set_viewport_size(size)
        page.evaluate(FRAMES)
        page.screenshot(path=ARTEFACTS / name)


def until(page: Any, condition: Any) -> None:
    """Wait for the loop behind the page."""
    for _ in range(WAIT // 20):
        if condition():
            return
        page.wait_for_timeout(20)
    raise AssertionError("it did not happen")


pytestmark = [
    pytest.mark.skipif(CHROMIUM is None, reason="there is no Chromium here"),
    pytest.mark.xdist_group("browser"),
    pytest.mark.timeout(900),
]


@pytest.fixture(autouse=True)
def _calm(monkeypatch: pytest.MonkeyPatch) -> None:
    """No page is told more often than it looks."""
    monkeypatch.setattr("stepaside.report.viewer.live_page.RATE", 1e3 / PAUSE)


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    with launched() as chromium:
        yield chromium


@pytest.fixture(scope="module")
def flat(browser: Any) -> Iterator[tuple[Any, list[str]]]:
    """A page of a browser that draws no 3D, and what goes wrong on it."""
    chromium = browser.browser_type.launch(
        executable_path=CHROMIUM,
        headless=True,
        args=["--no-sandbox", "--disable-3d-apis"],
        timeout=WAIT,
    )
    page = chromium.new_page()
    page.set_default_timeout(WAIT)
    wrong: list[str] = []
    page.on("pageerror", lambda error: wrong.append(str(error)))
    page.on("console", lambda told: wrong.append(told.text))
    page.on("dialog", lambda dialog: wrong.append(dialog.message))
    yield page, wrong
    chromium.close()


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("runs") / "short"
    arguments = ["duel", "--seed", "3", "--duration", "4", "--json"]
    result = CliRunner().invoke(main, [*arguments, "--output", str(folder)])
    assert result.exit_code == 0
    return folder


def test_the_written_page_opens_without_a_network(
    browser: Any, run: Path, tmp_path: Path
) -> None:
    file, width = tmp_path / "run.html", 390
    write_page(load_run(run), file)
    page = open_page(
        browser, width=width, height=560, color_scheme="dark", offline=True
    )
    errors: list[str] = []
    page.on("pageerror", lambda error: errors.append(str(error)))
    page.goto(file.as_uri())
    assert page.inner_text("#clock") == "0.0 s"
    page.click("#play")
    # Not in the page, whose policy lets no text become a script.
    until(page, lambda: float(page.inner_text("#clock").split()[0]) > 0.5)
    page.click("#play")
    before = seen_at(page, 0.0)
    page.fill("#time", "70")
    assert float(page.inner_text("#clock").split()[0]) == 2.8
    after = seen_at(page, 2.8)
    assert after != before
    page.get_by_label("footsteps").uncheck()
    assert seen_at(page, 2.8) != after
    wide = page.evaluate("document.documentElement.scrollWidth")
    assert wide <= width
    keep_picture(page, "offline-dark.png")
    assert errors == []
    page.close()


def seen_at(page: Any, time: float) -> str:
    """Drawing of a written page at a time, in [s], as text, once."""
    with looking(page):
        draws = page.evaluate(f"(stepaside.seek({time}), draws)")
        drawn = page.evaluate("document.getElementById('world').toDataURL()")
        page.evaluate(FRAMES)
        assert page.evaluate("draws") == draws > 0
    assert isinstance(drawn, str)
    return drawn


def test_robots_stand_on_the_page_where_the_numbers_say(
    browser: Any, tmp_path: Path
) -> None:
    """Eight metres apart: read back from what is drawn."""
    folder = tmp_path / "far"
    asked = ["duel", "--distance", "8", "--duration", "2", "--json"]
    result = CliRunner().invoke(main, [*asked, "--output", str(folder)])
    assert result.exit_code == 0
    run = load_run(folder)
    file = tmp_path / "far.html"
    write_page(run, file)
    page = open_page(browser)
    page.goto(file.as_uri())
    stage = RunScene(run)
    for time in (0.0, 1.0, 2.0):
        page.evaluate(f"stepaside.seek({time})")
        places = page.evaluate("stepaside.positions()")
        index = min(round(time / 0.02), len(run.times) - 1)
        for name in ("pursuer", "evader"):
            body = stage.model.body(f"{name}/torso").id
            place = run.tracks[name].torso[index, :2]
            np.testing.assert_allclose(places[str(body)][:2], place, atol=2e-3)
    assert run.tracks["evader"].torso[-1, 0] > 7.0
    page.close()


def hostile_run(folder: Path, run: Path, text: str) -> Path:
    """The run, with this for every text in it that is free."""
    name = text.replace("/", "%2f")
    there = folder / name
    shutil.copytree(run, there)
    file = there / "summary.json"
    summary = json.loads(file.read_text(encoding="utf-8"))
    summary |= {"outcome": "fall", "message": text}
    summary |= {"run_folder": text, text: text}
    summary["players"]["pursuer"] |= {text: [text]}
    file.write_text(json.dumps(summary), encoding="utf-8")
    (there / "checksums.txt").unlink(missing_ok=True)
    if text.isprintable():
        own = load_run(run, "duel").settings
        person = {"body": "person", "person": PersonSettings(path=text)}
        settings = own.changed(pursuer=person)
        (there / "configuration.toml").write_text(
            dump_configuration(settings), encoding="utf-8"
        )
    return there


@pytest.mark.parametrize(
    "text",
    [*HOSTILE[4:7], "@@RUN@@", "'\"><svg>", "\x1b[2J", "a\udc80b", "&lt;"],
)
def test_nothing_in_a_run_folder_runs_in_its_page(
    flat: tuple[Any, list[str]], run: Path, tmp_path: Path, text: str
) -> None:
    there = hostile_run(tmp_path, run, text)
    write_page(load_run(there), tmp_path / "run.html")
    page, wrong = flat
    page.goto((tmp_path / "run.html").as_uri())
    assert page.inner_text("#clock") == "0.0 s"
    page.get_by_text("No 3D view").wait_for()
    page.fill("#time", page.get_attribute("#time", "max"))
    assert page.text_content("#message") == visible(text)
    assert page.text_content("h1") == visible(there.name)
    assert page.locator("img, iframe, svg").count() == 0
    assert page.locator("script").count() == 3
    assert page.evaluate("window.ran") is None
    assert wrong == []


def test_a_page_s_policy_lets_nothing_else_run(
    flat: tuple[Any, list[str]], run: Path, tmp_path: Path
) -> None:
    """Even what would get past the writing does nothing."""
    file = tmp_path / "run.html"
    write_page(load_run(run), file)
    text = file.read_text(encoding="utf-8")
    extra = "<script>ran=1</script><img src='x:' onerror='ran=2'>"
    file.write_text(text.replace("<h1>", extra + "<h1>"), encoding="utf-8")
    page, wrong = flat
    page.goto(file.as_uri())
    page.wait_for_timeout(200)
    assert page.inner_text("#clock") == "0.0 s"
    assert page.evaluate("window.ran") is None
    assert any("Content Security Policy" in told for told in wrong)
    wrong.clear()


@pytest.fixture(scope="module")
def live(browser: Any) -> Iterator[tuple[Any, Any]]:
    """The live page of a duel, and a tab that shows it."""
    pytest.importorskip("viser")
    from stepaside.report.viewer.live_page import Page

    served = Page(duel(seed=3), port=8731)
    served.start()
    page = open_page(browser)
    page.goto(f"http://127.0.0.1:{served.server.get_port()}")
    page.get_by_text("0.0 s simulated").first.wait_for()
    yield served.session, page
    page.close()
    served.close()


def press(page: Any, label: str) -> None:
    """Press a button, wherever it lies."""
    button = page.get_by_role("button", name=label, exact=True).first
    button.dispatch_event("click")


def open_tab(page: Any, name: str, inside: Any) -> None:
    """Open a tab; a click is lost while the page draws its panel anew."""
    tab = page.get_by_role("tab", name=name).first

    def is_open() -> bool:
        tab.click(force=True)
        return bool(inside.is_visible())

    until(page, is_open)


def test_a_live_game_starts_and_pauses(live: tuple[Any, Any]) -> None:
    session, page = live
    press(page, "Start")
    page.get_by_text("walking: pursuer").first.wait_for()
    press(page, "Pause")
    until(page, lambda: not session.running)
    page.get_by_role("button", name="Start", exact=True).first.wait_for()
    told = page.get_by_text("s simulated").first.inner_text()
    assert f"{session.world.time:.1f} s simulated" in told
    keep_picture(page, "live.png")


def test_a_changed_setting_acts_at_the_reset(live: tuple[Any, Any]) -> None:
    session, page = live
    field = page.get_by_label("seed").first
    open_tab(page, "Settings", field)
    field.fill("11")
    field.press("Enter")

    def is_reset() -> bool:
        """A reset before the value arrives begins another duel."""
        press(page, "reset")
        return bool(session.settings.seed == 11)

    until(page, is_reset)
    assert session.world.time == 0.0
    page.get_by_text("0.0 s simulated").first.wait_for()


@pytest.mark.usefixtures("blank_figures")
def test_a_pushed_run_is_saved(
    live: tuple[Any, Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    session, page = live
    monkeypatch.chdir(tmp_path)
    open_tab(page, "Play", page.get_by_text("Impulse").first)
    press(page, "Push")
    page.get_by_text("pushed the pursuer left by 0.5 N s").first.wait_for()
    press(page, "step")
    until(page, lambda: len(session.game.recorder.times) > 3)
    press(page, "save")
    page.get_by_text("stepaside show runs/live-seed").first.wait_for()
    (saved,) = tmp_path.glob("runs/*")
    pushes = load_run(saved).tracks["pursuer"].pushes
    assert pushes is not None and len(pushes) == 1
