import random
from collections import Counter
from itertools import pairwise

import pytest

from tests.task.agreement import Case, random_case
from tests.task.tiny_roads import driven, grid, link, network, request, road
from tmpud.presets import TMPUD
from tmpud.symbols import OptimisticSafe, State, Transition
from tmpud.task.corridor import Search, backward_tree, corridor, whole_map
from tmpud.task.domain import Domain
from tmpud.task.facts import REDUCED, choices, encoding, facts, spelled
from tmpud.task.solver import ask, ground, written
from tmpud.task.utility import FIELD, FORBIDDEN, Utility, most, split


def search_of(case: Case, state: State) -> tuple[Domain, Search]:
    """Return a search on a tree that was made before the weights changed."""
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
def test_exits_are_sorted_and_stay_lower_bounds_after_the_weights_changed(seed: int) -> None:
    case = random_case(random.Random(seed))
    domain, search = search_of(case, State(case.request.start.segments[0], 0))
    bounds = dict.fromkeys(domain.goal_states(), 0)
    for state in states_of(domain):
        row = [way.through for way in search.out_of(state)]
        assert row == sorted(row)
        bounds[state] = min(row, default=FORBIDDEN)
    for state in states_of(domain):
        through = {way.transition: way.through for way in search.out_of(state)}
        for step in domain.successors(state):
            rank = search.utility.rank(step)
            assert through.get(step, FORBIDDEN) <= rank + bounds.get(step.next_state, FORBIDDEN)


@pytest.mark.parametrize("seed", range(60))
@pytest.mark.parametrize("more", [None, -1, 0, 1 << 2 * FIELD, 50_00 << 2 * FIELD])
def test_the_corridor_is_what_its_definition_says(seed: int, more: int | None) -> None:
    case = random_case(random.Random(seed))
    start = State(case.request.start.segments[0], 0)
    domain, search = search_of(case, start)
    first = Utility(case.preset, case.first, OptimisticSafe(), {})
    steps = [step for state in states_of(domain) for step in domain.successors(state)]
    present = {step: search.utility.rank(step) for step in steps}
    ahead = distances({start: 0}, [(step.state, present[step], step.next_state) for step in steps])
    back = distances(
        dict.fromkeys(domain.goal_states(), 0), [(step.next_state, first.rank(step), step.state) for step in steps]
    )
    optimum = min(ahead.get(goal, FORBIDDEN) for goal in domain.goal_states())
    limit = None if more is None else optimum + more
    found = corridor(search, start, limit)
    if optimum >= FORBIDDEN or (limit is not None and limit < optimum):
        assert found is None
        return
    assert found is not None
    onward = {
        step: ahead.get(step.state, FORBIDDEN) + rank + back.get(step.next_state, FORBIDDEN)
        for step, rank in present.items()
    }
    widest = optimum if limit is None else limit
    assert found.optimum == optimum
    assert found.ranks == {step: present[step] for step, rank in onward.items() if rank <= widest}
    for step in found.ranks:
        assert found.distance[step.state] == ahead[step.state]
        there = optimum if domain.is_goal(step.next_state) else ahead[step.next_state]
        assert found.distance[step.next_state] == there


def test_plans_that_became_equally_good_are_all_in_the_corridor() -> None:
    links = [link("a_0", "b_0"), link("a_0", "c_0"), link("b_0", "g_0"), link("c_0", "g_0")]
    domain = Domain(network([road(name) for name in "abcg"], links), request("a_0/0", "g_0/0"))
    steps = [step for state in states_of(domain) for step in domain.successors(state)]
    first = {step: 20.0 if step.state.segment == "b_0/0" else 10.0 for step in steps}
    now = first | {step: 20.0 for step in steps if step.state.segment == "c_0/0"}
    tree = backward_tree(domain, TMPUD, first)
    utility = Utility(TMPUD, now, OptimisticSafe(), tree.floor)
    found = corridor(Search(tree.out_of, utility, domain.last), domain.start_state())
    assert found is not None
    assert set(found.ranks) == set(steps)


def test_a_start_that_is_a_goal_needs_no_transition() -> None:
    domain = Domain(grid(2, random.Random(1)), request("0.0-E_0/0", "0.0-E_0/0"))
    tree = backward_tree(domain, TMPUD, driven(domain.network))
    search = Search(tree.out_of, Utility(TMPUD, {}, OptimisticSafe(), {}), domain.last)
    found = corridor(search, domain.start_state())
    assert found is not None
    assert (found.ranks, found.optimum) == ({}, 0)


def test_where_nothing_changed_only_the_corridor_is_weighed() -> None:
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


def states_of(domain: Domain) -> list[State]:
    return [State(segment, leg) for segment in domain.network.segments for leg in range(domain.last)]


def distances(sources: dict[State, int], edges: list[tuple[State, int, State]]) -> dict[State, int]:
    """Return the distances from the nearest source (Bellman-Ford)."""
    found, changed = dict(sources), True
    while changed:
        changed = False
        for one, rank, other in edges:
            if one in found and rank < FORBIDDEN and found[one] + rank < found.get(other, FORBIDDEN):
                found[other], changed = found[one] + rank, True
    return found


def test_the_corridor_of_a_town_is_a_small_part_of_it() -> None:
    roads = grid(6, random.Random(1))
    domain = Domain(roads, request("0.0-E_0/0", "5.5-W_1/1"))
    tree = backward_tree(domain, TMPUD, driven(roads))
    utility = Utility(TMPUD, driven(roads), OptimisticSafe(), tree.floor)
    search = Search(tree.out_of, utility, domain.last)
    found = corridor(search, domain.start_state())
    assert found is not None
    assert 20 * len(found.ranks) < len(whole_map(domain, utility, domain.start_state()).ranks)
