"""The objective of Sec. III: Cost + gamma/(1 + e^(Safe-1)) for each transition, in whole centimetres.

Plans are ordered by centimetres, then merges, then actions. A *rank* packs the three into one integer, so that
ranks of transitions add up to the rank of a plan and compare like the triple.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

from tmpud.errors import UtilityOverflowError
from tmpud.presets import Preset
from tmpud.symbols import Action, Cost, Safe, TaskPlan, Transition

LIMIT = 2**31  # [cm] the solver's integers wrap here
FORBIDDEN = 1 << 90  # a rank above that of every plan
FIELD = 20  # [bit] room for the number of merges, and for the number of actions
TURNS = (Action.TURNLEFT, Action.TURNRIGHT)
_STRAIGHT = dict.fromkeys(Action, 0.0)
STEP = {action: (action.is_merge << FIELD) + 1 for action in Action}


class Terms(NamedTuple):
    """What a transition or a plan costs, term by term."""

    cost: float  # [m] length driven
    penalty: float  # [m] the safety term
    turns: float  # [m] added for left and right turns


class Total(NamedTuple):
    """What a plan costs."""

    terms: Terms  # of the whole plan
    centimetres: int  # the sum of what each transition costs, each rounded
    steps: tuple[Terms, ...]  # of each transition


class Utility:
    """The weights of one moment, for pruning, solving and reporting alike."""

    def __init__(self, preset: Preset, cost: Cost, safe: Safe, floor: Cost) -> None:
        """Take ``floor`` for a Cost that fell below it [m]; a transition that is not in it has no floor."""
        self._cost, self._safe, self._floor = cost, safe, floor
        self._turns = _STRAIGHT | dict.fromkeys(TURNS, preset.turn_cost)
        self._penalties = _Penalties(preset)

    def terms(self, transition: Transition) -> Terms:
        cost, floor = self._cost[transition], self._floor.get(transition, -math.inf)
        penalty, turns = self._penalties[self._safe[transition]], self._turns[transition.action]
        return Terms(floor if floor > cost else cost, penalty, turns)

    def rank(self, transition: Transition) -> int:
        """Return the rank of a transition, FORBIDDEN where it cannot be driven."""
        cost, safety, turns = self.terms(transition)
        if cost == math.inf:
            return FORBIDDEN
        return (centimetres(cost + safety + turns, transition) << 2 * FIELD) + STEP[transition.action]

    def unchanged(self, transition: Transition) -> bool:
        """Whether a transition's rank is what its floor and Safe = 1 make it."""
        return self._cost[transition] <= self._floor.get(transition, -math.inf) and self._safe[transition] == 1.0

    def total(self, plan: TaskPlan) -> Total:
        """Return what a whole plan costs."""
        steps = tuple(map(self.terms, plan))
        terms = Terms(*map(math.fsum, zip(*steps, strict=True))) if steps else Terms(0.0, 0.0, 0.0)
        return Total(terms, sum(map(centimetres, map(sum, steps), plan)), steps)


class _Penalties(dict[float, float]):
    """The safety term of each Safe [m], worked out when it is first asked for."""

    def __init__(self, preset: Preset) -> None:
        self._preset = preset

    def __missing__(self, safe: float) -> float:
        self[safe] = found = penalty(safe, self._preset)
        return found


def penalty(safe: float, preset: Preset) -> float:
    """Return gamma/(1 + e^(Safe-1)), less gamma/2 where the preset has no constant term [m]."""
    if not 0.0 <= safe <= 1.0:
        raise ValueError(f"Safe is {safe!r}, which is not in [0, 1]")
    constant = 0.0 if preset.constant_term else preset.gamma / 2.0
    return preset.gamma / (1.0 + math.exp(safe - 1.0)) - constant


def turn_cost(action: Action, preset: Preset) -> float:
    """Return what is added for an action that is a left or right turn [m]."""
    return preset.turn_cost if action in TURNS else 0.0


def centimetres(metres: float, transition: Transition) -> int:
    """Round to whole centimetres; raises UtilityOverflowError for what the solver cannot hold."""
    if not 0.0 <= metres * 100.0 < LIMIT - 1:
        step = f"{transition.action} on {transition.state.segment}"
        raise UtilityOverflowError(f"{step} costs {metres} m: it must be from 0 to {LIMIT // 100 - 1} m, or inf")
    return round(metres * 100.0)


def split(rank: int) -> tuple[int, int, int]:
    """Return (centimetres, merges, actions) of a rank."""
    mask = (1 << FIELD) - 1
    return rank >> 2 * FIELD, rank >> FIELD & mask, rank & mask


def most(centimetres: int) -> int:
    """Return the rank that no plan of at most these centimetres exceeds."""
    return (centimetres + 1 << 2 * FIELD) - 1


def check_total(ranks: Mapping[Transition, int]) -> None:
    """Raise UtilityOverflowError where a plan over these transitions could cost more than the solver can hold."""
    if split(sum(ranks.values()))[0] < LIMIT:
        return
    dearest: dict[tuple[str, int], int] = {}
    for transition, rank in ranks.items():
        dearest[transition.state] = max(rank, dearest.get(transition.state, 0))
    worst = split(sum(dearest.values()))[0]
    if worst >= LIMIT:
        raise UtilityOverflowError(f"a plan could cost {worst / 100} m: a plan's cost lies below {LIMIT // 100} m")
