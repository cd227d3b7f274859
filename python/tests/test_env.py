"""The environments keep the rules of their packages; warnings are errors."""

from __future__ import annotations

import doctest
import itertools
import time
from pathlib import Path
from typing import Any, Callable

import gymnasium
import numpy
import pytest
from gymnasium.utils.env_checker import check_env
from pettingzoo.test import parallel_api_test, parallel_seed_test

import usar
import usar.env
from usar.env import _groups

SCENARIOS = ["paper", "leak", "tunnel", "three-tasks", "convoy"]
HEAD_ON = Path(__file__).parents[2] / "scenarios/minimal/head_on.ron"
pytestmark = pytest.mark.filterwarnings("error")


@pytest.mark.parametrize("name", SCENARIOS)
def test_environments_pass_the_tests_of_their_packages(name: str) -> None:
    scenario = usar.Scenario.builtin(name)
    parallel_api_test(usar.env.Robots(scenario), num_cycles=20)
    parallel_seed_test(lambda: usar.env.Robots(scenario), num_cycles=8)
    check_env(gymnasium.make("usar/Coordinator-v0", scenario=scenario).unwrapped, skip_render_check=True)


@pytest.mark.parametrize("name", SCENARIOS)
def test_velocities_pass_the_tests_of_their_package(name: str) -> None:
    scenario = usar.Scenario.builtin(name)
    parallel_api_test(usar.env.Velocities(scenario, hz=2), num_cycles=50)
    parallel_seed_test(lambda: usar.env.Velocities(scenario, hz=2), num_cycles=20)


def test_many_are_the_same_as_each_of_them() -> None:
    scenario = usar.Scenario.builtin("leak")
    many = usar.env.vector(scenario, 4, 2, reward=(1.0, 0.01, 0.1))
    single = [usar.env.Coordinator(scenario, reward=(1.0, 0.01, 0.1)) for _ in range(4)]
    seen, _ = many.reset(seed=5)
    for at, one in enumerate(single):
        assert numpy.array_equal(seen["observation"][at], one.reset(seed=5 + at)[0]["observation"])
    draws, is_over, ended = numpy.random.default_rng(0), [False] * 4, 0
    for _ in range(20):
        actions = draws.integers(0, 2, (4, scenario.robots))
        seen, rewards, terminated, truncated, infos = many.step(actions)
        for at, one in enumerate(single):
            if is_over[at]:
                (alone, _), is_over[at] = one.reset(), False
            else:
                alone, reward, *ends, info = one.step(actions[at])
                is_over[at] = any(ends)
                assert reward == rewards[at] and ends == [terminated[at], truncated[at]]
                assert info["moved"] == infos["moved"][at]
                ended += is_over[at]
            for field in ("observation", "action_mask"):
                assert numpy.array_equal(seen[field][at], alone[field])
    assert ended >= 4


def test_sizes_that_wishes_break_are_settled() -> None:
    assert doctest.testmod(_groups).failed == 0
    question = usar.Simulation(usar.Scenario.builtin("paper"), 1).until_asked()
    assert question is not None
    for seed in range(200):
        draws = numpy.random.default_rng(seed)
        wishes = {member["id"]: int(draws.integers(2)) for member in question["members"]}
        groups, moved = _groups.settled(question, wishes)
        for task, group in enumerate(groups):
            assert all((wishes[robot] == task) != (robot in moved) for robot in group)
        kept = {robot: task for task, group in enumerate(groups) for robot in group}
        again, none = _groups.settled(question, kept)
        assert again == groups and none == []

        def fixed(question: object, groups: list[list[int]] = groups) -> list[list[int]]:
            return groups

        assert usar.group(question, fixed) == groups  # refused if it breaks a rule


def test_parts_go_where_fewest_robots_move() -> None:
    draws = numpy.random.default_rng(0)
    for tasks in [*range(1, 6)] * 100 + [64]:
        parts = draws.integers(0, 5, tasks).tolist()
        wished = numpy.bincount(draws.integers(0, tasks, sum(parts)), minlength=tasks).tolist()
        sizes = _groups._sizes("Parts", parts, wished)
        assert sorted(sizes) == sorted(parts)
        if tasks < 6:
            orders = [list(order) for order in itertools.permutations(parts)]
            moves = [sum(max(0, has - size) for has, size in zip(wished, order)) for order in orders]
            assert wished == parts or sizes == orders[moves.index(min(moves))]


def test_a_robot_that_rests_stays_with_a_mask() -> None:
    env = usar.env.Robots(usar.Scenario.builtin("gallery/failures"))
    seen, _ = env.reset(seed=1)
    masks = [0]
    while env.agents:
        seen, rewards, terminated, truncated, _ = env.step(dict.fromkeys(env.agents, 0))
        assert list(seen) == env.possible_agents and len(set(rewards.values())) == 1
        masks.append(sum(not one["action_mask"].any() for one in seen.values()))
    assert max(masks[:-1]) > 0, "somebody was lost on the way"
    assert all(terminated.values()) and not any(truncated.values()), "nobody is left to bring home"


