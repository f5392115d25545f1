from lidarena.baselines.exploration.goal_tracker import GoalBlacklist, is_same


def blacklist(**options):
    return GoalBlacklist(timeout=10, patience=3, **options)


def test_goals_within_five_cells_are_one():
    assert is_same((1.0, 2.0), (1.2, 1.8))
    assert not is_same((1.0, 2.0), (1.3, 2.0))
    assert not is_same((1.0, 2.0), (1.0, 2.26))


def test_a_goal_that_comes_nearer_is_kept():
    account = blacklist()
    account.pursue((1.0, 1.0), 0)
    for step in range(50):
        account.watch(10.0 - 0.1 * step, False, step)
    assert not account.is_given_up((1.0, 1.0))


def test_a_goal_without_progress_is_given_up_after_the_timeout():
    account = blacklist()
    account.pursue((1.0, 1.0), 0)
    for step in range(10):
        account.watch(5.0 - 0.001 * step, False, step)
        assert not account.given_up
    account.watch(5.0, False, 10)
    assert account.is_given_up((1.1, 0.9)) and not account.is_given_up((2.0, 1.0))


def test_another_goal_starts_a_new_account_and_the_same_one_does_not():
    account = blacklist()
    account.pursue((1.0, 1.0), 0)
    account.watch(5.0, False, 0)
    account.pursue((1.1, 1.0), 8)
    account.watch(5.0, False, 10)
    assert account.given_up == [(1.0, 1.0)]
    account.pursue((3.0, 1.0), 11)
    account.watch(5.0, False, 20)
    assert len(account.given_up) == 1


def test_a_goal_reached_in_vain_is_given_up_after_some_patience():
    account = blacklist()
    account.pursue((1.0, 1.0), 0)
    for step in (4, 5, 6):
        account.watch(0.0, True, step)
    assert account.arrived_at == 4 and not account.given_up
    account.watch(0.0, True, 7)
    assert account.is_given_up((1.0, 1.0))


def test_failures_are_counted_goal_by_goal():
    account = blacklist(tries=3)
    assert not account.fail((1.0, 1.0))
    assert not account.fail((5.0, 1.0))
    assert not account.fail((1.1, 1.0))
    assert account.fail((1.0, 1.1))
    assert account.is_given_up((1.0, 1.0)) and not account.is_given_up((5.0, 1.0))
    assert account.fail((9.0, 9.0), for_good=True)


def test_nothing_pursued_nothing_given_up():
    account = blacklist()
    account.watch(1.0, True, 100)
    assert not account.given_up
