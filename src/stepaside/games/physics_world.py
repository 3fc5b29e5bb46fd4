"""World of a game in physics, with its players."""

from collections.abc import Collection, Mapping
from dataclasses import replace
from functools import partial
from math import inf
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple

import mujoco

from ..control.scheme import ControlScheme, build_walk
from ..control.sight_sources import (
    MeasuredSight,
    SightOfPlayers,
    SightSource,
)
from ..core.errors import ConfigurationError
from ..core.poses import Pose
from ..core.random_streams import named_generator
from ..locomotion.maneuver_walk import ManeuverWalk
from ..perception.measurement import Sighting
from ..robots.description import RobotDescription, load_robot
from ..robots.leg_kinematics import LegKinematics
from ..sim.body_settings import BodySettings, at_tick
from ..sim.ground_truth import (
    GroundTruth,
    IdealLineOfSight,
    TrueRobotState,
    torsos_apart,
)
from ..sim.physics_settings import PhysicsSettings
from ..sim.push import pushes_by_robot
from ..sim.simulated_robot import SimulatedRobot
from ..sim.world import World
from ..strategies.knowledge import Knowledge
from ..strategies.strategy import BodyStrategy, Strategy
from .floor_games import ORIGIN, motion_of, strategy_of, with_body_radius
from .game import Outcome
from .game_furnishing import colours_of_players, furnish_game
from .game_settings import GameSettings
from .player_settings import PlayerSettings
from .players import Player, RobotPlayer

if TYPE_CHECKING:
    from ..locomotion.guard import ClearanceSetup
    from ..locomotion.policy.policy_legs import (
        InitialPosture,
        PolicyLegs,
        PolicyWalk,
    )
    from ..sim.ranging import Lidar
    from ..sim.sensor_suite import SensorSuite
    from .camera_senses import CameraSenses, SightEvaluator


class RobotSetup(NamedTuple):
    """Robot of a game, before it stands in the world."""

    own: PlayerSettings  # with the pose of its odometry, by default the origin
    description: RobotDescription
    body: BodySettings = BodySettings()
    seed: int = 0  # of sensor errors
    truth: TrueRobotState | None = None  # its true state, if that exists
    source: SightSource | None = None  # of sightings for its controller
    sights: tuple[IdealLineOfSight, ...] = ()  # of each other player
    eyes: "SensorSuite | Lidar | None" = None
    # Knowledge of the room; who knows the room also knows its pose in it.
    clearance: "ClearanceSetup | None" = None
    tracks: bool = False  # whether control tracks the body by its IMU

    @property
    def start(self) -> Pose:
        """Pose of its odometry in the world."""
        return self.own.pose or ORIGIN

    def true_state_in(self, world: World) -> TrueRobotState:
        """Return the true state of the robot in a world that contains it."""
        return TrueRobotState(
            world.model,
            world.data,
            f"{self.own.name}/{self.description.torso}",
            com_forward=self.own.gait.zmp_forward,
            place=self.description.place,
        )

    def place(
        self, world: World, standing: "LegKinematics | PolicyLegs"
    ) -> SimulatedRobot:
        """Place it in the posture of kinematics, or on learned legs.

        Learned legs drive it by the torques of their policy.
        """
        gains = None
        posture: LegKinematics | InitialPosture
        if isinstance(standing, LegKinematics):
            posture = standing
        else:
            contract, posture = standing.contract, standing.standing
            pairs = zip(contract.stiffness, contract.damping, strict=True)
            gains = dict(zip(contract.joints, pairs, strict=True))
        known, own = self.clearance, self.own
        return SimulatedRobot(
            world,
            own.name,
            self.description,
            posture,
            self.start,
            self.body,
            generator=named_generator(self.seed, f"sensors/{own.name}"),
            integrates_imu=bool(gains or own.control.feedback or self.tracks),
            sights=self.sights,
            eyes=self.eyes,
            truth=self.truth or self.true_state_in(world),
            knows_pose=known is not None and known.surroundings.needs_pose,
            gains=gains,
        )


