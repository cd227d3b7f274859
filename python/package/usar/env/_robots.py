"""Each robot is an agent (PettingZoo)."""

from __future__ import annotations

from typing import Any, Optional

import numpy
from gymnasium import spaces
from gymnasium.utils import seeding
from pettingzoo import ParallelEnv

from .._usar import Scenario
from ._coordinator import Observation, Reward, Trial
from ._view import View


class Robots(ParallelEnv[str, Observation, int]):
    """One step is one decision: each agent wishes a task.

    Agents are called by role and id (`carrier_0`) and stay from reset to the end of the trial. A robot that
    rests or is lost is not asked: its mask is all zeros and its wish is ignored. All get the reward of the
    team, see `Coordinator`. `infos[agent]["moved"]` says whether a wish was not kept for the sizes' sake.
    """

    metadata: dict[str, Any] = {"name": "usar_robots_v0", "render_modes": []}
    render_mode = None

    def __init__(self, scenario: Scenario, reward: Reward = (1.0, 0.0, 0.0)) -> None:
        self._view, self._reward = View(scenario), reward
        view = self._view
        self.possible_agents = view.agents
        self.agents: list[str] = []
        self.feature_names = view.own_names + view.shared_names
        box = spaces.Box(0.0, 1.0, (len(self.feature_names),), numpy.float32)
        mask = spaces.Box(0, 1, (view.tasks,), numpy.int8)
        self.observation_spaces = {
            agent: spaces.Dict({"observation": box, "action_mask": mask}) for agent in self.possible_agents
        }
        self.action_spaces = {agent: spaces.Discrete(view.tasks) for agent in self.possible_agents}
        self._draws = seeding.np_random()[0]
        self._trial: Optional[Trial] = None

    def observation_space(self, agent: str) -> spaces.Space[Any]:
        """The space of an agent's observations."""
        return self.observation_spaces[agent]

    def action_space(self, agent: str) -> spaces.Space[Any]:
        """The tasks that an agent may wish."""
        return self.action_spaces[agent]

    def reset(
        self, seed: Optional[int] = None, options: Optional[dict[str, Any]] = None
    ) -> tuple[dict[str, Observation], dict[str, dict[str, Any]]]:
        """Begin the trial of a seed, or of one that is drawn."""
        if seed is not None:
            self._draws = seeding.np_random(seed)[0]
        seed = int(self._draws.integers(2**31)) if seed is None else seed
        self._trial = Trial(self._view, self._reward, seed)
        self._trial.go_on()
        self.agents = self.possible_agents[:]
        return self._observations(), self._infos([])

    def step(self, actions: dict[str, int]) -> tuple[
        dict[str, Observation],
        dict[str, float],
        dict[str, bool],
        dict[str, bool],
        dict[str, dict[str, Any]],
    ]:
        """Answer the question that waits."""
        assert self._trial is not None, "reset begins a trial"
        moved = self._trial.decide([actions.get(agent, 0) for agent in self.possible_agents])
        reward = self._trial.go_on()
        terminated, truncated = self._trial.ends
        agents = self.agents
        told = self._observations(), dict.fromkeys(agents, reward)
        ends = dict.fromkeys(agents, terminated), dict.fromkeys(agents, truncated)
        infos = self._infos(moved)
        if terminated or truncated:
            self.agents = []
        return *told, *ends, infos

    def _observations(self) -> dict[str, Observation]:
        assert self._trial is not None
        view, question = self._view, self._trial.question
        own, mask = view.own(question), view.mask(question)
        shared = view.shared(question, self._trial.simulation.time_s)
        return {
            agent: {"observation": numpy.concatenate([own[robot], shared]), "action_mask": mask[robot]}
            for robot, agent in enumerate(self.possible_agents)
        }

    def _infos(self, moved: list[int]) -> dict[str, dict[str, Any]]:
        return {agent: {"moved": robot in moved} for robot, agent in enumerate(self.possible_agents)}
