"""One agent decides for the whole team (Gymnasium)."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any, Optional, Union

import gymnasium
import numpy
import numpy.typing
from gymnasium import spaces
from gymnasium.utils import seeding
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space

from .._results import MOST_THREADS, counted
from .._types import Question
from .._usar import Scenario, Simulation, advance_all
from ._groups import settled
from ._view import View

Observation = dict[str, numpy.typing.NDArray[Any]]
Reward = Sequence[float]
MOST_TRIALS = 1_000_000  # as in a sweep


class Trial:
    """A trial as environments see it: decisions, rewards, and how it ends."""

    def __init__(self, view: View, reward: Reward, seed: int) -> None:
        if len(reward) != 3:
            raise ValueError(f"reward must have three weights: of rescuees, energy and HP; found {reward}")
        self.view, self.weights = view, numpy.array([1.0, -1.0, -1.0]) * reward
        self.simulation = Simulation(view.scenario, seed)
        self.question: Optional[Question] = None
        self._totals = numpy.zeros(3)

    def asked(self, wishes: Any) -> dict[int, int]:
        """The tasks that the members of the question wish, once they are checked."""
        assert self.question is not None, "the trial is over: reset it"
        if len(wishes) != self.view.robots:
            raise ValueError(f"wishes must be of all {self.view.robots} robots, found {len(wishes)}")
        asked = {member["id"]: int(wishes[member["id"]]) for member in self.question["members"]}
        if unknown := {robot: task for robot, task in asked.items() if not 0 <= task < self.view.tasks}:
            raise ValueError(f"wishes must be tasks from 0 to {self.view.tasks - 1}, found {unknown}")
        return asked

    def decide(self, asked: dict[int, int]) -> list[int]:
        """Send the members of the question to tasks; return those that were moved."""
        assert self.question is not None
        groups, moved = settled(self.question, asked)
        self.simulation.assign(groups)
        return moved

    def go_on(self) -> float:
        """Go to the next question; return the reward since the last."""
        self.question = self.simulation.until_asked()
        totals = numpy.array(self.simulation.totals)
        gained, self._totals = totals - self._totals, totals
        return float(self.weights @ gained)

    @property
    def ends(self) -> tuple[bool, bool]:
        """Whether it is over for good, and whether the time is over."""
        status = self.simulation.status
        return status not in (None, "completed"), status == "completed"

    def observation(self) -> Observation:
        """What the whole team reports."""
        view, question = self.view, self.question
        shared = view.shared(question, self.simulation.time_s)
        return {
            "observation": numpy.concatenate([view.own(question).ravel(), shared]),
            "action_mask": view.mask(question),
        }

    def info(self, moved: list[int]) -> dict[str, Any]:
        """What is told beside an observation."""
        return {"moved": moved, "time_s": self.simulation.time_s, "rescued": self.simulation.totals[0]}


def _spaces(view: View) -> tuple[spaces.Space[Any], spaces.MultiDiscrete]:
    size = view.robots * len(view.own_names) + len(view.shared_names)
    observation = spaces.Dict(
        {
            "observation": spaces.Box(0.0, 1.0, (size,), numpy.float32),
            "action_mask": spaces.Box(0, 1, (view.robots, view.tasks), numpy.int8),
        }
    )
    return observation, spaces.MultiDiscrete([view.tasks] * view.robots)


def _feature_names(view: View) -> list[str]:
    own = [f"robot_{robot}_{name}" for robot in range(view.robots) for name in view.own_names]
    return own + view.shared_names


class Coordinator(gymnasium.Env[Observation, numpy.typing.NDArray[Any]]):
    """One step is one decision: an action wishes a task for each robot, by its id.

    Wishes of robots that are not asked are ignored; sizes that wishes break are settled (`usar.env._groups`)
    and `info["moved"]` has the robots that were moved. The reward is the sum of what `reward` weighs, over
    the round: rescuees, energy and HP that were spent (which count against it). The end of the time is
    truncation; a trial in which nobody can carry any more, or nothing is left to do, is terminated.

    `reset(seed=7)` begins the trial of seed 7. Without a seed, the next one is drawn.
    """

    metadata: dict[str, Any] = {"render_modes": []}

    def __init__(self, scenario: Scenario, reward: Reward = (1.0, 0.0, 0.0)) -> None:
        self._view, self._reward = View(scenario), reward
        self.observation_space, self.action_space = _spaces(self._view)
        self.feature_names = _feature_names(self._view)
        self._trial: Optional[Trial] = None

    def reset(
        self, *, seed: Optional[int] = None, options: Optional[dict[str, Any]] = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Begin a trial."""
        super().reset(seed=seed)
        self._trial = Trial(self._view, self._reward, _seed(seed, self.np_random))
        self._trial.go_on()
        return self._trial.observation(), self._trial.info([])

    def step(
        self, action: numpy.typing.NDArray[Any]
    ) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """Answer the question that waits."""
        assert self._trial is not None, "reset begins a trial"
        moved = self._trial.decide(self._trial.asked(action))
        reward = self._trial.go_on()
        return self._trial.observation(), reward, *self._trial.ends, self._trial.info(moved)


