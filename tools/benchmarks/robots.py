"""Take published humanoids from their model file to the circle, by commands.

The models are downloaded by hand; see docs/robots.md. Each is searched by its
path below the given folders; missing models keep their former row::

    python tools/benchmarks/robots.py FOLDER...
"""

import json
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

from benchmark_options import ask
from result_files import header, write_result

from stepaside.fitting.derivation import derive, report_of
from stepaside.fitting.description_writer import write_description
from stepaside.games.game_settings import duel, read_game
from stepaside.games.recorded_game import run_game
from stepaside.robots.description import FILE
from stepaside.studies.results_version import RESULTS

SEED, DURATION = 7, 120.0
KEPT = (
    *("outcome", "message", "duration_s", "distance_m"),
    *("relative_orientation_deg", "min_distance_m", "converged_at_s"),
    *("theory", "players"),
)


class Humanoid(NamedTuple):
    """Published model.

    Attributes:
        name: Common name.
        source: Where it is published.
        path: Its file there.
        kinematics: Distinctive features of its kinematics.
    """

    name: str
    source: str
    path: str
    kinematics: str


RL_GYM = "github.com/unitreerobotics/unitree_rl_gym"
T1 = "github.com/BoosterRobotics/booster_gym"
PLAYGROUND = "github.com/google-deepmind/mujoco_playground"
DATA = "example-robot-data (PyPI)"
N1 = "github.com/FFTAI/Wiki-GRx-Models, branch FourierN1"
GMR = "github.com/YanjieZe/GMR"
MENAGERIE = "github.com/google-deepmind/mujoco_menagerie"
BITBOTS = "github.com/bit-bots/wolfgang_robot"
XBOT = "github.com/roboterax/humanoid-gym"
UNITREE = "github.com/unitreerobotics/unitree_ros"
LITE = "github.com/HybridRobotics/Berkeley-Humanoid-Lite-Assets"
ATOM = "github.com/Roboparty/atom01_train"
HIGHTORQUE = "github.com/HighTorque-Robotics/robot_urdf"
DARWIN = "github.com/HumaRobotics/darwin_description"
NASA = "github.com/gkjohnson/nasa-urdf-robots"
TIENKUNG = "github.com/x-humanoid-robomind/TienKung_URDF"
BXI = "github.com/bxirobotics/robot_models"
GRX = "github.com/FFTAI/Wiki-GRx-Models"
HUMANOIDS = (
    Humanoid(
        *("HighTorque Hi", GMR, "hightorque_hi/hi_25dof.urdf"),
        "URDF without a free joint, soles longer behind the ankle",
    ),
    Humanoid(
        *("Robotis OP3", PLAYGROUND, "op3/xmls/op3_mjx_feetonly.xml"),
        "mirrored axes, much damping",
    ),
    Humanoid(
        *("Darwin-OP", DARWIN, "urdf/darwin.urdf"),
        "URDF, inertias in wrong units, slow joints",
    ),
    Humanoid(
        *("HighTorque Pi", HIGHTORQUE, "pi_12dof/mjcf/pi_12dof.xml"),
        "legs only, wide hips under a low CoM, meshes missing",
    ),
    Humanoid(
        *("Wolfgang-OP", BITBOTS, "wolfgang_description/urdf/robot.urdf"),
        "URDF, feet not level and knees not straight in the zero posture",
    ),
    Humanoid(
        *("Berkeley Humanoid Lite", LITE, "mjcf/berkeley_humanoid_lite.xml"),
        "inclined hips, motors and joints of one class",
    ),
    Humanoid(
        *(
            "Berkeley Humanoid",
            MENAGERIE,
            "berkeley_humanoid/berkeley_humanoid.xml",
        ),
        "feet not level in the zero posture, narrow soles",
    ),
    Humanoid(
        *("Unitree R1", UNITREE, "r1_description/R1.urdf"),
        "URDF with the rods of its ankles as fixed links, inclined hips",
    ),
    Humanoid(
        *("BXI Elf2", BXI, "elf2_dof25/xml/elf2_dof25.xml"),
        "weak ankles, soles as long behind as ahead, meshes missing",
    ),
    Humanoid(
        *("Roboparty Atom01", ATOM, "atom/mjcf/atom01.xml"),
        "three slides and a ball in place of a free joint, inclined hips",
    ),
    Humanoid(
        *("Booster T1", T1, "T1/T1_serial.urdf"),
        "URDF without a free joint, weak hips, waist above the legs",
    ),
    Humanoid(
        *("Booster T1, 35 kg", T1, "T1/T1_serial.xml"),
        "torque motors, weak hips, narrow soles",
    ),
    Humanoid(
        *("Booster T1, 32 kg", MENAGERIE, "booster_t1/t1.xml"),
        "position servos, weak hips",
    ),
    Humanoid(
        *("Unitree G1", RL_GYM, "g1_description/g1_29dof.xml"),
        "torque motors, waist of three joints",
    ),
    Humanoid(
        *("iCub", "icub-models (PyPI)", "iCubGazeboV2_5/model.urdf"),
        "URDF whose torso looks backward",
    ),
    Humanoid(
        *("Fourier N1", N1, "N1/urdf/N1_raw.urdf"),
        "URDF without a free joint, weak ankles",
    ),
    Humanoid(
        *("EngineAI PM01", GMR, "engineai_pm01/pm_v2.xml"),
        "MJCF of several files, inclined hips, meshes missing",
    ),
    Humanoid(
        *(
            "Pndbotics Adam Lite",
            MENAGERIE,
            "pndbotics_adam_lite/adam_lite.xml",
        ),
        "torques of ankles far below those of hips, meshes missing",
    ),
    Humanoid(
        *("RobotEra XBot-L", XBOT, "XBot/mjcf/XBot-L.xml"),
        "dated MJCF, hip roll before yaw and pitch",
    ),
    Humanoid(
        *(
            "Tiangong Pro",
            TIENKUNG,
            "pro_urdf_publish/pro_urdf_publish/urdf/humanoid.urdf",
        ),
        "URDF without a free joint, hands of many joints, meshes missing",
    ),
    Humanoid(
        *("Fourier GR1T2", GRX, "GR1/gr1t2/basic_urdf/gr1t2.urdf"),
        "URDF without a free joint, narrow soles, weak ankles",
    ),
    Humanoid(
        *("Leju Kuavo S45", GMR, "kuavo_s45/biped_s45.urdf"),
        "URDF without a free joint, feet close together",
    ),
    Humanoid(
        *("Aldebaran Romeo", DATA, "romeo_description/urdf/romeo.urdf"),
        "slow joints, soles that cannot be read",
    ),
    Humanoid(
        *("Unitree H1-2", RL_GYM, "h1_2/h1_2_12dof.xml"),
        "torque motors, legs only",
    ),
    Humanoid(
        *(
            "Apptronik Apollo",
            MENAGERIE,
            "apptronik_apollo/apptronik_apollo.xml",
        ),
        "position servos, waist of three joints, meshes missing",
    ),
    Humanoid(
        *("PAL Talos", DATA, "talos_data/robots/talos_reduced.urdf"),
        "URDF without a free joint, torso of two joints",
    ),
    Humanoid(
        *(
            "NASA Valkyrie",
            NASA,
            "val_description/model/robots/valkyrie_D.urdf",
        ),
        "URDF without a free joint, 134 kg, meshes missing",
    ),
)