def test_nobody_who_can_carry_is_a_termination() -> None:
    stranded = usar.Scenario.builtin("paper").set(**{"costs.energy.per_second": 5.0})
    env = usar.env.Coordinator(stranded)
    env.reset(seed=1)
    ends = (False, False)
    while not any(ends):
        _, _, *both, _ = env.step(numpy.zeros(12, int))
        ends = (both[0], both[1])
    assert ends == (True, False)


def test_rewards_are_what_the_trial_gained() -> None:
    scenario, sums = usar.Scenario.builtin("paper"), {}
    for weights in [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)]:
        env = usar.env.Coordinator(scenario, reward=weights)
        env.reset(seed=3)
        sums[weights], is_over = 0.0, False
        while not is_over:
            _, reward, *ends, info = env.step(numpy.zeros(12, int))
            sums[weights], is_over = sums[weights] + reward, any(ends[:2])
    rescued, energy, hp = sums.values()
    assert rescued == info["rescued"] > 100 and energy < -500 and -1000 < hp < 0
    with pytest.raises(ValueError, match="three weights"):
        usar.env.Coordinator(scenario, reward=(1,)).reset(seed=1)
    env.reset(seed=3)
    with pytest.raises(ValueError, match="wishes must be tasks from 0 to 1"):
        env.step(numpy.full(12, -1))


def test_robots_go_where_actions_send_them() -> None:
    scenario = usar.Scenario.builtin("paper").set(duration_s=20, **{"conflicts.resolver": "None"})
    env = usar.env.Velocities(scenario, hz=10)
    env.reset(seed=1)
    start = env._trial.positions
    for _ in range(10):
        env.step(dict.fromkeys(env.agents, numpy.array([0.0, 0.3], numpy.float32)))
    way = env._trial.positions - start
    assert (way[:, 1] > 0.1).sum() >= 10 and (abs(way[:, 0]) < 0.2).sum() >= 10


def test_a_world_that_cannot_be_one_is_refused() -> None:
    with pytest.raises(ValueError, match="chance: an environment needs a team of one size"):
        usar.env.Robots(usar.Scenario.builtin("gallery/chance"))
    with pytest.raises(ValueError, match="its trials ask no question"):
        usar.env.Velocities(usar.Scenario.load(HEAD_ON))


def test_speed_is_told(capsys: pytest.CaptureFixture[str]) -> None:
    env = usar.env.Velocities(usar.Scenario.builtin("paper"))
    env.reset(seed=1)
    actions = {agent: numpy.full(2, 0.5, numpy.float32) for agent in env.agents}
    begun, steps = time.perf_counter(), 500
    for _ in range(steps):
        env.step(actions)
    took = time.perf_counter() - begun
    rates = {}
    for threads in (1, 2):
        many = usar.env.vector(usar.Scenario.builtin("tunnel"), 8, threads)
        many.reset(seed=1)
        begun, done = time.perf_counter(), 0
        many.action_space.seed(0)
        while done < 12:
            many.step(many.action_space.sample())
            done += 1
        rates[threads] = done * 8 / (time.perf_counter() - begun)
    with capsys.disabled():
        print(f"\nvelocities: {steps / took:.0f} steps a second with 12 robots")
        print(f"vector of 8: {rates[1]:.1f} and {rates[2]:.1f} decisions a second on one and two threads")


@pytest.mark.parametrize(
    ("values", "hz", "near"),
    [
        ({}, 40, "10"),
        ({}, 30, "10"),
        ({}, 50, "10"),
        ({}, 7, "10 or 5"),
        ({}, 3, "3.33333 or 2.5"),
        ({"control_period_s": 0.02}, 40, "50 or 25"),
        ({"control_period_s": 0.04}, 10, "12.5 or 8.33333"),
    ],
)
def test_a_rate_is_kept_or_refused(values: dict[str, float], hz: float, near: str) -> None:
    scenario = usar.Scenario.builtin("paper").set(duration_s=30, **values)
    with pytest.raises(ValueError, match=f"found {hz}; nearby is {near}$"):
        usar.env.Velocities(scenario, hz=hz)
    for rate in map(float, near.split(" or ")):
        swarm = usar.env.Velocities(scenario, hz=rate)
        swarm.reset(seed=1)
        still = {agent: numpy.zeros(2, numpy.float32) for agent in swarm.agents}
        before = swarm._trial.time_s
        for _ in range(10):
            swarm.step(still)
        assert 10 / (swarm._trial.time_s - before) == pytest.approx(rate, rel=1e-5)


RATES = [("paper", 10), ("two-aerial-roles", 12.5), ("paper-calibrated", 25)]


