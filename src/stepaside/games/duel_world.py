"""World of a duel with its players."""

from collections.abc import Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple

import mujoco

from ..arena import NO_OBSTACLES
from ..core.errors import ConfigurationError
from ..core.poses import Pose
from ..core.random_streams import named_generator
from ..locomotion.policy.network_pool import NetworkPool
from ..locomotion.zmp.reference_table import standing_reference
from ..planning import Direction
from ..robots.description import load_robot
from ..robots.head import load_head
from ..robots.leg_kinematics import LegKinematics
from ..sim.body_settings import at_tick, with_control_period
from ..sim.ground_truth import GroundTruth
from ..sim.ideal_sensors import IdealLineOfSight
from ..sim.pedestrian_appearance import FIGURES
from ..sim.person_body import PersonBody
from ..sim.person_motion import PersonMotion
from ..sim.physics_settings import PhysicsSettings
from ..sim.push import pushes_by_robot
from ..sim.world import World
from ..strategies import load_strategy
from .duel_furnishing import furnishing_of, movers_in
from .duel_settings import (
    EVADER,
    PLAYERS,
    PURSUER,
    DuelSettings,
    load_evader,
)
from .floor_player import FloorPlayer, PathSteering
from .player import Player
from .served_player import ServedPlayer
from .walker import RobotPlayer
from .walker_factory import (
    CameraSensing,
    WalkerSetup,
    clearance_in,
    place_robot,
    place_walker,
)

if TYPE_CHECKING:
    from ..sim.sensor_suite import SensorSuite
    from .camera_duel import CameraSenses, SightObserver


class RemoteControl(NamedTuple):
    """How another process controls a robot.

    Attributes:
        balances: Whether the robot balances itself and follows commanded
            velocities; otherwise its joints are commanded.
        ideal_sight: Whether the true line of sight is measured.
    """

    balances: bool
    ideal_sight: bool


