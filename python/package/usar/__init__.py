"""Simulate mixed robot teams that must decide whom to trust and whom to team up with.

>>> import usar
>>> paper = usar.Scenario.builtin("paper").set(duration_s=60)
>>> usar.run(paper, policy="DIS", seed=1)
<usar.Record of DIS, seed 1: 20 rescued, completed>

A policy is a name as on the command line, a function from a question to groups, or an object with a
method `decide`. The page docs/python.md is a tutorial.
"""

from ._records import Record
from ._results import Results, compare, report, sweep
from ._usar import PolicyError, Scenario, ScenarioError, Simulation, group, rne, run

__all__ = [
    "PolicyError",
    "Record",
    "Results",
    "Scenario",
    "ScenarioError",
    "Simulation",
    "compare",
    "group",
    "report",
    "rne",
    "run",
    "sweep",
]
__version__ = "0.1.0"
