"""One trial on a CARLA server."""

from __future__ import annotations

from tmpud.errors import SimulatorError, SimulatorHangError
from tmpud.experiments.running.tasks import SIM_CRASH, SIM_HANG, Json
from tmpud.experiments.trials.full import summary
from tmpud.runner import Mission, carla, drive
from tmpud.simulators.carla.session import Address

FAULTS = {SIM_CRASH: SimulatorError, SIM_HANG: SimulatorHangError}


class CarlaTrials:
    """Trials one after another, each in a town that the server loads anew: nothing of one is there in the next."""

    isolated = False  # the client has a process of its own

    def prepare(self, shared: Json) -> Json:
        return shared

    def run(self, prepared: Json, arguments: Json) -> Json:
        """Drive one trial with the algorithm and preset of the arguments."""
        words = {**prepared, **arguments, "via": tuple(prepared.get("via", ()))}
        server = Address.named(words.pop("server"))
        result = summary(drive(Mission(**words), simulator=carla(server), frames=False, alternatives=0))
        if result["status"] in FAULTS:
            raise FAULTS[result["status"]](result["message"])
        return result
