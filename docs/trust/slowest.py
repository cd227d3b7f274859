"""A fair draw that always, or never, sends the team's slowest robot to the far task.

    slowest=EXEC(command: ["python3", "docs/trust/slowest.py", "always"])

With the folder of a sweep instead, it prints in which share of the rounds each policy did so.
"""

import csv
import json
import random
import sys

FAR = "far"


def draw(question, always):
    far = [task["name"] for task in question["tasks"]].index(FAR)
    speed = [need["name"] for need in question["needs"]].index("v")
    slowest = min(question["members"], key=lambda robot: robot["needs"][speed])["id"]
    chance = random.Random(question["random_seed"])
    while True:
        groups = [[] for task in question["tasks"]]
        for role, quota in enumerate(question["quotas"]):
            ids = [robot["id"] for robot in question["members"] if robot["role"] == role]
            chance.shuffle(ids)
            for task, size in enumerate(quota["members"]):
                groups[task] += [ids.pop() for robot in range(size)]
        if (slowest in groups[far]) == always:
            return groups


def answers(always):
    for line in sys.stdin:
        message = json.loads(line)
        if message["type"] == "hello":
            answer = {"type": "hello", "protocol": 1, "schema_version": 3, "name": "slowest", "version": "1"}
        elif message["type"] == "question":
            groups = draw(message["question"], always)
            answer = {"type": "decision", "id": message["id"], "decision": {"assignment": {"groups": groups}}}
        else:
            break
        print(json.dumps(answer), flush=True)


def shares(folder):
    rounds = {}
    for row in csv.DictReader(open(f"{folder}/groups.csv")):
        place = row["policy"], row["deceit[0].who"], row["trial"], row["round"]
        rounds.setdefault(place, []).append((float(row["need_v"]), row["task"] == FAR))
    found = {}
    for (policy, liars, _, _), robots in rounds.items():
        found.setdefault((policy, liars), []).append(min(robots)[1])
    print("policy,liars,rounds,slowest robot at the far task (%)")
    for (policy, liars), far in found.items():
        print(f"{policy},{liars},{len(far)},{100 * sum(far) / len(far):.1f}")


if __name__ == "__main__":
    if sys.argv[1] in ("always", "never"):
        answers(sys.argv[1] == "always")
    else:
        shares(sys.argv[1])
