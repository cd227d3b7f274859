"""Other methods on the problems of `xtask navigation`: ORCA as published (RVO2); ORCA, HRVO and HL of navground.

`just peers` runs it, in half an hour on two cores, and renews peers.csv beside this file, from which `xtask
navigation` has its column. The seconds behind ORCA (RVO2) are its time horizon.

A peer gets all that it needs to do well: the shortest way round the known walls, seen anew every 0.25 s, and
robots that change their velocity at once. This project's robots need half a second to reach their speed.
A robot has arrived within 0.15 m of its goal, as in this project. Flow and ok are counted as `navigation
--help` says, against the times that the same method needs for each robot alone.
"""

import csv
import json
import random
import sys
import time
from collections import defaultdict
from heapq import heappop, heappush
from multiprocessing import Pool

import numpy
import pyrvo
from navground import core, sim

STEP_S = 0.05
STEPS_A_LOOK = 5
ARRIVED_M = 0.15
OVERLAP_M = 0.01
# Routes keep this much more than a robot's radius from walls, and a robot that slid along a wall still sees.
SPARE_M = 0.02
# Perturbation of the wishes of RVO2's robots along each axis.
NOISE_MPS = 0.3


class Roadmap:
    """The corners of the walls, and the shortest ways from each of them to a goal."""

    def __init__(self, world):
        self.radius = world["radius_m"]
        self.walls = numpy.array(world["walls"], dtype=float).reshape(-1, 2, 2)
        size = numpy.array(world["size"])
        reach = self.radius + SPARE_M
        corners = [(low - reach, high + reach) for low, high in self.walls]
        places = [numpy.array((x, y)) for low, high in corners for x in (low[0], high[0])
                  for y in (low[1], high[1])]
        inside = [p for p in places if (p >= self.radius).all() and (p <= size - self.radius).all()]
        clear = [p for p in inside if self.depth(p[None], self.radius).max() <= 0]
        self.places = numpy.array(clear).reshape(-1, 2)
        self.sees = self.seen(self.places, self.places, self.radius + SPARE_M / 2)
        self.ways = {}

    def depth(self, points, radius):
        """How deep a disc round each point is in a wall; negative if it is clear."""
        if not len(self.walls):
            return numpy.full(len(points), -numpy.inf)
        nearest = points[:, None].clip(self.walls[None, :, 0], self.walls[None, :, 1])
        return radius - numpy.linalg.norm(points[:, None] - nearest, axis=2).min(axis=1)

    def seen(self, starts, ends, reach):
        """For each start and end, whether no wall that is larger by `reach` is between them."""
        seen = numpy.ones((len(starts), len(ends)), dtype=bool)
        for low, high in self.walls:
            way = ends[None] - starts[:, None]
            way = numpy.where(numpy.abs(way) < 1e-12, 1e-12, way)
            one, other = (low - reach - starts[:, None]) / way, (high + reach - starts[:, None]) / way
            enters = numpy.minimum(one, other).max(axis=2).clip(0)
            leaves = numpy.maximum(one, other).min(axis=2).clip(max=1)
            seen &= enters >= leaves - 1e-9
        return seen

    def lengths(self, goal):
        """Length of the shortest way from each place to the goal."""
        if goal not in self.ways:
            to = numpy.array([goal])
            seen = self.seen(self.places, to, self.radius - SPARE_M)[:, 0] if len(self.places) else []
            far = numpy.linalg.norm(self.places - to, axis=1)
            lengths = numpy.where(seen, far, numpy.inf) if len(self.places) else far
            queue = [(length, i) for i, length in enumerate(lengths) if numpy.isfinite(length)]
            queue.sort()
            while queue:
                length, i = heappop(queue)
                if length > lengths[i]:
                    continue
                for j in numpy.flatnonzero(self.sees[i]):
                    longer = length + numpy.linalg.norm(self.places[i] - self.places[j])
                    if longer < lengths[j] - 1e-12:
                        lengths[j] = longer
                        heappush(queue, (longer, j))
            self.ways[goal] = lengths
        return self.ways[goal]

    def next_places(self, positions, goals, last):
        """Where each robot should head for: the goal, or the corner on the shortest way to it."""
        reach = self.radius - SPARE_M
        ahead = list(last)
        sees_places = self.seen(positions, self.places, reach)
        for i, goal in enumerate(goals):
            here = positions[i : i + 1]
            if self.seen(here, numpy.array([goal]), reach)[0, 0]:
                ahead[i] = goal
            elif len(self.places):
                lengths = self.lengths(goal) + numpy.linalg.norm(self.places - here, axis=1)
                lengths = numpy.where(sees_places[i], lengths, numpy.inf)
                if numpy.isfinite(lengths.min()):
                    ahead[i] = tuple(self.places[lengths.argmin()])
        return ahead


