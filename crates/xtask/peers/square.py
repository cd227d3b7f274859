"""ORCA by its authors' library (RVO2, through pyrvo) on the random squares of `xtask movement`.

`just peers` runs it and renews square.csv beside this file, from which `xtask movement` has its rows. The
seconds behind ORCA are its time horizon. Agents change their velocity at once, and are drawn 1 cm larger than
they are, so that they do not touch. All else is counted as `xtask movement` counts it: an agent has arrived
within 0.15 m of its goal, a case ends after five times the longest straight way and half a minute.
"""

import csv
import json
import sys
from collections import defaultdict

import numpy
import pyrvo

STEP_S = 0.05
ARRIVED_M = 0.15
SPARE_M = 0.01
HORIZONS_S = [1.5, 3.0]


def run(agents, horizon_s):
    """Whether two agents touched, whether one did not arrive, and the mean extra time."""
    simulator = pyrvo.RVOSimulator()
    simulator.set_time_step(STEP_S)
    simulator.set_agent_defaults(15.0, 10, horizon_s, horizon_s, 0.5, 1.2)
    for i, agent in enumerate(agents):
        simulator.add_agent(tuple(agent["start"]))
        simulator.set_agent_radius(i, agent["radius_m"] + SPARE_M)
        simulator.set_agent_max_speed(i, agent["speed_mps"])
    goals = numpy.array([agent["goal"] for agent in agents])
    radii = numpy.array([agent["radius_m"] for agent in agents])
    speeds = numpy.array([agent["speed_mps"] for agent in agents])
    starts = numpy.array([agent["start"] for agent in agents])
    straight = numpy.linalg.norm(goals - starts, axis=1) / speeds
    arrivals = numpy.full(len(agents), numpy.nan)
    least = radii[:, None] + radii[None]
    touched = False
    for step in range(int((5.0 * straight.max() + 30.0) / STEP_S)):
        places = [simulator.get_agent_position(i) for i in range(len(agents))]
        positions = numpy.array([(place.x, place.y) for place in places])
        apart = numpy.linalg.norm(positions[:, None] - positions[None], axis=2)
        touched |= bool((apart < least)[numpy.triu_indices(len(agents), 1)].any())
        far = numpy.linalg.norm(goals - positions, axis=1)
        arrivals[numpy.isnan(arrivals) & (far <= ARRIVED_M)] = step * STEP_S
        if not numpy.isnan(arrivals).any():
            break
        for i, way in enumerate(goals - positions):
            wish = way / max(far[i], 1e-9) * min(speeds[i], far[i] / STEP_S)
            simulator.set_agent_pref_velocity(i, (float(wish[0]), float(wish[1])))
        simulator.do_step()
    return touched, bool(numpy.isnan(arrivals).any()), float((arrivals - straight).mean())


def main(worlds, out):
    outcomes = defaultdict(list)
    with open(worlds, encoding="utf-8") as lines:
        for line in lines:
            agents = json.loads(line)["agents"]
            for horizon_s in HORIZONS_S:
                alone = [run([agent], horizon_s)[2] for agent in agents]
                outcomes[horizon_s, len(agents)].append((*run(agents, horizon_s), numpy.mean(alone)))
    with open(out, "w", encoding="utf-8", newline="") as file:
        rows = csv.writer(file, lineterminator="\n")
        counts, times = ["cases", "touched", "stuck"], ["extra_s", "p75_s", "p90_s", "alone_s"]
        rows.writerow(["method", "agents", *counts, *times])
        for (horizon_s, agents), cases in sorted(outcomes.items()):
            good = [case[2] for case in cases if not case[0] and not case[1]]
            touched, stuck = (sum(case[k] for case in cases) for k in (0, 1))
            alone = numpy.mean([case[3] for case in cases])
            numbers = [numpy.mean(good), numpy.percentile(good, 75), numpy.percentile(good, 90), alone]
            numbers = [f"{number:.3f}" for number in numbers]
            rows.writerow([f"ORCA (RVO2; {horizon_s:g} s)", agents, len(cases), touched, stuck, *numbers])


main(*sys.argv[1:])
