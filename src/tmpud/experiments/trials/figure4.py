"""The paper's abstract-simulation figure: five algorithms under four road conditions, 80,000 trials."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import asdict, dataclass
from itertools import product
from typing import Any

from tmpud.errors import RequestError
from tmpud.experiments.running.tasks import DONE, Record, Task, digest
from tmpud.experiments.statistics.paper_numbers import ALGORITHMS, FIGURE4
from tmpud.experiments.statistics.rows import TrialRow
from tmpud.experiments.worlds.models import SHIPPED, read_world
from tmpud.roads.places import RANDOM
from tmpud.roads.towns import PAPER_MISSIONS

CHUNK = 250  # trials of a task
PER_TRIAL = ("status", "distance", "collisions", "stops")  # of a task's result


@dataclass(frozen=True, slots=True, kw_only=True)
class Figure4:
    """How much of the figure is driven, and where."""

    trials: int = 4000  # per algorithm and road condition
    batches: int = 4
    map: str = "millbrook"
    missions: str = "paper"  # or "random:N": trials take turns among N of them
    preset: str = "tmpud"
    seed: int = 1000
    world: str = SHIPPED  # or a file that learn-world wrote

    def to_json(self) -> dict[str, Any]:
        return asdict(self)

    @classmethod
    def from_json(cls, row: Mapping[str, Any]) -> Figure4:
        """Return the figure that ``to_json`` described."""
        return cls(**row)

    def tasks(self) -> list[Task]:
        """Return all tasks; RequestError for what cannot be run."""
        if self.trials % self.batches:
            raise RequestError(f"{self.trials} trials cannot be split into {self.batches} batches")
        shared = {
            "map": self.map,
            "routes": self._routes(),
            "seed": self.seed,
            "preset": self.preset,
            "world": self.world,
            "learnt": digest(read_world(self.world)["conditions"]),
        }
        return [self._task(shared, *which) for which in product(FIGURE4, ALGORITHMS, self._chunks())]

    def rows(self, records: Iterable[Record]) -> list[TrialRow]:
        """Return one row for each trial whose task gave a result, and one with the fault for each other."""
        by_key = {record.key: record for record in records}
        return [row for task in self.tasks() if task.key in by_key for row in self._rows(task, by_key[task.key])]

    def _routes(self) -> list[tuple[str, str]]:
        if self.missions == "paper" and self.map in PAPER_MISSIONS:
            mission = PAPER_MISSIONS[self.map]
            return [(mission.start, mission.goal)]
        kind, _, count = self.missions.partition(":")
        if kind == RANDOM and count.isdigit() and int(count):
            return [(RANDOM, RANDOM)] * int(count)
        raise RequestError(f"missions are 'paper' or 'random:N', and {self.map} has no {self.missions!r}")

    def _chunks(self) -> Iterator[range]:
        size = self.trials // self.batches
        for batch in range(self.batches):
            for first in range(batch * size, (batch + 1) * size, CHUNK):
                yield range(first, min(first + CHUNK, (batch + 1) * size))

    def _task(self, shared: dict[str, Any], condition: str, algorithm: str, trials: range) -> Task:
        name, _, beta = algorithm.rstrip(")").partition("(")
        return Task(
            key=f"{condition}/{algorithm}/{trials.start:05}",
            work="abstract",
            shared=shared,
            arguments={
                "condition": condition,
                "algorithm": name,
                "beta": float(beta or 0.0),
                "draws": f"{self.seed}/{condition}",
                "first": trials.start,
                "count": len(trials),
            },
        )

    def _rows(self, task: Task, record: Record) -> Iterator[TrialRow]:
        condition, algorithm, _ = task.key.split("/")
        first, count = task.arguments["first"], task.arguments["count"]
        told = {name: record.result[name] for name in PER_TRIAL if name in record.result}
        for i in range(count):
            result = {name: values[i] for name, values in told.items()}
            collisions, stops = result.get("collisions", 0), result.get("stops", 0)
            yield TrialRow(
                condition=condition,
                algorithm=algorithm,
                trial=first + i,
                batch=(first + i) // (self.trials // self.batches),
                status=result["status"] if record.status == DONE else record.status,
                distance=result.get("distance", 0.0),
                unsafe=bool(collisions or stops),
                details={"collisions": {"merge": collisions}, "forced_stops": 0 if collisions else stops},
            )


DEVIATIONS = (
    "The world models were learned by tmpud learn-world in SUMO; the paper's, learned in CARLA, are not published.",
    "The models keep the joint sample of Safe and outcome of each forced merge; the paper names probabilities only.",
    "A merge draws one pair by trial, place and visit, the same for all algorithms; only merges carry a risk.",
)


def deviations(records: Iterable[Record]) -> tuple[str, ...]:
    """Return where the abstract simulation departs from the paper, and why."""
    plans = [record.result["plans"] for record in records if record.status == DONE]
    made, proved, wrong = (sum(row[name] for row in plans) for name in ("made", "proved", "mismatches"))
    solver = (
        f"Plans come from A* in the planner's own order of plans. Of {made:,} (a plan counts once in each task) clingo "
        f"was asked for {proved:,} as well, and found {wrong} others. python -m benchmarks abstract: the rates of both."
    )
    return *DEVIATIONS, solver
