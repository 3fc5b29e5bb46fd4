"""Odometry of a robot, where its soles really are."""

from ...core.poses import Pose
from ...games.player import PhysicalPlayer, Player
from ...planning import Foot


def true_odometry(player: Player) -> Pose | None:
    """Return the pose of a robot's odometry in the world, as of now.

    It is the pose in which the supporting sole of the plan is where it is in
    simulation: plans drawn in it begin at the robot's foot, though its
    odometry drifts.

    Args:
        player: The player.

    Returns:
        The pose; None for a player that does not plan.
    """
    if not isinstance(player, PhysicalPlayer):
        return None
    snapshot = player.snapshot()
    if snapshot.walk is None:
        return None
    step = snapshot.walk.step(snapshot.time)
    stance, foot = player.robot.stance, step.swing.other
    sole = stance.left_sole if foot is Foot.LEFT else stance.right_sole
    return sole.compose(step.support.inverse())
