"""Names what fresh pairs judge, by the rule that stands in scenarios/sweeps/trust-fresh.ron.

    usar study deceit scenarios/sweeps/trust-filter.ron --scenario scenarios/trust/tunnel.ron \
        --replay results/trust-regret-tunnel --json | python3 docs/trust/named.py scenarios/trust/tunnel.ron

prints the command that runs them.
"""

import json
import shlex
import sys

JUDGED = "Kalman Beta Brs Travos EigenTrust Hmm Cusum Rne Wmsr".split()
LIES = {  # as in the variants of trust-filter.ron
    "all": "Exaggerate(by: 1)",
    "half": "Exaggerate(by: 0.5)",
    "modest": "Understate(by: 0.5)",
    "offset": "Offset(points: 20)",
    "complement": "Complement",
    "stuck": "Stuck",
    "uniform": "Uniform(low: 0, high: 100)",
    "copycat": "Copycat",
    "on and off": "OnOff(period_s: 240, duty: 0.5, lie: Exaggerate(by: 1))",
    "collude": "Collude",
}

found = json.load(sys.stdin)
worth = {}  # of a policy under a lie: by number of liars
for row in found["tables"]["policies"]:
    worth[row["policy"], row["lie"]] = [one["mean"] for one in row["differences"]]


def under_liars(policy, lie):
    """Over one to six liars; less than any other where an answer was never played."""
    values = worth[policy, lie][1:]
    return float("-inf") if None in values else sum(values)


policies = list(dict.fromkeys(row["policy"] for row in found["tables"]["policies"]))
lies = list(dict.fromkeys(row["lie"] for row in found["tables"]["policies"]))
alone = [policy for policy in policies if " <- " not in policy and policy != "RANDOM"]
rules = sorted(alone, key=lambda rule: -worth[rule, lies[0]][0])[:2]
lie = min(lies, key=lambda lie: sum(under_liars(rule, lie) for rule in rules))

chosen = ["RANDOM"]
for rule in rules:
    behind = [policy for policy in policies if policy.startswith(f"{rule} <- ")]
    ranked = sorted(behind, key=lambda policy: -under_liars(policy, lie))
    best = [policy for policy in ranked if not policy.endswith("<- Truth")][:2]
    doubting = next(policy for policy in ranked if policy.endswith("| Discount"))
    chosen += [rule, f"{rule} <- Truth", *best, doubting.replace("Discount", "Exclude")]
chosen += [f"DIS <- {estimator}" for estimator in JUDGED]

command = ["usar", "study", "deceit", "scenarios/sweeps/trust-fresh.ron", "--scenario", sys.argv[1]]
command += ["--policies", ",".join(chosen), "--set", f"deceit[0].lie={LIES[lie]}"]
if lie == "collude":
    command += ["--set", "deceit[0].on=[]"]
print(shlex.join(command))
