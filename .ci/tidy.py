"""Runs the blocks of docs/experiments.md that read the long table in pandas, polars, DuckDB and R, as they stand there.

python .ci/tidy.py PLACE: PLACE has the sweep as results/paper and the table as tidy.csv; the means must be those of trials.csv."""

import csv
import pathlib
import re
import shutil
import subprocess
import sys

place = pathlib.Path(sys.argv[1])
text = pathlib.Path("docs/experiments.md").read_text()
section = text.split("## Reading the tables elsewhere")[1].split("\n## ")[0]
means = {}
with open(place / "results/paper/trials.csv", newline="") as table:
    for row in csv.DictReader(table):
        means.setdefault(row["policy"], []).append(float(row["rescuees_total"]))
means = {policy: sum(values) / len(values) for policy, values in means.items()}

commands = {"python": [sys.executable, "-c"], "r": ["Rscript", "-e"]}
ran = 0
for language, block in re.findall(r"```(python|r)\n(.*?)```", section, re.S):
    if language == "r" and shutil.which("Rscript") is None:
        print("tidy: there is no R here; its block was not run")
        continue
    told = subprocess.run(commands[language] + [block], cwd=place, capture_output=True, text=True)
    assert told.returncode == 0, (block, told.stderr)
    for policy, mean in means.items():
        line = next((line for line in told.stdout.splitlines() if re.search(rf"\b{policy}\b", line)), "")
        numbers = re.findall(r"\d+(?:\.\d+)?", line)  # R prints whole means without a point
        assert numbers and abs(float(numbers[-1]) - mean) < 0.06, (block, policy, mean, told.stdout)
    ran += 1
assert ran >= 3, "the blocks of pandas, polars and DuckDB"
print(f"{ran} blocks of docs/experiments.md give the means of trials.csv")
