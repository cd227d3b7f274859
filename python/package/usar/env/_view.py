"""What an environment observes of a question, as numbers from 0 to 1."""

from __future__ import annotations

from typing import Optional

import numpy
import numpy.typing

from .._types import Question
from .._usar import Scenario, Simulation

Features = numpy.typing.NDArray[numpy.float32]


def first_question(scenario: Scenario) -> Question:
    """The first question of a trial."""
    question = Simulation(scenario, 1).until_asked()
    if question is None:
        raise ValueError(f"{scenario.name}: its trials ask no question, so that there is nothing to decide")
    return question


def agents(scenario: Scenario, question: Question) -> list[str]:
    """A name for each robot, by role and id."""
    names = {member["id"]: f"{question['roles'][member['role']]}_{member['id']}" for member in question["members"]}
    if sorted(names) != list(range(scenario.robots)):
        raise ValueError(
            f"{scenario.name}: an environment needs a team of one size, all of which is asked at first; found "
            f"{len(names)} of at most {scenario.robots} robots in the trial of seed 1"
        )
    return [names[robot] for robot in range(scenario.robots)]


class View:
    """Names and values of the features of one scenario."""

    def __init__(self, scenario: Scenario) -> None:
        question = first_question(scenario)
        self.scenario = scenario
        self.arena = numpy.array(scenario.arena, numpy.float32)
        self.robots = scenario.robots
        self.tasks = len(question["tasks"])
        self.roles = question["roles"]
        self.agents = agents(scenario, question)
        self.needs = [need["name"] for need in question["needs"]]
        self.own_names = (
            ["is_asked", "energy", "hp", "home_x", "home_y"]
            + [f"role_{role}" for role in self.roles]
            + [f"need_{need}" for need in self.needs]
        )
        self.shared_names = ["time"] + [
            f"{task['name']}_{what}" for task in question["tasks"] for what in ("difficulty", "x", "y", "waiting")
        ]

    def own(self, question: Optional[Question]) -> Features:
        """A row for each robot by its id: what it reports. Needs are shares of the largest one in the team."""
        rows = numpy.zeros((self.robots, len(self.own_names)), numpy.float32)
        if question is None:
            return rows
        members = question["members"]
        ids = [member["id"] for member in members]
        needs = numpy.array([member["needs"] for member in members], numpy.float64)
        largest = needs.max(axis=0)
        rows[ids, 0] = 1.0
        names = [level["name"] for level in question["levels"]]
        for column, level in enumerate(["energy", "hp"], 1):
            at = names.index(level)
            rows[ids, column] = [(member["levels"][at] or 0.0) / 100.0 for member in members]
        rows[ids, 3:5] = numpy.array([member["home"] for member in members]) / self.arena
        rows[ids, [5 + member["role"] for member in members]] = 1.0
        rows[ids, 5 + len(self.roles) :] = needs / numpy.where(largest > 0.0, largest, 1.0)
        return rows.clip(0.0, 1.0)

    def shared(self, question: Optional[Question], time_s: float) -> Features:
        """The time that is over, and each task: its rank, its place, and the share of what waits there."""
        values = numpy.zeros(len(self.shared_names), numpy.float32)
        values[0] = time_s / self.scenario.duration_s
        if question is not None:
            ranks = sorted({task["difficulty"] for task in question["tasks"]})
            waiting = [task["rescuees"] or 0 for task in question["tasks"]]
            for at, (task, count) in enumerate(zip(question["tasks"], waiting)):
                place = task["place"]
                x, y = (0.0, 0.0) if place is None else numpy.array(place) / self.arena
                rank = (ranks.index(task["difficulty"]) + 1) / len(ranks)
                values[1 + 4 * at : 5 + 4 * at] = rank, x, y, count / max(1, sum(waiting))
        return values.clip(0.0, 1.0)

    def mask(self, question: Optional[Question]) -> numpy.typing.NDArray[numpy.int8]:
        """For each robot, the tasks that it may wish: all, or none where it is not asked."""
        mask = numpy.zeros((self.robots, self.tasks), numpy.int8)
        if question is not None:
            mask[[member["id"] for member in question["members"]]] = 1
        return mask
