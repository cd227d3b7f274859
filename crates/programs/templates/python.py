"""NAME: a policy of usar. It answers a question with groups: for each task, the ids of its robots.

python3 NAME.py --test     asks it the questions of NAME.questions.jsonl
"""

import json
import sys


def decide(question, options):
    """Per role, the robots with more energy take the harder tasks; ties go to the lower id."""
    energy = [level["name"] for level in question["levels"]].index("energy")
    tasks = question["tasks"]
    hardest_first = sorted(range(len(tasks)), key=lambda task: -tasks[task]["difficulty"])
    groups = [[] for _ in tasks]
    for role, quota in enumerate(question["quotas"]):
        robots = [robot for robot in question["members"] if robot["role"] == role]
        robots.sort(key=lambda robot: (-(robot["levels"][energy] or 0), robot["id"]))
        ids = [robot["id"] for robot in robots]
        for task in hardest_first:
            size = quota["members"][task]
            groups[task] += ids[:size]
            ids = ids[size:]
    return groups


def answer():
    options = {}
    for line in sys.stdin:
        message = json.loads(line)
        if message["type"] == "hello":
            options = message["options"]
            hello = {"name": "NAME", "version": "0.1", "deterministic": True}
            reply = {"type": "hello", "protocol": 1, "schema_version": 3, **hello}
        elif message["type"] == "question":
            decision = {"assignment": {"groups": decide(message["question"], options)}}
            reply = {"type": "decision", "id": message["id"], "decision": decision}
        else:
            return
        print(json.dumps(reply), flush=True)  # all other prints: print(..., file=sys.stderr)


def test():
    with open(sys.argv[0].removesuffix(".py") + ".questions.jsonl", encoding="utf-8") as questions:
        for count, line in enumerate(questions, 1):
            question = json.loads(line)
            groups = decide(question, {})
            grouped = sorted(robot for group in groups for robot in group)
            members = sorted(robot["id"] for robot in question["members"])
            assert len(groups) == len(question["tasks"]), f"question {count}: {groups}"
            assert grouped == members, f"question {count}: {groups}"
    print(f"{count} questions answered")


if __name__ == "__main__":
    test() if "--test" in sys.argv else answer()
