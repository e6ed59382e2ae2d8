"""What each remote call does. The first argument of each is the client's ``[asynchronous]``, left out here."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from tests.carla_loopback import blueprints, wire
from tests.carla_loopback.bodies import MAX_STEER, Body, place
from tests.carla_loopback.town import Town

SPAWN, DESTROY, CONTROL, TRANSFORM = 0, 1, 2, 6  # commands of a batch
WEATHER = [0.0] * 14
Answer = Callable[..., Any]


class Calls:
    """The calls by their names, on one town."""

    def __init__(self, town: Town, stream_port: int, tick: Callable[[], None]) -> None:
        self._town, self._port, self._tick = town, stream_port, tick
        self.traffic_managers: dict[int, tuple[str, int]] = {}  # by their ports

    def answer(self, name: str, arguments: list[Any]) -> Any:
        """Return the reply; an unknown call or actor is an error that names it."""
        call: Answer | None = getattr(self, f"on_{name}", None)
        try:
            return call(*arguments) if call else wire.error(f"the loopback server does not know {name}")
        except KeyError as unknown:
            return wire.error(f"{name}: no actor {unknown}")

    # Connecting ------------------------------------------------------------------------------------------------

    def on_version(self) -> Any:
        return wire.value(self._town.faults.version or wire.VERSION)

    def on_get_episode_info(self) -> Any:
        return wire.value([self._town.episode, [wire.token(wire.WORLD_STREAM, self._port)]])

    def on_get_sensor_token(self, stream: int) -> Any:
        return wire.value([wire.token(stream, self._port)])

    def on_get_episode_settings(self) -> Any:
        return wire.value(self._town.settings)

    def on_set_episode_settings(self, settings: list[Any]) -> Any:
        self._town.settings = settings
        self._town.settings_seen.append(settings)
        return wire.value(self._town.frame)

    def on_get_required_files(self, *_: Any) -> Any:
        return wire.value([])

    def on_get_map_info(self) -> Any:
        return wire.value([self._town.map_name, self._town.spawn_points])

    def on_get_map_data(self) -> Any:
        return wire.value(self._town.xodr)

    def on_get_available_maps(self) -> Any:
        return wire.value([f"Carla/Maps/{self._town.map_name}"])

    def on_load_new_episode(self, name: str, reset_settings: bool, _layers: int) -> Any:
        if name.rsplit("/")[-1] != self._town.map_name:
            return wire.error(f"map {name} not found")
        self._town.load(reset_settings=reset_settings)
        return wire.void()

    # Actors ----------------------------------------------------------------------------------------------------

    def on_get_actor_definitions(self) -> Any:
        return wire.value(blueprints.definitions())

    def on_get_actors_by_id(self, ids: list[int]) -> Any:
        bodies = self._town.bodies
        return wire.value([wire.actor(bodies[actor], self._port) for actor in ids if actor in bodies])

    def on_get_actor_bounding_box(self, actor: int) -> Any:
        return wire.value(wire.bounding_box(self._town.bodies[actor]))

    def on_spawn_actor(self, description: list[Any], transform: list[Any]) -> Any:
        return self._spawned(self._town.spawn(description, transform))

    def on_spawn_actor_with_parent(self, description: list[Any], transform: list[Any], parent: int, *_: Any) -> Any:
        return self._spawned(self._town.spawn(description, transform, parent))

    def _spawned(self, body: Body | str) -> Any:
        return wire.error(body) if isinstance(body, str) else wire.value(wire.actor(body, self._port))

    def on_destroy_actor(self, actor: int) -> Any:
        return wire.value(self._town.destroy(actor))

    def on_get_physics_control(self, _actor: int) -> Any:
        return wire.value(wire.physics(MAX_STEER))

    def on_set_actor_simulate_physics(self, *_: Any) -> Any:
        return wire.void()

    def on_set_actor_autopilot(self, *_: Any) -> Any:
        return wire.void()

    def on_set_actor_transform(self, actor: int, transform: list[Any]) -> Any:
        place(self._town.bodies[actor], transform)
        return wire.void()

    def on_apply_control_to_vehicle(self, actor: int, control: list[Any]) -> Any:
        self._control(actor, control)
        return wire.void()

    def _control(self, actor: int, control: list[Any]) -> None:
        if actor in self._town.bodies:
            self._town.bodies[actor].control = tuple(control)

    def on_apply_batch(self, commands: list[Any], do_tick: bool) -> Any:
        replies = [self._command(index, body) for ((index, body),) in commands]
        if do_tick:
            self._tick()
        return replies

    def _command(self, index: int, body: list[Any]) -> Any:
        if index == SPAWN:
            spawned = self._town.spawn(body[0], body[1])
            return wire.error(spawned) if isinstance(spawned, str) else wire.value(spawned.id)
        actor = body[0]
        if index == DESTROY:
            return wire.value(actor) if self._town.destroy(actor) else wire.error(f"no actor {actor}")
        if index == CONTROL:
            self._control(actor, body[1])
        elif index == TRANSFORM and actor in self._town.bodies:
            place(self._town.bodies[actor], body[1])
        return wire.value(actor)

    # Ticks, lights and the Traffic Manager -----------------------------------------------------------------------

    def on_tick_cue(self) -> Any:
        self._tick()
        return wire.value(self._town.frame)

    def on_query_lights_state(self, *_: Any) -> Any:
        return wire.value([])

    def on_reset_all_traffic_lights(self) -> Any:
        return wire.void()

    def on_get_weather_parameters(self) -> Any:
        return wire.value(WEATHER)

    def on_get_vehicle_light_states(self) -> Any:
        return wire.value([[body.id, 0] for body in self._town.vehicles()])

    def on_is_traffic_manager_running(self, port: int) -> Any:
        return wire.value(port in self.traffic_managers)

    def on_get_traffic_manager_running(self, port: int) -> Any:
        return wire.value(self.traffic_managers.get(port, ("", 0)))

    def on_add_traffic_manager_running(self, where: list[Any]) -> Any:
        host, port = where
        new = port not in self.traffic_managers
        self.traffic_managers[port] = (host, port)
        return wire.value(new)

    def on_destroy_traffic_manager(self, port: int) -> Any:
        return wire.value(self.traffic_managers.pop(port, None) is not None)