@pytest.mark.parametrize(("name", "rate"), RATES)
def test_agents_drive_as_often_as_robots_decide(name: str, rate: float) -> None:
    swarm = usar.env.Velocities(usar.Scenario.builtin(name))
    swarm.reset(seed=1)
    swarm.step(dict.fromkeys(swarm.agents, numpy.zeros(2, numpy.float32)))
    assert swarm._trial.time_s == pytest.approx(1 / rate)


@pytest.mark.parametrize("hz", [0, -1, 1e-300, float("nan"), float("inf")])
def test_a_rate_that_is_none_is_refused(hz: float) -> None:
    with pytest.raises(ValueError, match="hz must be"):
        usar.env.Velocities(usar.Scenario.builtin("paper").set(duration_s=30), hz=hz)


def test_robots_heed_every_action() -> None:
    scenario = usar.Scenario.builtin("paper").set(duration_s=30, **{"conflicts.resolver": "None"})
    swarm = usar.env.Velocities(scenario)
    swarm.reset(seed=1)
    for turn in range(8):
        east = 0.2 if turn % 2 == 0 else -0.2
        before = swarm._trial.velocities[:, 0]
        swarm.step(dict.fromkeys(swarm.agents, numpy.array([east, 0.0], numpy.float32)))
        change = swarm._trial.velocities[:, 0] - before
        assert (change * east > 0.0).sum() >= 10, turn


@pytest.mark.parametrize(
    "spoil",
    [
        lambda wishes: wishes.__setitem__((2, 11), 7),
        lambda wishes: wishes.__setitem__((2, 0), -1),
        lambda wishes: wishes.__setitem__((2, 0), numpy.nan),
        lambda wishes: wishes.resize((2, 12), refcheck=False),
        lambda wishes: wishes.resize((4, 12), refcheck=False),
        lambda wishes: wishes.resize((3, 11), refcheck=False),
        lambda wishes: wishes.resize((3, 13), refcheck=False),
    ],
)
def test_all_wishes_are_checked_before_the_first_is_answered(spoil: Callable[[Any], None]) -> None:
    scenario = usar.Scenario.builtin("paper").set(duration_s=120)
    many, again = (usar.env.vector(scenario, 3, 1) for _ in range(2))
    for one in (many, again):
        one.reset(seed=1)
    good = numpy.zeros((3, 12))
    bad = good.copy()
    spoil(bad)
    with pytest.raises(ValueError):
        many.step(bad)
    (seen, *rest), (expected, *as_expected) = many.step(good), again.step(good)
    assert all(numpy.array_equal(seen[name], expected[name]) for name in seen)
    assert numpy.array_equal(rest[0], as_expected[0])


def test_a_single_wish_is_checked_before_it_is_answered() -> None:
    scenario = usar.Scenario.builtin("paper").set(duration_s=120)
    one = usar.env.Coordinator(scenario)
    one.reset(seed=1)
    for wrong in (numpy.zeros(11), numpy.zeros(13), numpy.full(12, 7)):
        with pytest.raises(ValueError, match="wishes must be"):
            one.step(wrong)
    one.step(numpy.zeros(12))
    robots = usar.env.Robots(scenario)
    robots.reset(seed=1)
    with pytest.raises(ValueError, match="wishes must be"):
        robots.step(dict.fromkeys(robots.agents, 7))
    robots.step(dict.fromkeys(robots.agents, 0))


@pytest.mark.parametrize("seeds", [[], [1], [1, 2, 3], (1,), numpy.arange(3)])
def test_seeds_of_another_number_are_refused(seeds: Any) -> None:
    many = usar.env.vector(usar.Scenario.builtin("paper").set(duration_s=120), 2, 1)
    with pytest.raises(ValueError, match=f"seed must be one, or 2 in a list, found {len(seeds)}"):
        many.reset(seed=seeds)
    good_seeds: list[Any] = [[1, 2], numpy.array([1, 2]), (1, None), 1, numpy.int64(1), None]
    for good in good_seeds:
        seen, _ = many.reset(seed=good)
        assert many.observation_space.contains(seen)


@pytest.mark.parametrize(
    ("n", "threads", "wrong"),
    [
        (0, 1, "n must be from 1 to 1000000, found 0"),
        (-1, 1, "n must be from 1"),
        (10**30, 1, "n must be from 1"),
        (2, 0, "threads must be from 1 to 1024, found 0"),
        (2, -1, "threads must be from 1"),
        (2, 10**6, "threads must be from 1"),
        (2, 10**30, "threads must be from 1"),
    ],
)
def test_a_vector_has_some_trials_and_not_too_many_threads(n: int, threads: int, wrong: str) -> None:
    with pytest.raises(ValueError, match=wrong):
        usar.env.vector(usar.Scenario.builtin("paper"), n, threads)
