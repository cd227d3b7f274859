"""Fixtures."""

from __future__ import annotations

import os
import random
import subprocess
import sys
from typing import Any, Callable

import pytest

import usar


def command(*words: str) -> str:
    """What the command of the workspace prints, or that of the package without `USAR`."""
    program = [os.environ["USAR"]] if "USAR" in os.environ else [sys.executable, "-m", "usar"]
    return subprocess.run([*program, *words], check=True, capture_output=True, text=True).stdout


@pytest.fixture
def usar_command() -> Callable[..., str]:
    return command


@pytest.fixture
def short() -> usar.Scenario:
    """Two minutes of the paper's mission."""
    return usar.Scenario.builtin("paper").set(duration_s=120)


def eng(question: Any) -> list[list[int]]:
    """ENG: per role, the robots with more energy take the harder tasks."""
    groups: list[list[int]] = [[] for _ in question["tasks"]]
    order = sorted(range(len(groups)), key=lambda task: -question["tasks"][task]["difficulty"])
    for role, quota in enumerate(question["quotas"]):
        members = [member for member in question["members"] if member["role"] == role]
        members.sort(key=lambda member: (-member["levels"][0], member["id"]))
        parts = iter(quota["members"] if quota["sizes"] == "Binding" else sorted(quota["members"], reverse=True))
        sizes = quota["members"] if quota["sizes"] == "Binding" else None
        for task in order:
            size = sizes[task] if sizes else next(parts)
            groups[task] += [member["id"] for member in members[:size]]
            members = members[size:]
    return groups


def random_question(seed: int) -> Any:
    """A team of up to four roles and four tasks."""
    draws = random.Random(seed)
    tasks = draws.randint(1, 4)
    members, quotas = [], []
    roles = draws.randint(1, 4)
    ids = draws.sample(range(100), 24)
    for role in range(roles):
        count = draws.randint(1 if role == 0 else 0, 6)
        for _ in range(count):
            members.append(
                {
                    "id": ids.pop(),
                    "role": role,
                    "home": [draws.uniform(0, 9), draws.uniform(0, 9)],
                    "needs": [draws.uniform(0, 9)],
                    "levels": [draws.choice([50.0, draws.uniform(0, 100)]), draws.uniform(0, 100)],
                }
            )
        split = sorted(draws.randint(0, count) for _ in range(tasks - 1))
        sizes = [upper - lower for lower, upper in zip([0, *split], [*split, count])]
        quotas.append({"members": sizes, "sizes": "Binding"})
    return {
        "schema_version": 3,
        "round": 1,
        "roles": [f"role {role}" for role in range(roles)],
        "needs": [{"name": "energy", "weight": 1.0}],
        "levels": [{"name": name, "unit": "%", "threshold": 30.0, "expected": None} for name in ("energy", "hp")],
        "rest": "All",
        "tasks": [{"name": f"task {task}", "difficulty": draws.randint(1, 3)} for task in range(tasks)],
        "quotas": quotas,
        "members": sorted(members, key=lambda member: member["id"]),
        "may_idle": False,
        "history": [],
        "random_seed": f"{seed:064x}",
    }

