import random
from collections import Counter
from itertools import pairwise

import pytest

from tests.task.agreement import Case, random_case
from tests.task.tiny_roads import driven, grid, request
from tmpud.presets import TMPUD
from tmpud.symbols import OptimisticSafe, State, Transition
from tmpud.task.corridor import Search, backward_tree, corridor, whole_map
from tmpud.task.domain import Domain
from tmpud.task.facts import REDUCED, choices, encoding, facts, spelled
from tmpud.task.solver import ask, ground, written
from tmpud.task.utility import FORBIDDEN, Utility, most, split


def search_of(case: Case, state: State) -> tuple[Domain, Search]:
    """Return a search whose bounds were made before the weights changed."""
    domain = Domain(case.network, case.request)
    tree = backward_tree(domain, case.preset, case.cost)
    case.change(state)
    utility = Utility(case.preset, case.cost, case.safe, tree.floor)
    return domain, Search(tree.out_of, utility, domain.last)


@pytest.mark.parametrize("seed", range(60))
def test_the_corridor_holds_every_optimal_plan_of_the_whole_map(seed: int) -> None:
    case = random_case(random.Random(seed))
    state = State(case.request.start.segments[0], 0)
    domain, search = search_of(case, state)
    found, everything = corridor(search, state), whole_map(domain, search.utility, state)
    weights = {transition: split(rank)[0] for transition, rank in everything.ranks.items()}
    answer = ask(written(encoding() + facts(domain, state, weights), {spelled(step): (step,) for step in weights}))
    assert (found is None) == (answer.union == ())
    if found is not None:
        assert found.optimal_transitions() == set(answer.union)
        assert set(answer.union) <= set(found.ranks) <= set(everything.ranks)
        assert split(found.optimum)[0] == answer.centimetres


@pytest.mark.parametrize("seed", range(60))
@pytest.mark.parametrize("more", [0, 50_00])
def test_the_solver_is_given_what_the_encoding_says_of_a_corridor(seed: int, more: int) -> None:
    case = random_case(random.Random(seed))
    state = State(case.request.start.segments[0], 0)
    domain, search = search_of(case, state)
    best = corridor(search, state)
    if best is None:
        return
    given = corridor(search, state, most(split(best.optimum)[0] + more))
    assert given is not None
    program = encoding(REDUCED) + choices(domain, state, given.ranks, given.reduced)
    read = ask(written(program, {spelled(step): (step,) for step in given.ranks}))
    built = ask(ground(state, domain.last, given))
    assert (set(built.union), built.centimetres, built.optimal) == (set(read.union), read.centimetres, True)
    assert more or set(built.union) == given.optimal_transitions()


@pytest.mark.parametrize("seed", range(60))
def test_stretches_hold_each_transition_once_and_leave_every_choice_between_them(seed: int) -> None:
    case = random_case(random.Random(seed))
    state = State(case.request.start.segments[0], 0)
    _, search = search_of(case, state)
    found = corridor(search, state)
    if found is None:
        return
    stretches = found.stretches(state)
    assert sorted(step for way in stretches for step in way) == sorted(found.ranks)
    assert all(before.next_state == after.state for way in stretches for before, after in pairwise(way))
    inner = Counter(step.state for way in stretches for step in way[1:])
    ways_in = Counter(step.next_state for step in found.ranks)
    ways_out = Counter(step.state for step in found.ranks)
    assert all(ways_in[joint] == ways_out[joint] == 1 for joint in inner)
    assert state not in inner
    ends = {way[0].state for way in stretches} - {state}
    assert all(ways_in[end] != 1 or ways_out[end] != 1 for end in ends)


@pytest.mark.parametrize("seed", range(20))
def test_the_kept_ways_are_lower_bounds_after_the_weights_changed(seed: int) -> None:
    case = random_case(random.Random(seed))
    domain, search = search_of(case, State(case.request.start.segments[0], 0))
    for state in (State(segment, leg) for segment in case.network.segments for leg in range(domain.last)):
        ways = search.ways(state)
        assert [way.through for way in ways] == sorted(way.through for way in ways)
        through = {way.transition: way.through for way in ways}
        for transition in domain.successors(state):
            rank, onward = search.utility.rank(transition), bound(domain, search, transition.next_state)
            assert through.get(transition, FORBIDDEN) <= rank + onward


def bound(domain: Domain, search: Search, state: State) -> int:
    if domain.is_goal(state):
        return 0
    return min((way.through for way in search.ways(state)), default=FORBIDDEN)


def test_most_ways_are_never_weighed() -> None:
    roads = grid(6, random.Random(1))
    domain = Domain(roads, request("0.0-E_0/0", "5.5-W_1/1"))
    cost = driven(roads)
    tree = backward_tree(domain, TMPUD, cost)
    weighed = Counter[Transition]()

    class Watched(dict[Transition, float]):
        def __getitem__(self, transition: Transition) -> float:
            weighed[transition] += 1
            return cost[transition]

    utility = Utility(TMPUD, Watched(), OptimisticSafe(), tree.floor)
    found = corridor(Search(tree.out_of, utility, domain.last), domain.start_state())
    assert found is not None
    assert weighed == Counter(list(found.ranks))


def test_the_corridor_of_a_town_is_a_small_part_of_it() -> None:
    roads = grid(6, random.Random(1))
    domain = Domain(roads, request("0.0-E_0/0", "5.5-W_1/1"))
    tree = backward_tree(domain, TMPUD, driven(roads))
    utility = Utility(TMPUD, driven(roads), OptimisticSafe(), tree.floor)
    search = Search(tree.out_of, utility, domain.last)
    found = corridor(search, domain.start_state())
    assert found is not None
    assert 20 * len(found.ranks) < len(whole_map(domain, utility, domain.start_state()).ranks)
