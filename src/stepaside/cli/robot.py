"""``stepaside robot``: show, describe, check or tune a robot."""

from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..core.atomic_output import atomic_draft, check_file, check_folder
from ..core.errors import StepAsideError
from ..core.progress import ProgressLine
from .main import LazyGroup
from .options import (
    EXISTING_FILE,
    EXISTING_FOLDER,
    figure_option,
    folder_option,
    workers_option,
)
from .study_output import executor_option
from .tables import plain, print_table, result_rows
from .terminal import (
    echo,
    exit_interrupted,
    json_option,
    print_json,
    resume_message,
    write_result,
)

if TYPE_CHECKING:
    from ..fitting.gait_search import RatedCandidate, SearchResult
    from ..robots.description import RobotDescription

COMMANDS = {
    "show": "Show a robot; the word may be left out before its name.",
    "init": "Derive a description from a published model.",
    "check": "Check whether a robot can play.",
    "tune": "Search for the steadiest gait and store it.",
    "legs": "Inspect or measure a learned walking policy.",
}
RECORDS = "tune.sqlite"


@click.group(
    "robot",
    cls=LazyGroup,
    lazy=COMMANDS,
    modules={"legs": "legs"},
    module="robot",
    default="show",
)
def robot(**_: Any) -> None:
    """Show a robot, or describe a new one from its published model.

    A robot is a built-in one (nao), or a folder with a robot.toml and a
    model.
    """


@click.command("show")
@click.argument("name", default="nao")
@click.option("--mjcf", is_flag=True, help="Print the MuJoCo model only.")
@click.option(
    "--compile",
    "stores",
    is_flag=True,
    help="Store the kinematic tree next to the description, so that the robot "
    "can be controlled without MuJoCo.",
)
@json_option
def show(name: str, mjcf: bool, stores: bool, as_json: bool) -> None:
    """Show the robot NAME, or print its MuJoCo model.

    NAME is a built-in robot (nao) or a folder with a robot.toml and a model.
    """
    from ..robots.description import load_robot

    description = load_robot(name)
    if mjcf:
        write_result(description.mjcf() + "\n")
        return
    if stores:
        from ..robots.tree_cache import store_tree

        echo(f"wrote {store_tree(description)}", err=True)
        return
    from ..robots.tree_compiler import coupled_joints

    model = description.compile()
    facts = {
        "name": description.name,
        "mass_kg": round(float(model.body_subtreemass[0]), 6),
        "links": int(model.nbody - 1),
        "hinges": int(model.njnt - 1),
        "motors": int(model.nu),
        "coupled": coupled_joints(model, description.name),
        "folder": str(description.folder),
    }
    print_json(facts) if as_json else print_table(result_rows(facts))


@click.command("init")
@click.argument("model", type=EXISTING_FILE)
@folder_option(
    help="Folder for the description; a new folder with the name of the "
    "model by default."
)
@click.option(
    "--meshes",
    multiple=True,
    type=EXISTING_FOLDER,
    help="Folder with mesh files; repeatable. The folder of the model by "
    "default.",
)
@click.option(
    "--overwrite", is_flag=True, help="Replace the description in the folder."
)
@json_option
def init(
    model: Path,
    output: Path | None,
    meshes: tuple[Path, ...],
    overwrite: bool,
    as_json: bool,
) -> None:
    """Derive a robot description from a published MODEL (MJCF or URDF).

    Derives legs, soles, servos, posture, gait and distances, and writes each
    value with its source. The model is neither changed nor copied. Values
    that the model does not contain are marked ASK in the description: search
    for it and fill them in.
    """
    from ..core.setting import entries_of
    from ..fitting.derivation import derive, report_of
    from ..fitting.description_writer import write_description
    from ..planning import GaitSettings
    from ..robots.description import FILE, load_robot

    folder = output or Path(model.stem)
    file = folder / FILE
    if folder.is_dir():
        check_file(file, "output", overwrite=overwrite)
    else:
        check_folder(folder, "output", new=True)
    derived = derive(model, folder, list(meshes))
    facts = report_of(derived) | {"folder": str(folder), "file": str(file)}
    failed: Exception | None = None
    try:
        with atomic_draft(file) as draft:
            draft.write_text(write_description(derived), encoding="utf-8")
        load_robot(folder)
    except (StepAsideError, OSError) as error:
        failed = error
    if as_json:
        print_json(facts)
    else:
        gait = {}
        for name, value in facts["gait"].items():
            known = entries_of(GaitSettings)[name].described.range
            gait[name] = f"{value} {known.unit if known else ''}"
        print_table(result_rows(facts | {"gait": gait}))
    if failed is not None:
        raise failed
    if not as_json:
        asked = any(facts["missing_values"].values())
        first = "replace the values marked ASK, then " if asked else ""
        echo(f"\nwrote {file}; next: {first}stepaside robot check {folder}")


