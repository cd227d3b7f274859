"""Each robot is an agent (PettingZoo)."""

from __future__ import annotations

from typing import Any, Optional

import numpy
from gymnasium import spaces

from .._usar import Scenario
from ._agents import Agents, Infos, Step
from ._coordinator import Observation, Reward, Trial
from ._view import View


class Robots(Agents[Observation, int]):
    """One step is one decision: each agent wishes a task.

    Agents are called by role and id (`carrier_0`) and stay from reset to the end of the trial. A robot that
    rests or is lost is not asked: its mask is all zeros and its wish is ignored. All get the reward of the
    team, see `Coordinator`. `infos[agent]["moved"]` says whether a wish was not kept for the sizes' sake.
    """

    metadata: dict[str, Any] = {"name": "usar_robots_v0", "render_modes": []}

    def __init__(self, scenario: Scenario, reward: Reward = (1.0, 0.0, 0.0)) -> None:
        self._view = view = View(scenario)
        self._reward = reward
        self._trial: Optional[Trial] = None
        self.feature_names = view.own_names + view.shared_names
        seen: dict[str, spaces.Space[Any]] = {
            "observation": spaces.Box(0.0, 1.0, (len(self.feature_names),), numpy.float32),
            "action_mask": spaces.Box(0, 1, (view.tasks,), numpy.int8),
        }
        super().__init__(view.agents, spaces.Dict(seen), spaces.Discrete(view.tasks))

    def reset(
        self, seed: Optional[int] = None, options: Optional[dict[str, Any]] = None
    ) -> tuple[dict[str, Observation], Infos]:
        """Begin the trial of a seed, or of one that is drawn."""
        self._trial = Trial(self._view, self._reward, self._seed(seed))
        self._trial.go_on()
        self.agents = self.possible_agents[:]
        return self._observations(self._trial), self._infos([])

    def step(self, actions: dict[str, int]) -> Step[Observation]:
        """Answer the question that waits."""
        trial = self._trial
        assert trial is not None, "reset begins a trial"
        moved = trial.decide(trial.asked([actions.get(agent, 0) for agent in self.possible_agents]))
        reward = trial.go_on()
        return self._stepped(self._observations(trial), reward, trial.ends, self._infos(moved))

    def _observations(self, trial: Trial) -> dict[str, Observation]:
        view, question = self._view, trial.question
        own, mask = view.own(question), view.mask(question)
        shared = view.shared(question, trial.simulation.time_s)
        return {
            agent: {"observation": numpy.concatenate([own[robot], shared]), "action_mask": mask[robot]}
            for robot, agent in enumerate(self.possible_agents)
        }

    def _infos(self, moved: list[int]) -> Infos:
        return {agent: {"moved": robot in moved} for robot, agent in enumerate(self.possible_agents)}