def find(humanoid: Humanoid, folders: list[Path]) -> Path | None:
    """Return the file of a model below the given folders."""
    return next(
        (
            file
            for folder in folders
            for file in sorted(folder.rglob(Path(humanoid.path).name))
            if file.as_posix().endswith(humanoid.path)
        ),
        None,
    )


def measure(humanoid: Humanoid, model: Path) -> dict[str, Any]:
    """Derive a description, run a duel of two, and return the results."""
    with TemporaryDirectory() as made:
        folder = Path(made)
        derived = derive(model, folder, [])
        text = write_description(derived)
        (folder / FILE).write_text(text, encoding="utf-8")
        settings = read_game(
            {"robot": made}, base=duel(seed=SEED, duration=DURATION)
        )
        run = run_game(settings)
    facts, told = report_of(derived), run.results()
    asked = facts["missing_values"]
    return {
        **humanoid._asdict(),
        **{
            key: facts[key]
            for key in ("mass_kg", "leg_length_m", "com_height_m")
        },
        "gait": facts["gait"],
        "lengths_share": facts["lengths_share"],
        "control": dict(derived.description.control),
        "missing_values": {
            "sole": asked["sole"],
            "torques": len(asked["torques"]),
            "speed_limits": len(asked["speed_limits"]),
        },
        "omitted_meshes": facts["omitted_meshes"],
        "results": RESULTS,
        "summary": {key: told[key] for key in KEPT},
    }


def main() -> None:
    """Measure all models found; write after each."""
    asked = ask(__doc__, "robots.json")
    asked.add_argument("folders", type=Path, nargs="+")
    asked.add_argument("--only", help="names that hold this, alone")
    arguments = asked.parse_args()
    rows: dict[str, Any] = {}
    if arguments.output.is_file():
        kept = json.loads(arguments.output.read_text(encoding="utf-8"))
        rows = {row["name"]: row for row in kept["rows"]}
    for humanoid in HUMANOIDS:
        model = find(humanoid, arguments.folders)
        if model is None or (arguments.only or "") not in humanoid.name:
            continue
        rows[humanoid.name] = row = measure(humanoid, model)
        summary = row["summary"]
        print(humanoid.name, summary["message"], summary["distance_m"])
        names = [h.name for h in HUMANOIDS if h.name in rows]
        head = header(
            {"seed": SEED, "duration_s": DURATION},
            command="python tools/benchmarks/robots.py FOLDER...",
        )
        write_result(
            arguments.output, head, rows=[rows[name] for name in names]
        )


if __name__ == "__main__":
    main()
