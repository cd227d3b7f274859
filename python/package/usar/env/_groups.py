"""From wishes to groups of the sizes that a question asks for."""

from __future__ import annotations

from collections.abc import Mapping

from .._types import Question


def settled(question: Question, wishes: Mapping[int, int]) -> tuple[list[list[int]], list[int]]:
    """Groups by the task that each member wishes, and the ids of the members that had to be moved.

    Role by role: where the sizes are `Parts`, the tasks get those parts for which fewest robots move (of
    several, the first in the order of the question); where they are `Free`, every wish is kept. A task with
    too many members gives up those with the highest ids, and the first task with too few takes them.

    >>> question = {"tasks": [{}, {}], "quotas": [{"members": [1, 2], "sizes": "Binding"}],
    ...     "members": [{"id": id, "role": 0} for id in range(3)]}
    >>> settled(question, {0: 0, 1: 0, 2: 0})
    ([[0], [1, 2]], [1, 2])
    """
    groups: list[list[int]] = [[] for _ in question["tasks"]]
    moved: list[int] = []
    for role, quota in enumerate(question["quotas"]):
        ids = [member["id"] for member in question["members"] if member["role"] == role]
        of_role: list[list[int]] = [[] for _ in groups]
        for robot in sorted(ids):
            of_role[wishes[robot]].append(robot)
        sizes = _sizes(quota["sizes"], quota["members"], [len(wished) for wished in of_role])
        over = [robot for wished, size in zip(of_role, sizes) for robot in wished[size:]]
        for group, wished, size in zip(groups, of_role, sizes):
            kept = wished[:size]
            taken, over = (over[: size - len(kept)], over[size - len(kept) :])
            moved += taken
            group += kept + taken
    return [sorted(group) for group in groups], sorted(moved)


def _sizes(rule: str, members: list[int], wished: list[int]) -> list[int]:
    if rule == "Free":
        return wished
    if rule == "Binding" or wished == members:
        return members
    left, sizes = members.copy(), []
    for task in range(len(wished)):
        sizes.append(min(left, key=lambda size: _fewest_moves(wished[task:], left, size)))
        left.remove(sizes[-1])
    return sizes


def _fewest_moves(wished: list[int], parts: list[int], first: int) -> int:
    """The moves if the first task gets this part: larger parts go where more robots wish to be."""
    others = sorted(parts)
    others.remove(first)
    pairs = [(wished[0], first), *zip(sorted(wished[1:]), others)]
    return sum(max(0, has - size) for has, size in pairs)
