"""Missions from anywhere to anywhere, all algorithms in the same traffic."""

from __future__ import annotations

import tempfile
from collections import Counter
from collections.abc import Iterator, Sequence
from itertools import product
from pathlib import Path
from statistics import mean, median
from typing import Any, NamedTuple

from tmpud.experiments.running.progress import Progress
from tools.verification.figures import Figure, none_in
from tools.verification.options import Options, map_name
from tools.verification.trials import TRIED, Trial, drive, each

FIRST_SEED = 1000
ALGORITHMS = {"tmpud": (), "no-com": (), "threshold(0.3)": ("--beta", "0.3")}
ALLOWED = 0.05  # share of trials that may be blocked, out of time or a fault of the tool
DRIVING = "SUCCESS", "COLLISION"  # every other status counts against ALLOWED


class Work(NamedTuple):
    map: str
    algorithm: str
    seed: int


def missions(options: Options) -> list[Figure]:
    """Drive random missions on each map, each algorithm the same ones."""
    seeds = range(FIRST_SEED, FIRST_SEED + options.missions)
    work = [Work(*row) for row in product(options.mission_maps, ALGORITHMS, seeds)]
    work.sort(key=lambda item: item.seed)
    done: dict[Work, Trial] = {}
    progress = Progress("missions", len(work))
    with tempfile.TemporaryDirectory() as folder:

        def run(item: Work) -> Trial:
            place = Path(folder) / f"{map_name(item.map).lower()}-{item.algorithm.partition('(')[0]}-{item.seed}"
            return drive(place, _arguments(item, options.traffic))

        for item, trial in each(run, work):
            done[item] = trial
            progress.step(note=f"{map_name(item.map)} {item.algorithm} {item.seed}: {trial.status}")
    return [figure for map_ in options.mission_maps for figure in _figures(map_, done, options)]


def _arguments(item: Work, traffic: int) -> list[str]:
    algorithm = item.algorithm.partition("(")[0]
    places = ["--map", item.map, "--from", "random", "--to", "random", "--seed", str(item.seed)]
    return [*places, "--algorithm", algorithm, *ALGORITHMS[item.algorithm], f"--traffic={traffic}", "--no-frames"]


def _figures(map_: str, done: dict[Work, Trial], options: Options) -> list[Figure]:
    arrived = [
        seed
        for seed in sorted({item.seed for item in done if item.map == map_})
        if all(done[Work(map_, name, seed)].status == "SUCCESS" for name in ALGORITHMS)
    ]
    figures = []
    for name in ALGORITHMS:
        trials = {item.seed: done[item] for item in sorted(done) if item.map == map_ and item.algorithm == name}
        details = _details(trials, arrived)
        faults = sum(n for status, n in details["statuses"].items() if status not in DRIVING)
        unforced = sum(details["violations"]["no merge was forced"].values())
        tracebacks = details["statuses"].get("TRACEBACK", 0)
        n = len(trials)
        figures.append(
            Figure(
                what=f"missions on {map_name(map_)}, {options.traffic} vehicles, {name}",
                n=n,
                result=_words(details, n),
                target=f"not driven to an end: under {ALLOWED:.0%}; 0 rules broken where no merge was forced; "
                "0 tracebacks",
                holds=faults < ALLOWED * n and not unforced and not tracebacks,
                seed=FIRST_SEED,
                details=details,
            )
        )
    return figures


def _details(trials: dict[int, Trial], arrived: Sequence[int]) -> dict[str, Any]:
    broken: dict[str, Counter[str]] = {"no merge was forced": Counter(), "a merge was forced": Counter()}
    for trial in trials.values():
        broken["a merge was forced" if trial.forced_merges else "no merge was forced"].update(trial.violations)
    ran = [trial.summary for trial in trials.values() if trial.status not in TRIED]
    distances = [float(trials[seed].summary["distance_m"]) for seed in arrived]
    return {
        "statuses": dict(sorted(Counter(trial.status for trial in trials.values()).items())),
        "collisions": sum(summary["collisions"] for summary in ran),
        "collisions_by_class": dict(sorted(Counter(_collisions(ran)).items())),
        "forced_stops": sum(summary["forced_stops"] for summary in ran),
        "violations": {where: dict(sorted(kinds.items())) for where, kinds in broken.items()},
        "rules_broken": {seed: trial.violations for seed, trial in trials.items() if trial.violations},
        "trials_with_forced_merge": sum(trial.forced_merges > 0 for trial in trials.values()),
        "replans": sum(summary["replans"] for summary in ran),
        "all_arrived": list(arrived),
        "mean_distance_m": round(mean(distances), 1) if distances else None,
        "latency_ms": {kind: _latency(ran, kind) for kind in ("plan", "estimate")},
        "not_successful": {
            seed: trial.status + (f": {trial.message}" if trial.message else "")
            for seed, trial in trials.items()
            if trial.status != "SUCCESS"
        },
    }


def _collisions(ran: Sequence[Any]) -> Iterator[str]:
    """Yield the class of each collision and who is to blame."""
    for summary in ran:
        yield from (f"{v['rule']}, blame {v['blame']}" for v in summary["judged"] if v["kind"] == "collision")


def _latency(ran: Sequence[Any], kind: str) -> dict[str, float] | None:
    """Return the median of the trials' medians and the greatest of all [ms]."""
    rows = [summary["latency_ms"][kind] for summary in ran if kind in summary["latency_ms"]]
    if not rows:
        return None
    return {"median": round(median(row["median"] for row in rows), 2), "max": max(row["max"] for row in rows)}


def _words(details: dict[str, Any], n: int) -> str:
    words = [", ".join(f"{count} {status}" for status, count in details["statuses"].items())]
    words.append(f"{details['collisions']} collisions" + _in_brackets(_counts(details["collisions_by_class"])))
    words.append(f"{details['forced_stops']} forced stops")
    forced = details["trials_with_forced_merge"]
    for (where, kinds), trials in zip(details["violations"].items(), (n - forced, forced), strict=True):
        words.append(f"rules broken where {where}: {_counts(kinds) or none_in(trials)}")
    words.append(f"{details['replans']} replans")
    if details["mean_distance_m"] is not None:
        words.append(f"{details['mean_distance_m']} m over {len(details['all_arrived'])} trials in which all arrived")
    for kind, ms in details["latency_ms"].items():
        if ms is not None:
            words.append(f"{kind} {ms['median']:g} ms median, {ms['max']:g} ms max")
    if details["rules_broken"]:
        words.append("rules broken: " + ", ".join(map(str, details["rules_broken"])))
    if details["not_successful"]:
        words.append("not successful: " + ", ".join(map(str, details["not_successful"])))
    return "; ".join(words)


def _in_brackets(text: str) -> str:
    return f" ({text})" if text else ""


def _counts(kinds: dict[str, int]) -> str:
    return ", ".join(f"{n} {kind}" for kind, n in kinds.items())
