"""Learn who goes to the harder tasks, with numpy alone, and put it to the test on trials it never saw.

A policy is a weight for each feature of a robot. The robots of a role are ranked by their weighted sum, and
the upper ones wish the harder tasks. The cross-entropy method finds weights: it draws 16 from a normal
distribution, plays each on the same four trials, and moves the distribution to the best four.

    python python/examples/learn.py tunnel --generations 16
"""

from __future__ import annotations

import argparse
import csv
import json
from pathlib import Path
from typing import Any

import numpy

import usar
import usar.env

DRAWN, ELITE, SEEDS = 16, 4, 4
FIRST_SEED = 1_000_000  # trials of the test begin at 1


def wishes(strengths: Any, roles: Any, is_asked: Any, hardest_first: list[int]) -> Any:
    """For each robot a task: the strongest of each role the hardest one, in parts as equal as can be."""
    wished = numpy.zeros(len(strengths), int)
    for role in numpy.unique(roles):
        ids = numpy.flatnonzero((roles == role) & is_asked)
        ranked = ids[numpy.argsort(-strengths[ids], kind="stable")]
        for task, part in zip(hardest_first, numpy.array_split(ranked, len(hardest_first))):
            wished[part] = task
    return wished


class Learned:
    """The learned policy, for whole trials."""

    name = "learned"

    def __init__(self, weights: Any) -> None:
        self.weights = numpy.array(weights)

    def decide(self, question: Any) -> list[list[int]]:
        """Groups by rank."""
        members = question["members"]
        needs = numpy.array([member["needs"] for member in members])
        levels = numpy.array([member["levels"] for member in members]) / 100
        features = numpy.hstack([levels, needs / numpy.where(needs.max(axis=0) > 0, needs.max(axis=0), 1)])
        # As 32-bit numbers, which environments observe.
        strengths = features.clip(0, 1).astype(numpy.float32) @ self.weights
        order = sorted(range(len(question["tasks"])), key=lambda task: -question["tasks"][task]["difficulty"])
        roles = numpy.array([member["role"] for member in members])
        wished = wishes(strengths, roles, numpy.ones(len(members), bool), order)
        by_id = {member["id"]: int(task) for member, task in zip(members, wished)}
        return usar.env.settled(question, by_id)[0]


def play(many: usar.env.Vector, weights: Any, seeds: list[int]) -> Any:
    """Rescuees of a trial for each of the weights."""
    seen, _ = many.reset(seed=seeds)
    robots, tasks = many.single_observation_space["action_mask"].shape  # type: ignore[index]
    names = many.feature_names
    known = ("robot_0_energy", "robot_0_hp", "robot_0_need_")
    columns = [at for at, name in enumerate(names) if name.startswith(known)]
    of_role = [at for at, name in enumerate(names) if name.startswith("robot_0_role_")]
    own = sum(name.startswith("robot_0_") for name in names)
    ranks = [at for at, name in enumerate(names) if name.endswith("_difficulty")]
    rescued, is_over = numpy.zeros(len(weights)), numpy.zeros(len(weights), bool)
    while not is_over.all():
        actions = []
        for values, one in zip(seen["observation"], weights):
            rows = values[: robots * own].reshape(robots, own)
            order = sorted(range(tasks), key=lambda task: -values[ranks[task]])
            actions.append(wishes(rows[:, columns] @ one, rows[:, of_role].argmax(axis=1), rows[:, 0] > 0, order))
        seen, rewards, terminated, truncated, _ = many.step(numpy.array(actions))
        rescued += rewards * ~is_over
        is_over |= terminated | truncated
    return rescued


def learn(world: str, generations: int, seed: int) -> tuple[Any, list[list[float]]]:
    """Weights, and for each generation the mean of all that were drawn, and of the elite."""
    many = usar.env.vector(usar.Scenario.builtin(world), DRAWN * SEEDS)
    size = 2 + sum(name.startswith("robot_0_need_") for name in many.feature_names)
    draws = numpy.random.default_rng(seed)
    mean, spread = numpy.zeros(size), numpy.ones(size)
    curve: list[list[float]] = []
    for _ in range(generations):
        weights = draws.normal(mean, spread, (DRAWN, size))
        first = FIRST_SEED + SEEDS * len(curve)
        played = play(many, weights.repeat(SEEDS, axis=0), list(range(first, first + SEEDS)) * DRAWN)
        rescued = played.reshape(DRAWN, SEEDS).mean(axis=1)
        best = numpy.argsort(-rescued, kind="stable")[:ELITE]
        mean = weights[best].mean(axis=0)
        spread = 0.7 * weights[best].std(axis=0) + 0.3 * spread
        curve.append([rescued.mean(), rescued[best].mean()])
        print(f"{rescued.mean():.1f} rescued, the best four {rescued[best].mean():.1f}", flush=True)
    return mean, curve


def main() -> None:
    """Learn, write the curve and the weights, and compare."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("world", help="name of a scenario")
    parser.add_argument("--generations", type=int, default=16, help="generations of 64 trials to learn from")
    parser.add_argument("--seed", type=int, default=1, help="seed of the learner")
    parser.add_argument("--trials", type=int, default=200, help="trials of the test")
    parser.add_argument("--out", type=Path, default=Path("results/learned"), help="folder to write")
    options = parser.parse_args()
    weights, curve = learn(options.world, options.generations, options.seed)
    options.out.mkdir(parents=True, exist_ok=True)
    with (options.out / "curve.csv").open("w", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([["drawn", "elite"], *curve])
    (options.out / "weights.json").write_text(json.dumps(list(weights)) + "\n")
    against = ["RANDOM", "ENG", "HP_DIS", "DIS", "RNE"]
    results = usar.sweep(options.world, [Learned(weights), *against], options.trials, out=options.out / "test")
    for one in usar.compare(results, ["rescuees.total"], baseline="learned"):
        print(one["in_words"])


if __name__ == "__main__":
    main()
