"""Microseconds of a step of other public libraries, with as many robots as `just bench` has: RVO2's step, navground's, Box2D's and
VMAS's. `just bench-peers` runs both in the same minute.

Robots of 0.25 m drive at 1 m/s to random goals in a square of 133 m2 a robot; where the library has obstacles (Box2D), with 5 boxes a
robot. None of them plans routes, senses, spends energy or has a mission: a step of theirs is the motion alone.
"""

import math
import random
import statistics
import time

import pyrvo
from navground import core, sim

TURNS, STEPS = 5, 100
RADIUS_M, SPEED_MPS, STEP_S = 0.25, 1.0, 0.02


def side(robots):
    return 40 * math.sqrt(robots / 12)


def place(draws, robots):
    return draws.uniform(1, side(robots) - 1), draws.uniform(1, side(robots) - 1)


def rvo2(robots):
    draws, simulator = random.Random(robots), pyrvo.RVOSimulator()
    simulator.set_time_step(STEP_S)
    simulator.set_agent_defaults(10.0, 12, 1.5, 0.5, RADIUS_M, SPEED_MPS)
    for i in range(robots):
        simulator.add_agent(place(draws, robots))
        angle = draws.uniform(0, 2 * math.pi)
        simulator.set_agent_pref_velocity(i, (SPEED_MPS * math.cos(angle), SPEED_MPS * math.sin(angle)))
    return simulator.do_step


def navground(robots):
    draws, world = random.Random(robots), sim.World()
    for _ in range(robots):
        way = core.Behavior.make_type("ORCA")
        way.kinematics = core.kinematics.OmnidirectionalKinematics(SPEED_MPS)
        way.radius, way.optimal_speed = RADIUS_M, SPEED_MPS
        seen = sim.state_estimations.BoundedStateEstimation(range=10.0)
        agent = sim.Agent(RADIUS_M, way, way.kinematics, state_estimations=[seen])
        agent.position = place(draws, robots)
        world.add_agent(agent)
        way.target = core.Target.Point(place(draws, robots), 0.1)
    return lambda: world.update(STEP_S)


def box2d(robots):
    from Box2D import b2CircleShape, b2FixtureDef, b2PolygonShape, b2World

    draws, world = random.Random(robots), b2World(gravity=(0, 0), doSleep=True)
    for _ in range(5 * robots):
        half = draws.uniform(0.4, 1.2), draws.uniform(0.4, 1.2)
        world.CreateStaticBody(position=place(draws, robots), shapes=b2PolygonShape(box=half))
    for _ in range(robots):
        disc = b2FixtureDef(shape=b2CircleShape(radius=RADIUS_M), density=1.0)
        body = world.CreateDynamicBody(position=place(draws, robots), fixtures=disc, fixedRotation=True)
        angle = draws.uniform(0, 2 * math.pi)
        body.linearVelocity = (SPEED_MPS * math.cos(angle), SPEED_MPS * math.sin(angle))
    return lambda: world.Step(STEP_S, 8, 3)


def vmas(robots):
    import torch
    from vmas import make_env

    torch.set_num_threads(1)
    env = make_env("dropout", num_envs=1, n_agents=robots, device="cpu", continuous_actions=True, seed=0)
    env.reset()
    actions = [torch.zeros(1, 2) for _ in range(robots)]
    return lambda: env.step(actions)


def step_us(step, steps):
    begun = time.perf_counter()
    for _ in range(steps):
        step()
    return (time.perf_counter() - begun) / steps * 1e6


# Name, world, and the largest team that is worth the wait: a step of VMAS with 1,000 robots takes some seconds.
LIBRARIES = [
    ("RVO2 (pyrvo)", rvo2, 1000),
    ("navground, ORCA", navground, 1000),
    ("Box2D", box2d, 1000),
    ("VMAS, dropout", vmas, 100),
]


def main():
    sizes = (12, 100, 1000)
    print(f"{f'us a step, median of {TURNS}':<24}" + "".join(f"{size:>10}" for size in sizes))
    for name, make, largest in LIBRARIES:
        cells = []
        for robots in sizes:
            if robots > largest:
                cells.append(f"{'-':>10}")
                continue
            step = make(robots)
            steps = max(2, min(STEPS, int(1e6 / TURNS / step_us(step, 2))))
            cells.append(f"{statistics.median(step_us(step, steps) for _ in range(TURNS)):>10.0f}")
        print(f"{name:<24}" + "".join(cells), flush=True)


if __name__ == "__main__":
    main()
