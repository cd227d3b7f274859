"""The environments keep the rules of their packages; warnings are errors."""

from __future__ import annotations

import doctest
import time
from pathlib import Path

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


def test_a_robot_that_rests_stays_with_a_mask() -> None:
    env = usar.env.Robots(usar.Scenario.builtin("gallery/failures"))
    seen, _ = env.reset(seed=1)
    masks = [0]
    while env.agents:
        seen, rewards, terminated, truncated, _ = env.step(dict.fromkeys(env.agents, 0))
        assert list(seen) == env.possible_agents and len(set(rewards.values())) == 1
        masks.append(sum(not one["action_mask"].any() for one in seen.values()))
    assert max(masks[:-1]) > 0, "somebody was lost on the way"
    assert all(truncated.values()) and not any(terminated.values())


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
    with pytest.raises(ValueError, match="hz must be above 0 and at most 50"):
        usar.env.Velocities(scenario, hz=100)
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
