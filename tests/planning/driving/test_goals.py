from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.baselines.exploration.goal_tracker import GoalBlacklist
from lidarena.planning.driving.goals import (
    PARDONS,
    empty_accounts,
    fail,
    give_up,
    is_given_up,
    may_retreat,
    note_retreat,
    open_accounts,
    pardon,
    pursue,
    watch,
)

PLACE = st.sampled_from([(0.0, 0.0), (0.2, 0.1), (1.0, 0.0), (1.1, 0.2), (3.0, -2.0)])
DEED = st.one_of(
    st.tuples(st.just("pursue"), PLACE, st.just(0.0), st.just(False)),
    st.tuples(st.just("watch"), PLACE, st.floats(0.0, 5.0), st.booleans()),
    st.tuples(st.just("fail"), PLACE, st.just(0.0), st.booleans()),
    st.tuples(st.just("retreat"), PLACE, st.sampled_from([100.0, 100.5, 105.0]), st.booleans()),
    st.tuples(st.just("pardon"), PLACE, st.sampled_from([100.0, 100.5, 105.0]), st.booleans()),
)


@settings(deadline=None)  # kernels may have to be compiled
@given(st.lists(DEED, max_size=60))
def test_the_accounts_are_those_of_the_plain_blacklist(
    deeds: list[tuple[str, tuple[float, float], float, bool]],
) -> None:
    plain, accounts = GoalBlacklist(timeout=12, patience=4), empty_accounts(2)
    open_accounts(accounts, 1)
    for step, (deed, goal, remaining, flag) in enumerate(deeds):
        if deed == "pursue":
            plain.pursue(goal, step)
            pursue(1, *goal, step, accounts)
        elif deed == "watch":
            plain.watch(remaining, flag, step)
            watch(1, remaining, flag, step, 12, 4, accounts)
        elif deed == "retreat":
            assert plain.may_retreat(int(remaining)) == may_retreat(1, int(remaining), accounts)
            plain.note_retreat(int(remaining))
            note_retreat(1, int(remaining), accounts)
        elif deed == "pardon":
            assert plain.pardon(int(remaining)) == pardon(1, int(remaining), accounts)
        else:
            assert plain.fail(goal, flag) == fail(1, *goal, flag, accounts)
        for place in ((0.0, 0.0), (1.0, 0.0), (3.0, -2.0)):
            assert plain.is_given_up(place) == is_given_up(1, *place, accounts)
    assert not is_given_up(0, 0.0, 0.0, accounts)


def test_goals_are_pardoned_a_few_times_until_the_map_has_grown() -> None:
    accounts = empty_accounts(1)
    open_accounts(accounts, 0)
    give_up(0, 5.0, 5.0, accounts)
    for known in (1000, 1020):
        for _ in range(PARDONS):
            for _ in range(3):
                fail(0, 1.0, 2.0, False, accounts)
            assert is_given_up(0, 1.0, 2.0, accounts) and pardon(0, known, accounts)
            assert not is_given_up(0, 1.0, 2.0, accounts) and is_given_up(0, 5.0, 5.0, accounts)
        for _ in range(3):
            fail(0, 1.0, 2.0, False, accounts)
        assert not pardon(0, known, accounts)


def test_a_robot_goes_back_a_few_times_until_the_map_has_grown() -> None:
    accounts = empty_accounts(1)
    open_accounts(accounts, 0)
    pursue(0, 3.0, 1.0, 0, accounts)
    for known in (1000, 1020):
        for _ in range(PARDONS):
            assert may_retreat(0, known, accounts)
            note_retreat(0, known, accounts)
        assert not may_retreat(0, known, accounts) and is_given_up(0, 3.0, 1.0, accounts)