class Rvo2:
    """ORCA by its authors' library. Wishes are perturbed, as in its examples, but more: weaker noise was much
    slower on circles and in doorways."""

    def __init__(self, world, starts, horizon_s):
        self.simulator = pyrvo.RVOSimulator()
        self.simulator.set_time_step(STEP_S)
        radius, self.speed = world["radius_m"], world["speed_mps"]
        self.simulator.set_agent_defaults(15.0, 10, horizon_s, horizon_s, radius + 0.01, self.speed)
        for start in starts:
            self.simulator.add_agent(tuple(start))
        width, height = world["size"]
        for (x, y), (right, top) in world["walls"]:
            self.simulator.add_obstacle([(x, y), (right, y), (right, top), (x, top)])
        self.simulator.add_obstacle([(0.0, 0.0), (0.0, height), (width, height), (width, 0.0)])
        self.simulator.process_obstacles()
        self.ahead, self.random = list(starts), random.Random(world["seed"])

    def head_for(self, ahead):
        self.ahead = ahead

    def step(self):
        for i, (x, y) in enumerate(self.ahead):
            at = self.simulator.get_agent_position(i)
            way = numpy.array((x - at.x, y - at.y))
            far = numpy.hypot(*way)
            wish = way / far * min(self.speed, far / STEP_S) if far > 1e-9 else way
            wish = wish + numpy.array([self.random.uniform(-NOISE_MPS, NOISE_MPS) for _ in "xy"])
            self.simulator.set_agent_pref_velocity(i, (float(wish[0]), float(wish[1])))
        begun = time.perf_counter()
        self.simulator.do_step()
        return time.perf_counter() - begun

    def positions(self):
        places = (self.simulator.get_agent_position(i) for i in range(len(self.ahead)))
        return numpy.array([(place.x, place.y) for place in places])


class Navground:
    """A behaviour of navground with its own defaults, all robots within 10 m as neighbours."""

    def __init__(self, world, starts, behavior):
        self.world = sim.World()
        self.world.seed = world["seed"]
        width, height = world["size"]
        corners = [(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)]
        outlines = [corners]
        for (x, y), (right, top) in world["walls"]:
            outlines.append([(x, y), (right, y), (right, top), (x, top)])
        for outline in outlines:
            for a, b in zip(outline, outline[1:] + outline[:1]):
                self.world.add_wall(sim.Wall(core.LineSegment(a, b)))
        speed, radius = world["speed_mps"], world["radius_m"]
        for start in starts:
            way = core.Behavior.make_type(behavior)
            way.kinematics = core.kinematics.OmnidirectionalKinematics(speed)
            way.radius, way.optimal_speed, way.horizon, way.safety_margin = radius, speed, 10.0, 0.01
            seen = sim.state_estimations.BoundedStateEstimation(range=10.0)
            agent = sim.Agent(radius, way, way.kinematics, state_estimations=[seen])
            agent.position = tuple(start)
            self.world.add_agent(agent)
        self.ahead = None

    def head_for(self, ahead):
        if self.ahead is None:
            self.ahead = [None] * len(ahead)
        for agent, place, last in zip(self.world.agents, ahead, self.ahead):
            if place != last:
                agent.behavior.target = core.Target.Point(place, 0.01)
        self.ahead = list(ahead)

    def step(self):
        begun = time.perf_counter()
        self.world.update(STEP_S)
        return time.perf_counter() - begun

    def positions(self):
        return numpy.array([tuple(agent.position) for agent in self.world.agents])


