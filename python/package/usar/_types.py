"""What policies are asked and answer. The fields are those of docs/schemas/question.schema.json."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, Callable, Optional, Protocol, TypedDict, Union


class Need(TypedDict):
    """A need that members report."""

    name: str
    weight: float


class Expected(TypedDict):
    """What is expected of a level."""

    mean: float
    sd: float


class Level(TypedDict):
    """A level that robots have: `energy` or `hp`, in percent."""

    name: str
    unit: str
    threshold: float
    expected: Optional[Expected]


class Task(TypedDict):
    """A task that a group is to be formed for."""

    name: str
    difficulty: int
    place: Optional[Sequence[float]]
    rescuees: Optional[int]
    value: Optional[float]
    requires: dict[str, float]
    duration_s: Optional[float]
    after: list[int]


class Quota(TypedDict):
    """How many members of a role each task gets: `Binding`, as sizes of `Parts`, or `Free`."""

    members: list[int]
    sizes: str


class Member(TypedDict):
    """What a robot reports of itself."""

    id: int
    role: int
    home: Sequence[float]
    needs: list[float]
    levels: list[Optional[float]]


class _Question(TypedDict):
    schema_version: int
    round: int
    roles: list[str]
    needs: list[Need]
    levels: list[Level]
    rest: str
    tasks: list[Task]
    quotas: list[Quota]
    members: list[Member]
    may_idle: bool
    history: list[dict[str, Any]]
    random_seed: str


class Question(_Question, total=False):
    """How is the team to be grouped? `evidence` is there in worlds that go by reports, `asker` where a robot asks."""

    asker: int
    evidence: dict[str, Any]


class Answer(TypedDict, total=False):
    """Groups, and the robots that stay at home where the question allows it."""

    groups: Iterable[Iterable[int]]
    idle: Iterable[int]


Groups = Union[Iterable[Optional[Iterable[int]]], Answer]
"""For each task, the ids of its group."""


class Decides(Protocol):
    """A policy with a method `decide`. May have `name`, `version` and `deterministic` as well.

    With a method `act`, from the turns of robots that decide for themselves to what they do, it is a protocol, too.
    """

    def decide(self, question: Question, /) -> Groups: ...


Policy = Union[str, Callable[[Question], Groups], Decides]
"""A name as on the command line, a function, or an object."""
