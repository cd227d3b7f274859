"""Each robot is an agent that chooses its velocity (PettingZoo)."""

from __future__ import annotations

from typing import Any, Optional

import numpy
import numpy.typing
from gymnasium import spaces

from .._types import Policy
from .._usar import Scenario, Simulation, group
from ._agents import Agents, Infos, Step
from ._view import agents, first_question

Array = numpy.typing.NDArray[numpy.float32]
NEAREST = 5


class Velocities(Agents[Array, Array]):
    """Robots driven at `hz`, on the physics of the simulator.

    Robots decide on their velocities 10 times a second, unless the scenario says otherwise
    (`control_period_s`). `hz` is that rate if it is not given, and must divide it.

    An action is a velocity in shares of the top speed, in the plane. The mission goes on as always: `policy`
    groups the team, robots have goals and load and deliver when they get there; only the way there is the
    agents'. Right of way applies as the scenario says: `conflicts.resolver: None` is none, every other rule
    is a filter between actions and motion. All get as reward what the team rescued since the last step.

    An observation is, in shares of the arena: place, velocity (of the top speed), the vector to the next
    point of the route, energy and HP, and the vectors to the five nearest robots.
    """

    metadata: dict[str, Any] = {"name": "usar_velocities_v0", "render_modes": []}

    def __init__(self, scenario: Scenario, policy: Policy = "DIS", hz: Optional[float] = None) -> None:
        self._scenario, self._policy, self._hz = scenario, policy, hz
        self._trial, self._steps = self._begin(1)
        near = [f"near_{at}_{axis}" for at in range(NEAREST) for axis in "xy"]
        self.feature_names = ["x", "y", "vx", "vy", "way_x", "way_y", "energy", "hp", *near]
        seen = spaces.Box(-1.0, 1.0, (len(self.feature_names),), numpy.float32)
        names = agents(scenario, first_question(scenario))
        super().__init__(names, seen, spaces.Box(-1.0, 1.0, (2,), numpy.float32))

    def reset(
        self, seed: Optional[int] = None, options: Optional[dict[str, Any]] = None
    ) -> tuple[dict[str, Array], Infos]:
        """Begin the trial of a seed, or of one that is drawn."""
        self._trial, self._steps = self._begin(self._seed(seed))
        self._trial.until_asked()
        self._answer()
        self.agents = self.possible_agents[:]
        return self._observations(), {agent: {} for agent in self.agents}

    def step(self, actions: dict[str, Array]) -> Step[Array]:
        """Drive for a period."""
        trial = self._trial
        wishes = numpy.array([actions[agent] for agent in self.possible_agents], numpy.float32)
        trial.steer(wishes * trial.top_speeds[:, None])
        before, left = trial.totals[0], self._steps
        while left > 0 and trial.status is None:
            left -= trial.step(left)
            self._answer()
        ends = trial.status not in (None, "completed"), trial.status == "completed"
        infos: Infos = {agent: {} for agent in self.agents}
        return self._stepped(self._observations(), float(trial.totals[0] - before), ends, infos)

    def _begin(self, seed: int) -> tuple[Simulation, int]:
        """A trial, and the steps of a period. A period is a number of times that robots decide."""
        trial = Simulation(self._scenario, seed)
        most = 1.0 / trial.control_period_s
        hz = most if self._hz is None else self._hz
        if not hz >= 1.0 / self._scenario.duration_s:
            raise ValueError(f"hz must be at least 1 / duration_s, found {hz:g}")
        times = max(1, round(most / hz))
        if abs(most / hz - times) > 1e-5 * times:
            below = int(most / hz)
            near = " or ".join(f"{most / count:g}" for count in sorted({max(1, below), below + 1}))
            found = f"found {hz:g}; nearby is {near}"
            raise ValueError(f"hz must be {most:g}, at which robots decide, or divide it, {found}")
        return trial, round(times * trial.control_period_s / self._scenario.step_s)

    def _answer(self) -> None:
        """Answer the question that waits, if there is one."""
        question = self._trial.question
        if question is not None:
            self._trial.assign(group(question, self._policy))

    def _observations(self) -> dict[str, Array]:
        trial, arena = self._trial, numpy.array(self._scenario.arena, numpy.float32)
        places, speeds = trial.positions, numpy.maximum(trial.top_speeds, 1e-6)[:, None]
        apart = (places[None] - places[:, None]) / arena
        order = numpy.argsort((apart**2).sum(axis=2), axis=1, kind="stable")[:, 1 : NEAREST + 1]
        near = numpy.take_along_axis(apart, order[:, :, None], axis=1)
        padded = numpy.zeros((len(places), NEAREST, 2), numpy.float32)
        padded[:, : near.shape[1]] = near
        parts = [
            2.0 * places / arena - 1.0,
            trial.velocities / speeds,
            (trial.waypoints - places) / arena,
            trial.levels / 100.0,
            padded.reshape(len(places), -1),
        ]
        rows = numpy.concatenate(parts, axis=1, dtype=numpy.float32, casting="same_kind").clip(-1.0, 1.0)
        return dict(zip(self.possible_agents, rows))
