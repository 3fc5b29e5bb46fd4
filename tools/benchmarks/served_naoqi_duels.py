"""Run served duels over NAOqi with footsteps or joints, not velocities."""

from benchmark_options import ask
from served_processes import write_rows
from served_velocity_duels import played

DUELS = (  # motion interface, body, whether in lockstep
    ("footsteps", "delayed", False),
    ("joints", "delayed", False),
)


def main() -> None:
    """Run every motion interface."""
    parser = ask(__doc__, "served-naoqi.json")
    parser.add_argument("--seed", type=int, default=7)
    parser.add_argument("--duration", type=float, default=120.0)
    arguments = parser.parse_args()
    duels = (
        played(arguments, "naoqi", body, lock_step, by) | {"by": by}
        for by, body, lock_step in DUELS
    )
    write_rows(arguments, duels)


if __name__ == "__main__":
    main()