METHODS = {
    "ORCA (RVO2; 3 s)": lambda world, starts: Rvo2(world, starts, 3.0),
    "ORCA (RVO2; 1.5 s)": lambda world, starts: Rvo2(world, starts, 1.5),
    "ORCA (navground)": lambda world, starts: Navground(world, starts, "ORCA"),
    "HRVO (navground)": lambda world, starts: Navground(world, starts, "HRVO"),
    "HL (navground)": lambda world, starts: Navground(world, starts, "HL"),
}


def drive(method, world, roadmap, robots, limit_s):
    """Arrival time or None of each robot with a goal, the deepest overlap, and seconds of computing per step of
    a robot."""
    starts = [tuple(robot["start"]) for robot in robots]
    goals = [tuple(robot["goal"] or robot["start"]) for robot in robots]
    peer = METHODS[method](world, starts)
    arrivals = [None if robot["goal"] else 0.0 for robot in robots]
    positions, ahead, deepest, clock, steps = numpy.array(starts), list(starts), 0.0, 0.0, 0
    apart = 2 * world["radius_m"]
    while steps * STEP_S < limit_s and None in arrivals:
        if steps % STEPS_A_LOOK == 0:
            ahead = roadmap.next_places(positions, goals, ahead)
            peer.head_for(ahead)
        clock += peer.step()
        steps += 1
        positions = peer.positions()
        gaps = numpy.linalg.norm(positions[:, None] - positions[None], axis=2)
        numpy.fill_diagonal(gaps, numpy.inf)
        deepest = max(deepest, apart - gaps.min(), roadmap.depth(positions, apart / 2).max())
        for i, goal in enumerate(goals):
            if arrivals[i] is None and numpy.hypot(*(positions[i] - goal)) <= ARRIVED_M:
                arrivals[i] = steps * STEP_S
    times = [time for time, robot in zip(arrivals, robots) if robot["goal"]]
    return times, deepest, clock / (steps * len(robots))


def trial(job):
    """Flow, whether all arrived without an overlap, and seconds of computing per step of a robot."""
    method, world = job
    roadmap = Roadmap(world)
    going = [robot for robot in world["robots"] if robot["goal"]]
    free = [drive(method, world, roadmap, [robot], 600.0)[0][0] for robot in going]
    if None in free:
        raise SystemExit(f"{method}: {world['problem']}, seed {world['seed']}: a lone robot does not arrive")
    limit_s = 5 * max(free) + 30
    times, deepest, step_s = drive(method, world, roadmap, world["robots"], limit_s)
    flow = sum(limit_s if arrival is None else arrival for arrival in times) / sum(free)
    return flow, None not in times and deepest <= OVERLAP_M, step_s


def main(worlds_file, table_file):
    with open(worlds_file) as file:
        worlds = [json.loads(line) for line in file]
    problems = defaultdict(list)
    for world in worlds:
        problems[world["problem"]].append(world)
    with Pool() as pool, open(table_file, "w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["problem", "method", "seeds", "flow", "ok_percent", "step_us"])
        for problem, instances in problems.items():
            for method in METHODS:
                results = pool.map(trial, [(method, world) for world in instances], chunksize=1)
                flow, ok, step_s = (sum(column) / len(results) for column in zip(*results))
                row = [problem, method, len(results), f"{flow:.3f}", f"{100 * ok:.0f}", f"{1e6 * step_s:.1f}"]
                table.writerow(row)
                file.flush()
                print(*row, sep="\t", flush=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