class Vector(VectorEnv[Observation, numpy.typing.NDArray[Any], numpy.typing.NDArray[Any]]):
    """Many coordinators of one scenario, whose trials run on threads without Python.

    Number i has the trials of `Coordinator` with the seeds that it gets: `reset(seed=7)` begins those of
    seeds 7, 8, 9 and so on. A trial that is over begins anew in the next step (`AutoresetMode.NEXT_STEP`).
    """

    metadata: dict[str, Any] = {"autoreset_mode": AutoresetMode.NEXT_STEP, "render_modes": []}

    def __init__(self, scenario: Scenario, n: int, threads: Optional[int] = None, reward: Reward = (1, 0, 0)) -> None:
        self._view, self._reward, self.num_envs = View(scenario), reward, counted("n", n, MOST_TRIALS)
        cores = min(os.cpu_count() or 1, MOST_THREADS)
        self._threads = counted("threads", cores if threads is None else threads, MOST_THREADS)
        self.single_observation_space, self.single_action_space = _spaces(self._view)
        self.observation_space = batch_space(self.single_observation_space, n)
        self.action_space = batch_space(self.single_action_space, n)
        self.feature_names = _feature_names(self._view)
        self._draws = [seeding.np_random()[0] for _ in range(n)]
        self._trials: list[Trial] = []
        self._is_over = numpy.zeros(n, bool)

    def reset(
        self,
        *,
        seed: Union[int, Sequence[Optional[int]], None] = None,
        options: Optional[dict[str, Any]] = None,
    ) -> tuple[Observation, dict[str, Any]]:
        """Begin all trials."""
        if seed is None or isinstance(seed, (int, numpy.integer)):
            seeds: list[Optional[int]] = [None if seed is None else int(seed) + at for at in range(self.num_envs)]
        else:
            seeds = [None if one is None else int(one) for one in seed]
            if len(seeds) != self.num_envs:
                raise ValueError(f"seed must be one, or {self.num_envs} in a list, found {len(seeds)}")
        self._draws = [
            draws if seed is None else seeding.np_random(seed)[0]
            for seed, draws in zip(seeds, self._draws)
        ]
        self._trials = [self._begin(at, seed) for at, seed in enumerate(seeds)]
        advance_all([trial.simulation for trial in self._trials], self._threads)
        for trial in self._trials:
            trial.go_on()
        self._is_over[:] = False
        return self._observations(), self._infos([[]] * self.num_envs)

    def step(
        self, actions: numpy.typing.NDArray[Any]
    ) -> tuple[Observation, Any, Any, Any, dict[str, Any]]:
        """Answer the questions that wait; where a trial was over, begin the next one instead."""
        if len(actions) != self.num_envs:
            raise ValueError(f"actions must be of all {self.num_envs} trials, found {len(actions)}")
        begun = self._is_over.copy()
        goes_on = zip(self._trials, actions, begun)
        asked = [{} if is_over else trial.asked(action) for trial, action, is_over in goes_on]
        moved: list[list[int]] = [[] for _ in self._trials]
        for at, trial in enumerate(self._trials):
            if begun[at]:
                self._trials[at] = self._begin(at, None)
            else:
                moved[at] = trial.decide(asked[at])
        advance_all([trial.simulation for trial in self._trials], self._threads)
        rewards = numpy.array([trial.go_on() for trial in self._trials])
        ends = numpy.array([trial.ends for trial in self._trials])
        self._is_over = numpy.asarray(ends.any(axis=1))
        return self._observations(), rewards * ~begun, ends[:, 0], ends[:, 1], self._infos(moved)

    def _begin(self, at: int, seed: Optional[int]) -> Trial:
        return Trial(self._view, self._reward, _seed(seed, self._draws[at]))

    def _observations(self) -> Observation:
        each = [trial.observation() for trial in self._trials]
        return {name: numpy.stack([one[name] for one in each]) for name in ("observation", "action_mask")}

    def _infos(self, moved: list[list[int]]) -> dict[str, Any]:
        infos = [trial.info(robots) for trial, robots in zip(self._trials, moved)]
        lists = numpy.empty(self.num_envs, object)
        lists[:] = [info["moved"] for info in infos]
        return {"moved": lists} | {name: numpy.array([info[name] for info in infos]) for name in ("time_s", "rescued")}


def vector(scenario: Scenario, n: int, threads: Optional[int] = None, reward: Reward = (1, 0, 0)) -> Vector:
    """`n` coordinators on this number of threads, one for each core if it is not given."""
    return Vector(scenario, n, threads, reward)


def _seed(seed: Optional[int], draws: numpy.random.Generator) -> int:
    return int(draws.integers(2**31)) if seed is None else seed
