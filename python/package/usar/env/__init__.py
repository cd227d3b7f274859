"""Environments for learning.

`Robots` (PettingZoo, `usar_robots_v0`) and `Coordinator` (Gymnasium, `usar/Coordinator-v0`) decide who goes
to which task: one step is one decision. `vector` is many coordinators on threads. `Velocities` (PettingZoo)
drives the robots. The page docs/learning.md says what they observe and how actions become groups.
"""

from gymnasium.envs.registration import register

from ._coordinator import Coordinator, Vector, vector
from ._groups import settled
from ._robots import Robots
from ._velocities import Velocities

__all__ = ["Coordinator", "Robots", "Vector", "Velocities", "settled", "vector"]

register(id="usar/Coordinator-v0", entry_point="usar.env:Coordinator")
