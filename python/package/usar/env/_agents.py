"""What environments with an agent for each robot have in common (PettingZoo)."""

from __future__ import annotations

from copy import deepcopy
from typing import Any, Generic, Optional, TypeVar

from gymnasium import spaces
from gymnasium.utils import seeding
from pettingzoo import ParallelEnv

Seen = TypeVar("Seen")
Done = TypeVar("Done")
Infos = dict[str, dict[str, Any]]
Step = tuple[dict[str, Seen], dict[str, float], dict[str, bool], dict[str, bool], Infos]


class Agents(ParallelEnv[str, Seen, Done], Generic[Seen, Done]):
    """Agents that all are there from reset to the end of a trial, and end with it."""

    render_mode = None

    def __init__(self, names: list[str], observation: spaces.Space[Any], action: spaces.Space[Any]) -> None:
        self.possible_agents = names
        self.agents: list[str] = []
        # Each its own, because a space has random draws of its own.
        self.observation_spaces = {name: deepcopy(observation) for name in names}
        self.action_spaces = {name: deepcopy(action) for name in names}
        self._draws = seeding.np_random()[0]

    def observation_space(self, agent: str) -> spaces.Space[Any]:
        """The space of an agent's observations."""
        return self.observation_spaces[agent]

    def action_space(self, agent: str) -> spaces.Space[Any]:
        """The space of an agent's actions."""
        return self.action_spaces[agent]

    def _seed(self, seed: Optional[int]) -> int:
        """The seed of the next trial: this one, or one that is drawn."""
        if seed is None:
            return int(self._draws.integers(2**31))
        self._draws = seeding.np_random(seed)[0]
        return seed

    def _stepped(self, seen: dict[str, Seen], reward: float, ends: tuple[bool, bool], infos: Infos) -> Step[Seen]:
        """What a step returns: the same reward and end for all."""
        rewards = dict.fromkeys(self.agents, reward)
        terminated, truncated = (dict.fromkeys(self.agents, end) for end in ends)
        if any(ends):
            self.agents = []
        return seen, rewards, terminated, truncated, infos