def place_robot(
    world: World, setup: RobotSetup, strategy: Strategy | None
) -> RobotPlayer:
    """Place a robot in a world that contains it, with its controller.

    Without a strategy it walks at velocities of another process.
    """
    own, known, tick = setup.own, setup.clearance, world.physics.tick
    source = setup.source or MeasuredSight()
    walk: ManeuverWalk | PolicyWalk
    if own.legs.network:
        from ..locomotion.policy import policy_legs as learned

        legs = learned.load_legs(own.legs, setup.description, tick=tick)
        guard = known and known.velocity_guard(legs.velocities)
        walk = learned.PolicyWalk(legs, own.gait, guard)
        robot = setup.place(world, legs)
    else:
        walk = build_walk(
            *(setup.description, own.gait, own.control),
            tick=tick,
            delay=setup.body.delay_cycles * tick,
            clearance=known,
            forward=source.forward,
        )
        tracks = isinstance(strategy, BodyStrategy)
        robot = setup._replace(tracks=tracks).place(world, walk.kinematics)
    if strategy is None:
        from .velocity_walker import VelocityWalker

        return VelocityWalker(robot, walk, setup.start, setup.description)
    if known is not None:
        strategy = with_body_radius(strategy, known.radius(own.gait))
    scheme = ControlScheme(
        strategy, walk, source, known and known.surroundings
    )
    return RobotPlayer(robot, scheme, setup.start)


