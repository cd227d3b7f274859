"""DIS: per role, the nearest task from the initial position until its group is full."""

import json
import sys


def decide(question):
    tasks = question["tasks"]
    hardest_first = sorted(range(len(tasks)), key=lambda task: -tasks[task]["difficulty"])
    groups = [[] for _ in tasks]
    for role, quota in enumerate(question["quotas"]):
        room, pairs, assigned = list(quota["members"]), [], set()
        for robot in (robot for robot in question["members"] if robot["role"] == role):
            for rank, task in enumerate(hardest_first):
                dx, dy = (a - b for a, b in zip(robot["home"], tasks[task]["place"]))
                pairs.append((dx * dx + dy * dy, robot["id"], rank))
        for _, robot, rank in sorted(pairs):
            task = hardest_first[rank]
            if room[task] > 0 and robot not in assigned:
                room[task] -= 1
                groups[task].append(robot)
                assigned.add(robot)
    return groups


for line in sys.stdin:
    message = json.loads(line)
    if message["type"] == "hello":
        reply = {"type": "hello", "protocol": 1, "schema_version": 3, "name": "distance", "version": "1"}
    elif message["type"] == "question":
        decision = {"assignment": {"groups": decide(message["question"])}}
        reply = {"type": "decision", "id": message["id"], "decision": decision}
    else:
        break
    print(json.dumps(reply), flush=True)