class DuelWorld:
    """World of a duel with its players, ready for the first tick.

    Attributes:
        world: World with robots, people and obstacles.
        players: Pursuer and evader.
        networks: Networks of robots on learned legs.
        has_things: Whether there are obstacles besides the players.
    """

    def __init__(
        self,
        settings: DuelSettings,
        frames: tuple[Pose, Pose],
        *,
        rendered: bool,
        remote: Mapping[str, RemoteControl] = MappingProxyType({}),
        networks: NetworkPool | None = None,
    ) -> None:
        """Build the world and place the players in it.

        Args:
            settings: Settings of the duel, with the initial poses filled in.
            frames: Initial poses of pursuer and evader in the world.
            rendered: Whether to render the world; cameras do so anyway.
            remote: Control of the robots that other processes control, by
                name of the player.
            networks: Networks of robots on learned legs, shared with other
                duels.

        Raises:
            StepAsideError: If the settings contradict each other or cannot
                be met by the robots.
        """
        self._settings, self._remote = settings, remote
        if settings.sensing == "lidar" and remote:
            raise ConfigurationError(
                "sensing must be ideal or cameras for a robot that another "
                "process controls, got 'lidar'"
            )
        self.networks = networks or NetworkPool()
        self.has_things = bool(
            settings.room.things or settings.room.plan or settings.passers
        )
        self._setups = {
            name: _setup_of(settings, name, frames[PLAYERS.index(name)])
            for name in settings.robots
        }
        physics = _physics_of(settings, self._setups, self.networks)
        self._strategies = {
            name: load_evader(settings)
            if name == EVADER
            else load_strategy(settings.pursuer_strategy, settings.strategy)
            for name in PLAYERS
            if name in self._setups and name not in remote
        }
        directions = {n: s.direction for n, s in self._strategies.items()}
        self._senses = _camera_senses(
            settings, self._setups, directions, physics.tick
        )
        self.world = World(
            {name: own.description for name, own in self._setups.items()},
            physics,
            settings.body,
            settings.seed,
            furnishing_of(settings),
            rendered=rendered or self._senses is not None,
        )
        for move in movers_in(settings, self.world.model, self.world.data):
            move(0.0)
            self.world.before_step.append(move)
        # A player's ideal sensor needs the true state of its opponent.
        self._robot_truths = {
            name: setup.true_state_in(self.world)
            for name, setup in self._setups.items()
        }
        self._truths: dict[str, GroundTruth] = {**self._robot_truths}
        person = None if PURSUER in self._setups else self._person(frames)
        pursuer = self._robot(PURSUER) if person is None else person
        self.players = (pursuer, self._robot(EVADER))
        mujoco.mj_forward(self.world.model, self.world.data)
        for name, pushes in pushes_by_robot(
            settings.pushes, settings.robots
        ).items():
            if pushes:
                self.players[PLAYERS.index(name)].push(*pushes)

    def _person(self, frames: tuple[Pose, Pose]) -> Player:
        """Place the person who pursues, whose truth sensors may need."""
        settings, plan = self._settings.person, self._settings.room.plan
        walk = PersonMotion(
            settings,
            frames[0],
            frames[1][:2],
            NO_OBSTACLES if plan is None else plan.solid_set,
        )
        figure = FIGURES[settings.figure]
        body = PersonBody(self.world, PURSUER, walk.pose, figure)
        self._truths[PURSUER] = body.truth
        evader, tick = self._truths[EVADER], self.world.physics.tick
        return FloorPlayer(body, PathSteering(walk, evader, tick))

    def _robot(self, name: str) -> Player:
        """Place a robot in the world, with the sensors of the settings."""
        remote = self._remote.get(name)
        sight, eyes = None, None
        if self._senses is not None:
            eyes = self._senses.eyes_of(self.world, name)
        elif self._settings.sensing == "lidar":
            return self._controlled_robot(name, None, None)
        elif remote is None or remote.ideal_sight:
            settings = self._settings
            sight = IdealLineOfSight(
                self._truths[name],
                self._truths[PURSUER if name == EVADER else EVADER],
                settings.sight,
                named_generator(settings.seed, f"sight/{name}"),
            )
        if remote is None:
            return self._controlled_robot(name, sight, eyes)
        return self._remote_robot(name, sight, eyes, balances=remote.balances)

    def _controlled_robot(
        self,
        name: str,
        sight: IdealLineOfSight | None,
        eyes: "SensorSuite | None",
    ) -> Player:
        """Place a robot that this process controls."""
        settings, setup = self._settings, self._setups[name]
        played, truth = self._strategies[name], self._robot_truths[name]
        cameras = None
        if settings.sensing == "lidar":
            cameras = self._lidar_of(setup)
        elif self._senses is not None and eyes is not None:
            cameras = CameraSensing(eyes, self._senses.perceptions[name])
        clearance = clearance_in(
            settings.room.plan,
            settings.map,
            setup,
            self._senses.perceptions[name] if self._senses else None,
        )
        legs = settings.robot_of(name).legs
        if legs.walks:
            from .policy_player import place_policy_player

            return place_policy_player(
                self.world,
                setup,
                legs,
                played,
                sight=sight,
                cameras=cameras,
                truth=truth,
                networks=self.networks,
                clearance=clearance,
            )
        return place_walker(
            self.world,
            setup,
            played,
            sight=sight,
            cameras=cameras,
            truth=truth,
            clearance=clearance,
        )

    def _lidar_of(self, setup: WalkerSetup) -> CameraSensing:
        """Return the sensing of a robot with a lidar."""
        from ..perception.lidar_perception import LidarPerception
        from ..sim.lidar import Lidar

        settings, description = self._settings, setup.description
        return CameraSensing(
            Lidar(
                self.world,
                setup.name,
                description.torso,
                settings.lidar,
                settings.seed,
            ),
            LidarPerception(description, settings.lidar.far),
        )

    def _remote_robot(
        self,
        name: str,
        sight: IdealLineOfSight | None,
        eyes: "SensorSuite | None",
        *,
        balances: bool,
    ) -> Player:
        """Place a robot that another process controls."""
        settings, setup = self._settings, self._setups[name]
        truth = self._robot_truths[name]
        clearance = None
        if settings.map.source == "given":  # it builds no map of its own
            clearance = clearance_in(settings.room.plan, settings.map, setup)
        if balances:
            from .velocity_walker import place_velocity_walker

            return place_velocity_walker(
                self.world,
                setup,
                truth=truth,
                sight=sight,
                eyes=eyes,
                clearance=clearance,
            )
        description, gait = setup.description, setup.gait
        kinematics = LegKinematics(description, tick=self.world.physics.tick)
        half = 0.5 * gait.foot_spacing
        left, right = Pose(0.0, half, 0.0), Pose(0.0, -half, 0.0)
        kinematics.stand(standing_reference(left, right, gait))
        robot = place_robot(
            self.world,
            setup,
            kinematics,
            sight=sight,
            eyes=eyes,
            truth=truth,
            clearance=clearance,
        )
        head: tuple[int, ...] = ()
        if eyes is not None:
            joints = load_head(description)
            names = kinematics.joint_names
            head = names.index(joints.yaw), names.index(joints.pitch)
        return ServedPlayer(robot, head)

    def sight_observer(self, *, every: int) -> "SightObserver | None":
        """Return the evaluation of perception, if sensing is by cameras."""
        if self._senses is None:
            return None
        from .camera_duel import SightObserver

        evaluators = {}
        for own, other in (self.players, self.players[::-1]):
            if isinstance(own, RobotPlayer):
                evaluators[own.name] = self._senses.evaluator_of(
                    own.robot,
                    self._truths[other.name],
                    wears_trim=not isinstance(other, FloorPlayer),
                )
        return SightObserver(evaluators, self._senses.renderer, every=every)


def _physics_of(
    settings: DuelSettings,
    setups: Mapping[str, WalkerSetup],
    networks: NetworkPool,
) -> PhysicsSettings:
    """Return the physics of a duel, at the control period of its robots."""
    legs = {name: settings.robot_of(name).legs for name in setups}
    if not any(each.walks for each in legs.values()):
        return with_control_period(settings.physics, settings.body)
    if settings.sensing == "cameras" or not all(
        each.walks for each in legs.values()
    ):
        return settings.physics  # heads move between decisions of the policy
    from .policy_player import policy_physics

    walkers = [(legs[name], own.description) for name, own in setups.items()]
    return policy_physics(settings.physics, settings.body, walkers, networks)


def _setup_of(settings: DuelSettings, name: str, frame: Pose) -> WalkerSetup:
    own, body = settings.robot_of(name), settings.body
    if any(settings.robot_of(each).legs.walks for each in settings.robots):
        body = at_tick(body, settings.physics.tick)
    return WalkerSetup(
        name,
        load_robot(own.robot),
        own.gait,
        own.control,
        body,
        odometry_in_world=frame,
        seed=settings.seed,
    )


def _camera_senses(
    settings: DuelSettings,
    setups: dict[str, WalkerSetup],
    directions: dict[str, Direction],
    tick: float,
) -> "CameraSenses | None":
    """Return the camera sensing of a duel; None with ideal sight."""
    if settings.sensing != "cameras":
        return None
    from .camera_duel import CameraSenses

    descriptions = [setup.description for setup in setups.values()]
    if len({d.folder for d in descriptions}) > 1:
        raise ConfigurationError(
            "sensing must be ideal for different robots, got 'cameras' for "
            f"{', '.join(d.name for d in descriptions)}"
        )
    return CameraSenses(settings, descriptions[0], directions, tick=tick)
