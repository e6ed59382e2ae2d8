"""Safe and efficient urban driving by task-motion planning (TMPUD, IROS 2020).

What most programs need, each imported when it is first used, so that ``import tmpud`` itself costs nothing:

- drive a mission: ``Mission``, ``drive``, and the events it yields, ``Event`` and its kinds; ``summarise`` them,
  ``record`` them into a run folder, ``read_run`` them back
- plan alone, without a simulator: ``Problem``, ``load_map``, ``AspPlanner``, ``PlanReport``; rules of a user's own for
  plans: ``read_rules``; what plans are made of: ``Action``, ``State``, ``Transition``, ``TaskPlan``
- the method's open points: ``Preset``, ``TMPUD``, ``PAPER``, ``RELEASED``
- the parts of the motion level: ``StateMapping`` (f), ``LaneMotionPlanner`` (P^m), ``SafeSetEstimator`` (Algorithm 1)
  with its ``SafetyEstimate``
- what a simulator reports: ``Scene``, ``VehicleState``, ``Vehicles``, ``Control``; who judges it: ``Judge``
- what an experiment's folder says: ``read_findings``
- ``TmpudError``, the root of all errors

The protocols that a part of your own must have are in ``tmpud.protocols``; Algorithm 2 is ``tmpud.execution.tmpud``.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from tmpud.errors import TmpudError
    from tmpud.events import Estimated, Event, Executed, Finished, Frame, Header, Judged, Planned, Refused
    from tmpud.experiments.kinds import read_findings
    from tmpud.judging.judge import Judge
    from tmpud.motion.mapping import StateMapping
    from tmpud.motion.planner import LaneMotionPlanner
    from tmpud.planning import Problem
    from tmpud.presets import PAPER, RELEASED, TMPUD, Preset
    from tmpud.recording import read_run, record
    from tmpud.roads.loading import load_map
    from tmpud.runner import Mission, drive
    from tmpud.safety.estimator import SafeSetEstimator, SafetyEstimate
    from tmpud.scene import Control, Scene, Vehicles, VehicleState
    from tmpud.story import summarise
    from tmpud.symbols import Action, State, TaskPlan, Transition
    from tmpud.task.asp_planner import AspPlanner, PlanReport
    from tmpud.task.rules import read_rules

__version__ = "0.1.0"

_HOME = {
    "errors": ("TmpudError",),
    "events": ("Estimated", "Event", "Executed", "Finished", "Frame", "Header", "Judged", "Planned", "Refused"),
    "experiments.kinds": ("read_findings",),
    "judging.judge": ("Judge",),
    "motion.mapping": ("StateMapping",),
    "motion.planner": ("LaneMotionPlanner",),
    "planning": ("Problem",),
    "presets": ("PAPER", "RELEASED", "TMPUD", "Preset"),
    "recording": ("read_run", "record"),
    "roads.loading": ("load_map",),
    "runner": ("Mission", "drive"),
    "safety.estimator": ("SafeSetEstimator", "SafetyEstimate"),
    "scene": ("Control", "Scene", "VehicleState", "Vehicles"),
    "story": ("summarise",),
    "symbols": ("Action", "State", "TaskPlan", "Transition"),
    "task.asp_planner": ("AspPlanner", "PlanReport"),
    "task.rules": ("read_rules",),
}
_MODULE = {name: f"tmpud.{module}" for module, names in _HOME.items() for name in names}

__all__ = [
    "PAPER",
    "RELEASED",
    "TMPUD",
    "Action",
    "AspPlanner",
    "Control",
    "Estimated",
    "Event",
    "Executed",
    "Finished",
    "Frame",
    "Header",
    "Judge",
    "Judged",
    "LaneMotionPlanner",
    "Mission",
    "PlanReport",
    "Planned",
    "Preset",
    "Problem",
    "Refused",
    "SafeSetEstimator",
    "SafetyEstimate",
    "Scene",
    "State",
    "StateMapping",
    "TaskPlan",
    "TmpudError",
    "Transition",
    "VehicleState",
    "Vehicles",
    "drive",
    "load_map",
    "read_findings",
    "read_rules",
    "read_run",
    "record",
    "summarise",
]


def __getattr__(name: str) -> Any:
    if name not in _MODULE:
        raise AttributeError(f"module 'tmpud' has no attribute {name!r}")
    value = globals()[name] = getattr(import_module(_MODULE[name]), name)
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *_MODULE})
