"""World of a game of any number of players, with its players."""

from ..arena import NO_OBSTACLES
from ..core.poses import Pose
from ..core.random_streams import named_generator
from ..locomotion.policy.network_pool import NetworkPool
from ..robots.description import load_robot
from ..sim.body_settings import at_tick, with_control_period
from ..sim.crowd_motion import CrowdMotion
from ..sim.ground_truth import GroundTruth
from ..sim.ideal_sensors import IdealLineOfSight
from ..sim.obstacle_geoms import obstacle_mover
from ..sim.pedestrian_appearance import FIGURES
from ..sim.person_body import PersonBody
from ..sim.person_motion import PersonMotion
from ..sim.world import World
from .floor_player import (
    CrowdSteering,
    FloorBody,
    FloorPlayer,
    MarkerBody,
    PathSteering,
    RecordedSteering,
    StrategySteering,
)
from .game_furnishing import colours_in_world, furnish_game
from .game_settings import GameSettings, PlayerSettings
from .game_strategies import strategy_of
from .player import Player
from .recorded_motion import RecordedMotion
from .template_level import agent_of, bodies_of, target_of_person
from .walker_factory import (
    PlayerSensing,
    WalkerSetup,
    clearance_in,
    place_walker,
)


class GameWorld:
    """World of a game with its players.

    Attributes:
        world: World with robots, people and obstacles.
        players: The players, in the order of the settings.
        networks: Networks of robots on learned legs.
    """

    def __init__(self, settings: GameSettings, *, rendered: bool) -> None:
        """Build the world and place the players in it.

        Args:
            settings: Settings with the initial poses filled in.
            rendered: Whether the world is rendered.

        Raises:
            StepAsideError: If the settings contradict each other or cannot
                be met by the robots.
        """
        self._settings = settings
        physics, body = settings.physics, settings.body
        robots = [p for p in settings.players if p.body == "robot"]
        if any(own.legs.walks for own in robots):
            body = at_tick(body, physics.tick)
        else:
            physics = with_control_period(physics, body)
        self._setups = {
            own.name: WalkerSetup(
                own.name,
                load_robot(own.robot),
                own.gait,
                own.control,
                body,
                odometry_in_world=_start_of(own),
                seed=settings.seed,
            )
            for own in robots
        }
        self.world = World(
            {name: own.description for name, own in self._setups.items()},
            physics,
            settings.body,
            settings.seed,
            lambda spec: furnish_game(spec, settings),
            rendered=rendered,
            colours=colours_in_world(settings),
        )
        room = settings.room
        if room is not None and room.moving:
            move = obstacle_mover(self.world.model, self.world.data, room)
            move(0.0)
            self.world.before_step.append(move)
        self.networks = NetworkPool()
        self._states = {
            name: setup.true_state_in(self.world)
            for name, setup in self._setups.items()
        }
        self._bodies = {
            own.name: self._floor_body(own)
            for own in settings.players
            if own.body != "robot"
        }
        # An ideal sensor needs the true states of all other players.
        self._truths: dict[str, GroundTruth] = {
            own.name: self._states[own.name]
            if own.name in self._states
            else self._bodies[own.name].truth
            for own in settings.players
        }
        self.players = tuple(self._player(own) for own in settings.players)

    def _floor_body(self, own: PlayerSettings) -> FloorBody:
        """Return the body of a player that moves without physics."""
        pose = _start_of(own)
        if own.body == "person":
            figure = FIGURES[own.person.figure]
            return PersonBody(self.world, own.name, pose, figure)
        return MarkerBody(self.world, own.name, pose)

    def _player(self, own: PlayerSettings) -> Player:
        """Return a player of the world."""
        if own.body == "robot":
            return self._robot(own)
        settings, body = self._settings, self._bodies[own.name]
        others = {n: t for n, t in self._truths.items() if n != own.name}
        pose, tick = _start_of(own), self.world.physics.tick
        if own.body == "unicycle":
            agent = agent_of(settings, own)
            return FloorPlayer(
                body,
                StrategySteering(
                    agent, pose, own.gait, settings.identities, others
                ),
            )
        if own.body == "run":
            motion = RecordedMotion(own.run, own.run_player)
            return FloorPlayer(body, RecordedSteering(motion, tick))
        if own.goal:
            room = settings.room
            walk = CrowdMotion(
                own.crowd,
                pose,
                (own.goal[0], own.goal[1]),
                *(() if room is None else (room.solid_set,)),
            )
            return FloorPlayer(
                body,
                CrowdSteering(walk, others, bodies_of(settings, own), tick),
            )
        target = self._truths[target_of_person(settings, own)]
        aim = target.position_torso_in_world
        room = settings.room
        path = PersonMotion(
            *(own.person, pose, aim),
            NO_OBSTACLES if room is None else room.solid_set,
        )
        return FloorPlayer(body, PathSteering(path, target, tick))

    def _robot(self, own: PlayerSettings) -> Player:
        """Place a robot in the world, with its controller."""
        settings, setup = self._settings, self._setups[own.name]
        frame = setup.odometry_in_world
        if settings.knows_room:
            frame = Pose(0.0, 0.0, 0.0)  # that of the known room
        strategy = strategy_of(own, frame)
        room, sensing = settings.room, self._sensing(own)
        truth = self._states[own.name]
        if own.legs.walks:
            from .policy_player import place_policy_player

            return place_policy_player(
                self.world,
                setup,
                own.legs,
                strategy,
                sight=sensing,
                truth=truth,
                networks=self.networks,
                clearance=clearance_in(room, settings.map, setup),
            )
        return place_walker(
            self.world,
            setup,
            strategy,
            sight=sensing,
            truth=truth,
            clearance=clearance_in(room, settings.map, setup),
        )

    def _sensing(self, own: PlayerSettings) -> PlayerSensing:
        """Return the ideal sensing of all other players by a robot."""
        settings = self._settings
        sights = []
        for other in settings.players:
            if other.name == own.name:
                continue
            between = [
                truth
                for name, truth in self._truths.items()
                if name not in (own.name, other.name)
            ]
            sights.append(
                IdealLineOfSight(
                    self._truths[own.name],
                    self._truths[other.name],
                    own.sight,
                    named_generator(
                        settings.seed, f"sight/{own.name}/{other.name}"
                    ),
                    identity=other.identity,
                    between=between,
                )
            )
        return PlayerSensing(own.identity, own.target, tuple(sights))


def _start_of(own: PlayerSettings) -> Pose:
    """Return the initial pose of a player in the world."""
    pose = own.pose
    assert pose is not None
    return pose