@click.command("check")
@click.argument("folder")
@workers_option
@figure_option(help="Write an image of the standing robot with its soles.")
@json_option
def check(
    folder: str, workers: int | None, figure: Path | None, as_json: bool
) -> None:
    """Check whether the robot in FOLDER can play.

    Checks the description, then simulates walks forward, backward and
    turning, in open loop and with feedback. Then it walks at random, to
    measure how far its body departs from its template, and writes that beside
    the description. The exit status is 1 if a check fails.
    """
    from ..core.worker_pool import worker_pool
    from ..fitting.robot_verification import check_robot
    from ..robots.description import load_robot

    description = load_robot(folder)
    with (
        worker_pool(workers) as executor,
        ProgressLine("check", unit="walks") as bar,
    ):
        report = check_robot(description, executor, bar.show)
    if report.departure is not None:
        from ..games.player_settings import settings_from_description
        from ..locomotion.departures import store_departure

        gait = settings_from_description(description).gait
        with suppress(OSError):  # of a package that is not writable
            store_departure(description, gait, report.departure)
    if as_json:
        print_json({"robot": description.name} | report.to_json())
    else:
        found = report.findings
        print_table([(f.name, f"{f.verdict:<4}  {f.value}") for f in found])
        if report.departure is not None:
            echo("")
            departure = report.to_json()["departure_m"]
            print_table(result_rows({"departure_m": departure}))
        elif report.walks:
            echo("\nno departures stored: a walk at random ended early")
        hints = [f"{f.name}: {f.hint}" for f in found if f.hint]
        passed = "all checks passed: the robot can play"
        end = passed if report.passes else "the robot cannot play yet"
        echo("\n".join(["", *hints, *([""] if hints else []), end]))
    if figure is not None:
        from ..report.robot_figure import draw_robot

        draw_robot(description, figure)
    if not report.passes:
        raise SystemExit(1)


@click.command("tune")
@click.argument("folder", type=EXISTING_FOLDER)
@workers_option
@executor_option
@json_option
def tune(
    folder: Path, workers: int | None, executor: str, as_json: bool
) -> None:
    """Find the steadiest gait of the robot in FOLDER and store it.

    Varies servo gains, support durations, stride, foot spacing, lean, ZMP
    position, CoM height and feedback in short simulated walks on all cores.
    The best gait is written to the description with its measurements. Walks
    are recorded in FOLDER/tune.sqlite, so that an interrupted search can be
    continued with the same command.
    """
    from ..fitting.description_writer import rewrite_description
    from ..robots.description import FILE, load_robot

    description = load_robot(folder)
    tuned = _search(description, folder / RECORDS, workers, executor)
    best = tuned.best.candidate.applied(description)
    assert best is not None
    changed = tuned.best.candidate != tuned.before.candidate
    if changed:
        file = folder / FILE
        text = file.read_text(encoding="utf-8")
        lines = _comment_lines(tuned)
        with atomic_draft(file) as draft:
            draft.write_text(
                rewrite_description(text, best, lines), encoding="utf-8"
            )
    facts = {
        "robot": description.name,
        "changed": changed,
        "tried": tuned.tried,
        "before": _to_json(tuned.before),
        "best": _to_json(tuned.best),
        "gait": dict(best.gait),
    }
    if as_json:
        print_json(facts)
    else:
        print_table(result_rows(plain(facts)))
        if changed:
            end = f"wrote {folder}/robot.toml"
        elif tuned.tried == 1:
            end = (
                "the gait is steady already (tune improves steadiness, not "
                "torques): the description is unchanged"
            )
        else:
            end = "no better gait was found: the description is unchanged"
        echo(f"\n{end}")
    if tuned.best.unsteadiness >= 1.0:
        raise SystemExit(1)


def _search(
    description: "RobotDescription",
    records: Path,
    workers: int | None,
    executor: str,
) -> "SearchResult":
    """Search with a progress bar on standard error."""
    from ..fitting.gait_search import search_gait
    from ..studies.study import open_executor

    with (
        open_executor(executor, workers) as opened,
        ProgressLine("tune", unit="gaits") as bar,
    ):

        def report(tried: int, of: int, least: float) -> None:
            bar.show(tried, of, f"unsteadiness {least:.2f}")

        try:
            return search_gait(description, opened, records, report)
        except KeyboardInterrupt:
            exit_interrupted(resume_message(f"{bar.n} gaits", records))


def _to_json(rated: "RatedCandidate") -> dict[str, Any]:
    return {
        "unsteadiness": rated.unsteadiness,
        "changes": rated.candidate._asdict(),
        "walks": list(rated.walks),
    }


def _comment_lines(tuned: "SearchResult") -> list[str]:
    """Return the measurements as lines of a comment."""
    before, best = tuned.before, tuned.best
    was = before.candidate._asdict()
    changes = [
        f"{name} {value:g}"
        for name, value in best.candidate._asdict().items()
        if value != was[name]
    ]
    return [
        f"{', '.join(changes) or 'nothing changed'};",
        f"unsteadiness {before.unsteadiness:.2f} before, "
        f"{best.unsteadiness:.2f} after (steady below 1),",
        f"best of {tuned.tried} gaits.",
        *(
            f"{walk['way']}: tilt {walk['tilt']:.2f} deg, speed "
            f"{walk['speed']:.3f} of the planned one"
            for walk in best.walks
            if walk["completed"]
        ),
    ]