class PhysicsWorld(World):
    """World of a game in physics; see :class:`~.game.PlayedWorld`.

    Attributes:
        players: The players, in the order of the settings.
        renderer: Of colour images; empty without cameras.
        strategies: Of the robots that decide, by name.
        started_at: Time at which the game began, in [s]: all players were
            ready, for example had scanned the room; None before.
        first_moves: Time at which a player first moved in the game, in [s],
            by name. Motion before ``started_at`` does not count.
    """

    contact = Outcome.CONTACT

    def __init__(
        self,
        settings: GameSettings,
        *,
        rendered: bool = False,
        remote: Mapping[str, bool] = MappingProxyType({}),
        strategies: Mapping[str, Strategy] = MappingProxyType({}),
        descriptions: Mapping[str, RobotDescription] = MappingProxyType({}),
    ) -> None:
        """Build the world and place the players in it.

        The settings have all initial poses; strategies, and descriptions of
        robots, replace theirs, by name. Cameras render the world anyway. Of
        each robot that other processes command by velocities, ``remote`` says
        by name whether the true line of sight is measured.
        """
        self._settings, self._remote = settings, remote
        self._setups = _setups_of(settings, descriptions)
        physics = _physics_of(settings, self._setups)
        self.strategies = {
            own.name: strategy_of(
                *(settings, own, strategies.get(own.name)),
                # The frame in which a robot knows places.
                ORIGIN if settings.knows_room else own.pose or ORIGIN,
            )
            for own in settings.players
            if own.body == "robot" and own.name not in remote
        }
        self._senses = senses = self._camera_senses(physics.tick)
        self.renderer = "" if senses is None else senses.renderer
        super().__init__(
            {name: own.description for name, own in self._setups.items()},
            physics,
            settings.body,
            settings.seed,
            partial(furnish_game, settings=settings),
            rendered=rendered or self._senses is not None,
            colours=colours_of_players(settings),
        )
        if settings.room is not None and settings.room.moving:
            from ..sim.room_furnishing import obstacle_mover

            move = obstacle_mover(self.model, self.data, settings.room)
            move(0.0)
            self.before_step.append(move)
        # An ideal sensor needs the true states of all other players.
        self._truths: dict[str, GroundTruth] = {
            name: setup.true_state_in(self)
            for name, setup in self._setups.items()
        }
        moved = {}
        for own in settings.players:
            if own.body != "robot":
                from .people import FloorPlayer

                given = strategies.get(own.name)
                motion = motion_of(settings, own, self.physics.tick, given)
                player = FloorPlayer(self, own, motion, self.states)
                moved[own.name] = player
                self._truths[own.name] = player.truth
        self.players: tuple[Player, ...] = tuple(
            moved.get(own.name) or self._robot(own) for own in settings.players
        )
        self._walkers = [p for p in self.players if isinstance(p, RobotPlayer)]
        seen = [robot.perception for robot in self._walkers]
        self._heads = [each.head for each in seen if each is not None]
        mujoco.mj_forward(self.model, self.data)
        if settings.pushes:
            pushes = pushes_by_robot(settings.pushes, settings.robots)
            for robot in self._walkers:
                if pushes[robot.name]:
                    robot.robot.push(*pushes[robot.name])
        self.acting = ""
        self.started_at: float | None = None
        self.first_moves: dict[str, float] = {}
        self._resting = [*self.players]

    def player(self, name: str) -> Player:
        """Return the player with a name."""
        return {player.name: player for player in self.players}[name]

    def states(self) -> dict[str, Pose]:
        """Return reference point and heading of each player, by name."""
        return {own.name: own.place_in_world for own in self.players}

    def is_moving(self, name: str) -> bool:
        """Return whether a player walks."""
        return self.player(name).is_moving

    def due(
        self, names: Collection[str], *, ended: bool
    ) -> dict[str, Knowledge]:
        """Return what players know for decisions that are due, by name.

        Other people before them move first, as they do when all act.
        """
        found, left = {}, {*names}
        for player in self.players:
            if player.name in left:
                left.remove(player.name)
                found[player.name] = player.look()
            elif left and not isinstance(player, RobotPlayer):
                player.tick()
        return {n: known for n, known in found.items() if known is not None}

    def apart(self, one: str, other: str) -> float:
        """Return the distance between two torsos, in [m]."""
        return torsos_apart(self._truths[one], self._truths[other])

    def decide(self) -> None:
        """Let all players act at one control tick."""
        heads = self._heads
        if self.started_at is None and all(h.is_ready for h in heads):
            self.started_at = self.time
            for head in heads:
                head.start()
        for player in self.players:
            self.acting = player.name
            player.tick()

    def step(self, limit: float = inf) -> None:
        """Advance by one control tick."""
        super().step()
        if self.started_at is None:
            return
        for player in self._resting[:]:
            if player.is_moving:
                self._resting.remove(player)
                self.first_moves[player.name] = self.time

    def fallen(self) -> tuple[str, ...]:
        """Return the names of the players that have fallen."""
        return tuple(p.name for p in self._walkers if p.has_fallen)

    def touching(self) -> tuple[str, ...]:
        """Return the names of bodies in contact, after the first step."""
        touches = self.ticks and self.robots_touch()
        return super().touching() if touches else ()

    def close(self) -> None:
        """Close the cameras."""
        for player in self._walkers:
            player.robot.close()

    def _camera_senses(self, tick: float) -> "CameraSenses | None":
        """Return the camera sensing of the robots; None without cameras."""
        seeing = self._settings.sensing_by("cameras")
        if not seeing:
            return None
        from .camera_senses import CameraSenses

        return CameraSenses(
            self._settings,
            self._setups[seeing[0].name].description,
            self.strategies,
            tick=tick,
        )

    def _robot(self, own: PlayerSettings) -> RobotPlayer:
        """Place a robot in the world, with sensors and controller."""
        truth = self._truths[own.name]
        assert isinstance(truth, TrueRobotState)
        setup = self._setups[own.name]._replace(truth=truth)
        served = own.name in self._remote
        if served and own.senses == "lidar":
            raise ConfigurationError(
                "sensing must be ideal or cameras for a robot that another "
                "process controls, got 'lidar'"
            )
        # A served robot builds no map of its own.
        if not served or self._settings.map.source == "given":
            setup = self._with_room(setup)
        if not served or own.senses == "cameras" or self._remote[own.name]:
            setup = self._with_senses(setup)
        return place_robot(self, setup, self.strategies.get(own.name))

    def _with_room(self, setup: RobotSetup) -> RobotSetup:
        """Return the setup of a robot with its knowledge of the room."""
        room, known = self._settings.room, self._settings.map
        if room is None or known.source == "none":
            return setup
        from ..sim.outline_measurement import clearance_in

        seen = self._senses.perceptions if self._senses else {}
        eyes = seen.get(setup.own.name)
        clearance = clearance_in(
            *(room, known, setup.start, setup.description, setup.own.gait),
            None if eyes is None else eyes.floor,
        )
        return setup._replace(clearance=clearance)

    def _with_senses(self, setup: RobotSetup) -> RobotSetup:
        """Return the setup of a robot with its senses."""
        settings, tick, own = self._settings, self.physics.tick, setup.own
        source: SightSource = MeasuredSight()
        if own.senses == "cameras":
            from ..control.sensor_sight import CameraSight

            assert self._senses is not None
            seen = self._senses.perceptions.get(own.name)
            if seen is not None:
                source = CameraSight(seen, tick=tick)
            eyes = self._senses.eyes_of(self, own.name)
            return setup._replace(source=source, eyes=eyes)
        if own.senses == "lidar":
            from ..control.sensor_sight import LidarSight
            from ..perception.lidar_perception import LidarPerception
            from ..sim.ranging import Lidar

            torso, lidar = setup.description.torso, settings.lidar
            perception = LidarPerception(setup.description, lidar.far)
            return setup._replace(
                source=LidarSight(perception, tick=tick),
                eyes=Lidar(self, own.name, torso, lidar, settings.seed),
            )
        if len(settings.players) == 1:
            source = MeasuredSight(Sighting(0.0, 0.0, inf))
            return setup._replace(source=source)
        truths = self._truths
        sights = tuple(
            IdealLineOfSight(
                truths[own.name],
                truths[other.name],
                own.sight,
                named_generator(
                    settings.seed, f"sight/{own.name}/{other.name}"
                ),
                identity=other.identity,
                between=[
                    truth
                    for name, truth in truths.items()
                    if name not in (own.name, other.name)
                ],
            )
            for other in settings.players
            if other.name != own.name
        )
        source = SightOfPlayers(own.identity, own.target)
        return setup._replace(source=source, sights=sights)

    def sights(self, every: int) -> "dict[str, SightEvaluator]":
        """Return the evaluation of the sightings of robots with cameras.

        They are sampled after a number of control ticks.
        """
        if self._senses is None:
            return {}
        robots = [own.robot for own in self._walkers]
        return self._senses.evaluators(robots, self._truths, every)


def _setups_of(
    settings: GameSettings, descriptions: Mapping[str, RobotDescription]
) -> dict[str, RobotSetup]:
    """Return the robots of a game before they stand in the world."""
    robots = [p for p in settings.players if p.body == "robot"]
    body = settings.body
    if any(own.legs.network for own in robots):
        body = at_tick(body, settings.physics.tick)
    return {
        own.name: RobotSetup(
            own,
            descriptions.get(own.name) or load_robot(own.robot),
            body,
            settings.seed,
        )
        for own in robots
    }


def _physics_of(
    settings: GameSettings, setups: Mapping[str, RobotSetup]
) -> PhysicsSettings:
    """Return the physics of a game, at the control period of its robots."""
    walking = [bool(setup.own.legs.network) for setup in setups.values()]
    if not any(walking):
        cycle = settings.body.cycle
        return replace(settings.physics, tick=cycle or settings.physics.tick)
    if settings.sensing_by("cameras") or not all(walking):
        return settings.physics  # heads move between decisions of the policy
    from .policy_physics import policy_physics

    legs = [(each.own.legs, each.description) for each in setups.values()]
    return policy_physics(settings.physics, settings.body, legs)
