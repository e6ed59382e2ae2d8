"""The paper's Table I: its five algorithms in normal and heavy traffic, paired trial by trial."""

from __future__ import annotations

from dataclasses import dataclass

from tmpud.errors import RequestError
from tmpud.experiments.trials.grid import Grid

TRAFFIC = {"normal": 120, "heavy": 200}  # [vehicles] (Sec. V-B)
TRIALS = 200  # per algorithm and density (Sec. V-D)
FIRST_SEED = 1000  # of the reported trials; parameters were chosen on seeds from 50,000 on


@dataclass(frozen=True, slots=True, kw_only=True)
class Table1:
    """How much of the table is driven, and where."""

    map: str = "millbrook"
    missions: str = "paper"  # or "random:N": trials are spread evenly over them
    trials: int = TRIALS
    preset: str = "tmpud"
    first_seed: int = FIRST_SEED
    server: str = ""  # host:port of a CARLA server, "" where SUMO drives

    def grid(self) -> Grid:
        """Return the trials; RequestError where they cannot be spread evenly over the missions."""
        kind, _, number = self.missions.partition(":")
        count = int(number) if kind == "random" and number.isdigit() and int(number) else 1
        if self.trials % count:
            raise RequestError(f"{self.trials} trials cannot be spread evenly over {count} missions")
        return Grid(
            maps=(self.map,),
            missions=(self.missions,),
            traffic=TRAFFIC,
            presets=(self.preset,),
            seeds=tuple(range(self.first_seed, self.first_seed + self.trials // count)),
            server=self.server,
        )


DEVIATIONS = (
    "SUMO drives the traffic instead of CARLA; the ego moves by a kinematic bicycle model at 20 km/h.",
    "The town is our own, made after the paper's example figure; the paper does not publish its map's missions.",
    "The paper gives no gamma, D, alpha, control ranges or horizon: the preset does; grounds in docs/experiments.md.",
    "All five algorithms of a trial meet the same traffic, up to the moment at which they act differently.",
    "A distance counts where all compared algorithms arrived; what the paper does after a collision it does not say.",
)

CARLA_DEVIATIONS = (
    "The server's Traffic Manager drives the traffic at the preset's 20 km/h; each trial loads the map anew.",
    "The same seed gives algorithms like traffic, not the very same one: CARLA promises no more.",
    *DEVIATIONS[2:3],
    *DEVIATIONS[4:],
)
