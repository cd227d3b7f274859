"""Records of trials."""

from __future__ import annotations

import re
from typing import Any


class Record:
    """What happened in a trial.

    `fields` has all of it, as `usar run --json` prints it.

    >>> import usar
    >>> record = usar.run(usar.Scenario.builtin("paper").set(duration_s=120), seed=1)
    >>> record.rescued, [task["task"] for task in record.tasks]
    (40, ['hard', 'easy'])
    """

    def __init__(self, fields: dict[str, Any]) -> None:
        self.fields = fields

    @property
    def policy(self) -> str:
        """Label of the policy."""
        return str(self.fields["policy"])

    @property
    def seed(self) -> int:
        """Seed of the trial."""
        return int(self.fields["seed"])

    @property
    def status(self) -> str:
        """How the trial ended: `completed`, `nobody_can_carry`, `finished` or `stalled`."""
        return re.sub(r"(?<!^)(?=[A-Z])", "_", self.fields["status"]).lower()

    @property
    def time_s(self) -> float:
        """Simulated time at the end, in seconds."""
        return float(self.fields["time_s"])

    @property
    def rescued(self) -> int:
        """Rescuees delivered, all tasks."""
        return int(self.fields["rescuees"])

    @property
    def tasks(self) -> list[dict[str, Any]]:
        """Results and costs of each task."""
        return list(self.fields["tasks"])

    @property
    def rounds(self) -> list[dict[str, Any]]:
        """Results and costs of each group in each round."""
        return list(self.fields["rounds"])

    @property
    def robots(self) -> list[dict[str, Any]]:
        """Each robot at the end, with its sums."""
        return list(self.fields["robots"])

    @property
    def decisions(self) -> list[dict[str, Any]]:
        """Each question with its answer, and the truth where it differs from what was said."""
        return list(self.fields["decisions"])

    @property
    def state_hash(self) -> str:
        """Hash of every state of the trial: equal for equal trials, bit for bit."""
        return str(self.fields["state_hash"])

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Record) and self.fields == other.fields

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return f"<usar.Record of {self.policy}, seed {self.seed}: {self.rescued} rescued, {self.status}>"
