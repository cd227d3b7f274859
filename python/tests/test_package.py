"""The package has the bits of the command, and its errors say where and why."""

from __future__ import annotations

import csv
import doctest
import pickle
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path
from types import ModuleType
from typing import Any, Callable

import numpy
import pytest
from conftest import eng, random_question

import usar
from usar import _policies, _records, _results, _usar

POLICIES = (
    "RNE DIS ENG HP_DIS RANDOM OPTIMAL GREEDY GRAPE SNAKE BALANCE SIMILAR KMEANS SPECTRAL BANDIT".split()
)
SCENARIOS = ["paper", "leak", "three-tasks", "trust/tunnel", "gallery/collapse"]


@pytest.mark.parametrize("module", [usar, _policies, _records, _results, _usar])
def test_docstrings(module: ModuleType) -> None:
    result = doctest.testmod(module)
    assert result.failed == 0
    assert module is not _usar or result.attempted > 10


@pytest.mark.parametrize("name", SCENARIOS)
def test_every_policy_has_the_hashes_and_decisions_of_the_command(
    name: str, tmp_path: Path, usar_command: Callable[..., str]
) -> None:
    policies, trials = ",".join(POLICIES), "10"
    words = ["sweep", name, "--policies", policies, "--trials", trials, "--set", "duration_s=150", "--quiet"]
    usar_command(*words, "--out", str(tmp_path / "command"))
    ours = usar.sweep(name, POLICIES, 10, set={"duration_s": 150}, out=tmp_path / "ours", progress=False)
    for table in ["trials", "rounds", "groups", "robots", "series", "hashes"]:
        theirs = (tmp_path / "command" / f"{table}.csv").read_bytes()
        assert (ours.path / f"{table}.csv").read_bytes() == theirs, table
    scenario = usar.Scenario.builtin(name).set(duration_s=150)
    with (tmp_path / "command" / "trials.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 140
    for row in rows[::9]:
        assert usar.run(scenario, row["policy"], int(row["seed"])).state_hash == row["state_hash"]


def test_eng_in_python_is_eng() -> None:
    for seed in range(1000):
        question = random_question(seed)
        ours = usar.group(question, eng)
        assert ours == usar.group(question, "ENG"), seed


def test_a_sweep_with_eng_in_python_has_the_tables_of_eng(tmp_path: Path) -> None:
    policies: dict[str, dict[str, Any]] = {"built-in": {"X": "ENG"}, "own": {"X": eng}}
    sweeps = [
        usar.sweep("paper", policy, 10, out=tmp_path / name, progress=False) for name, policy in policies.items()
    ]
    for table in ["trials", "rounds", "groups", "robots", "series", "hashes"]:
        assert len({(sweep.path / f"{table}.csv").read_bytes() for sweep in sweeps}) == 1, table


class Stubborn:
    """A policy as an object."""

    name = "stubborn"
    version = "2"
    deterministic = False

    def decide(self, question: Any) -> Any:
        return {"groups": eng(question), "idle": None}


class Waits:
    """Robots tell all others their number, and decide once they have heard everybody."""

    name = "waits"

    def decide(self, question: Any) -> Any:
        return eng(question)

    def act(self, turns: list[Any]) -> list[Any]:
        return [self.turn(turn) for turn in turns]

    def turn(self, turn: Any) -> Any:
        if turn["state"] is None:
            return {"says": [{"what": turn["robot"]}], "state": []}
        heard = sorted(turn["state"] + [told["what"] for told in turn["told"]])
        others = [member["id"] for member in turn["question"]["members"] if member["id"] != turn["robot"]]
        if heard == others:
            return {"joins": {"groups": eng(turn["question"])}}
        return {"state": heard}


def test_robots_that_decide_may_talk_in_python(short: usar.Scenario) -> None:
    robots = short.set(**{"mission.decides": "Robots()"})
    talked, alone = usar.run(robots, Waits()), usar.run(robots, "ENG")
    assert talked.state_hash != alone.state_hash, "they went a step later"

    class Few(Waits):
        def act(self, turns: list[Any]) -> list[Any]:
            return super().act(turns)[1:]

    with pytest.raises(usar.PolicyError, match="one entry for each of the 12 turns, found 11"):
        usar.run(robots, Few())


def test_policies_are_names_functions_and_objects(short: usar.Scenario) -> None:
    hashes = {usar.run(short, policy, 3).state_hash for policy in ("ENG", eng, Stubborn())}
    assert len(hashes) == 1
    assert usar.run(short, Stubborn()).policy == "stubborn"
    assert usar.run(short, "x=RNE(score: Sum)").policy == "x"
    with pytest.raises(ValueError, match="unknown policy"):
        usar.run(short, "RNF")
    with pytest.raises(TypeError, match="a policy is a name, a function"):
        usar.run(short, 3)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="needs a name of letters"):
        usar.run(short, lambda question: [])
    with pytest.raises(TypeError, match="policies must be a list or a dict"):
        usar.sweep(short, "RNE", 1)
    with pytest.raises(ValueError, match="jobs must be from 1 to 1024, found 0"):
        usar.sweep(short, ["RNE"], 1, jobs=0)


def test_a_scenario_that_cannot_be_used_says_where(tmp_path: Path) -> None:
    path = tmp_path / "mine.ron"
    path.write_text('(\n  base: "usar:/paper.ron",\n  duration_s: -1,\n)')
    with pytest.raises(usar.ScenarioError, match="duration_s must be") as raised:
        usar.Scenario.load(path)
    assert (raised.value.file, raised.value.line, raised.value.field) == (str(path), 3, "duration_s")
    with pytest.raises(usar.ScenarioError, match="did you mean"):
        usar.Scenario.builtin("paper").set(duration=3)
    with pytest.raises(usar.ScenarioError):
        usar.Scenario.load(tmp_path / "absent.ron")
    with pytest.raises(usar.ScenarioError, match="duration_s must be") as raised:
        usar.sweep(path, ["DIS"], 1)
    assert (raised.value.file, raised.value.line, raised.value.field) == (str(path), 3, "duration_s")
    with pytest.raises(usar.ScenarioError, match="did you mean"):
        usar.sweep(usar.Scenario.builtin("paper"), ["DIS"], 1, set={"duration": 3})
    file = tmp_path / "mine.sweep.ron"
    file.write_text('(\n  name: "mine",\n  scenario: "usar:/paper.ron",\n  policies: ["RNF"],\n)')
    with pytest.raises(usar.ScenarioError, match="unknown policy") as raised:
        usar.sweep(file)
    assert (raised.value.file, raised.value.line, raised.value.field) == (str(file), 4, "policies[0]")


@pytest.mark.parametrize(
    ("answer", "cause", "message"),
    [
        (lambda q: 1 / 0, ZeroDivisionError, "division by zero"),
        (lambda q: [[m["id"] for m in q["members"]]], ValueError, "must have a group for each of the 2 tasks"),
        (lambda q: [[0, 0], []], ValueError, "found it twice"),
        (lambda q: [[99], []], ValueError, "robot 99 is not a member"),
        (lambda q: [[0], []], ValueError, "found it in none"),
        (lambda q: None, TypeError, "not iterable|NoneType"),
        (lambda q: [["a"], []], TypeError, "str"),
        (lambda q: [[-1], []], OverflowError, "negative|out of range"),
    ],
)
def test_a_policy_that_does_not_answer_says_why(
    short: usar.Scenario, answer: Any, cause: type[BaseException], message: str
) -> None:
    def mine(question: Any) -> Any:
        return answer(question)

    with pytest.raises(usar.PolicyError, match=message) as raised:
        usar.run(short, mine, seed=5)
    assert (raised.value.policy, raised.value.seed, raised.value.round) == ("mine", 5, 1)
    assert isinstance(raised.value.__cause__, cause)
    assert cause is not ZeroDivisionError or raised.value.__cause__.__traceback__ is not None
    with pytest.raises(usar.PolicyError, match=message):
        usar.sweep(short, [mine], 2, progress=False)


def test_no_carrier_is_sent_out(short: usar.Scenario) -> None:
    def scout(question: Any) -> Any:
        ids = [member["id"] for member in question["members"]]
        return {"groups": [ids[-1:], []], "idle": ids[:-1]}

    may = short.set(**{"mission.may_idle": True, "mission.group_sizes": "Free"})
    with pytest.raises(usar.PolicyError, match="must send out a robot that can carry") as raised:
        usar.run(may, scout, seed=2)
    assert (raised.value.policy, raised.value.seed, raised.value.round) == ("scout", 2, 1)


def test_a_sweep_goes_on_where_a_policy_raised(tmp_path: Path, short: usar.Scenario) -> None:
    def late(question: Any) -> Any:
        if question["round"] > 1:
            raise RuntimeError("not yet")
        return eng(question)

    for _ in range(2):
        with pytest.raises(usar.PolicyError, match="not yet") as raised:
            usar.sweep(short, {"DIS": "DIS", "mine": late}, 3, out=tmp_path, jobs=1, progress=False)
        assert raised.value.round == 2
    counts: list[tuple[int, int]] = []
    results = usar.sweep(
        short,
        {"DIS": "DIS", "mine": eng},
        3,
        out=tmp_path,
        progress=lambda done, of: counts.append((done, of)),
    )
    assert counts[0][0] >= 3 and counts[-1] == (6, 6), "the trials of DIS are kept"
    assert set(results.trials.status) == {"completed"}


def test_a_simulation_goes_step_by_step(short: usar.Scenario) -> None:
    trial = usar.Simulation(short, 4)
    question = trial.until_asked()
    assert question is not None and trial.question == question and trial.status is None
    with pytest.raises(ValueError, match="robot 0 must be in exactly one group"):
        trial.assign([[], []])
    best = trial.oracle(limit=1000)
    assert len(best) == 240
    assert best[0][1] is not None and best[-1][1] is not None and best[0][1] >= best[-1][1]
    trial.assign(usar.group(question, "HP_DIS"))
    fork = trial.fork()
    assert trial.step(100) == 100 and trial.state_hash != fork.state_hash
    assert fork.step(100) == 100 and trial.state_hash == fork.state_hash
    assert trial.positions.shape == trial.velocities.shape == trial.levels.shape == (12, 2)
    assert trial.positions.dtype == numpy.float32 and trial.able.all() and (trial.carried == 0).all()
    assert set(trial.beliefs) == {"rescuees", "debris", "radiation"}
    with pytest.raises(ValueError, match="the trial is not over"):
        trial.record()
    record = trial.finish("HP_DIS")
    whole = usar.run(short, "HP_DIS", 4)
    assert record.state_hash == whole.state_hash and trial.steps < 200
    while question := trial.until_asked():
        trial.assign(usar.group(question, "HP_DIS"))
    assert trial.state_hash == whole.state_hash and trial.status == "completed"
    assert trial.record().rescued == whole.rescued == trial.totals[0]
    with pytest.raises(ValueError, match="no question waits"):
        trial.assign([[], []])
    with pytest.raises(ValueError, match="shape"):
        trial.steer([[0.0, 0.0]])
    with pytest.raises(ValueError, match="must be finite"):
        trial.steer(numpy.full((12, 2), numpy.nan))


def test_a_scenario_goes_to_other_processes(short: usar.Scenario) -> None:
    assert pickle.loads(pickle.dumps(short)) == short
    assert usar.Scenario.from_str(short.text) == short


def test_what_decides_runs_trials_again(tmp_path: Path, short: usar.Scenario) -> None:
    def ranked(sign: int) -> Callable[[Any], Any]:
        def mine(question: Any) -> Any:
            levels = [{**member, "levels": [sign * level for level in member["levels"]]} for member in question["members"]]
            return eng({**question, "members": levels})

        return mine

    hashes = []
    for sign in (1, -1, 1):
        results = usar.sweep(short, {"mine": ranked(sign)}, 2, out=tmp_path, progress=False, frames="lists")
        hashes.append([row["state_hash"] for row in results.trials])
    assert hashes[0] == hashes[2] != hashes[1]


def test_who_stays_at_home_is_told(short: usar.Scenario) -> None:
    trial = usar.Simulation(short.set(**{"mission.may_idle": True}), 1)
    question = trial.until_asked()
    assert question is not None

    def one_idles(asked: Any) -> Any:
        groups = eng(asked)
        return {"groups": [groups[0][:-1], groups[1]], "idle": groups[0][-1:]}

    answer = usar.group(question, one_idles)
    assert isinstance(answer, dict) and list(answer["idle"]) == [eng(question)[0][-1]]
    trial.assign(answer)


def test_a_builtin_scenario_is_no_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "paper").write_text("nonsense")
    monkeypatch.chdir(tmp_path)
    assert usar.Scenario.builtin("paper").robots == 12
    with pytest.raises(ValueError, match="no scenario is called"):
        usar.Scenario.builtin("papers")


# A shell's jobs in the background ignore Ctrl-C unless they ask for it.
ASKS = "import signal; signal.signal(signal.SIGINT, signal.default_int_handler)\n"

INTERRUPTED = ASKS + """
import sys, usar
print("begins", flush=True)
usar.sweep("paper", ["RNE", "DIS"], 300, out=sys.argv[1], set={"duration_s": 100}, progress=False)
"""


def interrupted(words: list[str], is_at_work: Callable[[], bool] = lambda: True) -> str:
    """What a program says on stderr that gets a Ctrl-C some time after it has begun."""
    with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        try:
            assert process.stdout is not None and process.stdout.readline() == "begins\n"
            while not is_at_work():
                time.sleep(0.05)
            time.sleep(0.5)
            process.send_signal(signal.SIGINT)
            begun = time.monotonic()
            _, told = process.communicate(timeout=20)
            print(f"{time.monotonic() - begun:.2f} s from Ctrl-C to the end of the process")
        finally:
            process.kill()
    return told


def test_ctrl_c_ends_a_sweep_that_goes_on_later(tmp_path: Path) -> None:
    words = [sys.executable, "-c", INTERRUPTED, str(tmp_path)]
    told = interrupted(words, lambda: (tmp_path / "journal.jsonl").exists())
    assert "KeyboardInterrupt" in told, told
    counts: list[int] = []
    usar.sweep(
        "paper",
        ["RNE", "DIS"],
        300,
        out=tmp_path,
        set={"duration_s": 100},
        progress=lambda done, of: counts.append(done),
    )
    assert 0 < counts[0] < 600 and counts[-1] == 600


AT_WORK = ASKS + """
import sys, time, usar
def slow(question):
    print("begins", flush=True)
    while True: {work}
paper = usar.Scenario.builtin("paper")
{call}
"""


@pytest.mark.parametrize("work", ["pass", "time.sleep(60)"])
@pytest.mark.parametrize(
    "call",
    [
        "usar.run(paper, slow)",
        "usar.sweep(paper, [slow, 'DIS'], 4, jobs=2, progress=False)",
        "usar.group(usar.Simulation(paper).until_asked(), slow)",
        "usar.group(usar.Simulation(paper).until_asked(), 'EXEC(command: [\"sh\", \"-c\", \"echo begins >&3; sleep 60\"])')",
    ],
)
def test_ctrl_c_ends_a_policy_at_work(call: str, work: str) -> None:
    words = ["sh", "-c", 'exec "$0" "$@" 3>&1', sys.executable, "-c", AT_WORK.format(work=work, call=call)]
    told = interrupted(words)
    assert told.rstrip().endswith("KeyboardInterrupt"), told


def test_policies_answer_on_the_thread_that_called(short: usar.Scenario) -> None:
    threads = set()

    def mine(question: Any) -> Any:
        threads.add(threading.get_ident())
        return usar.group(question, eng)  # a call within a call

    results = usar.sweep(short, [mine, "ENG"], 4, jobs=2, progress=False, frames="lists")
    assert threads == {threading.get_ident()}
    hashes = [row["state_hash"] for row in results.trials]
    assert hashes[:4] == hashes[4:]


def test_a_decision_is_cheap(short: usar.Scenario, capsys: pytest.CaptureFixture[str]) -> None:
    trial = usar.Simulation(usar.Scenario.builtin("paper"), 1)
    trial.until_asked()
    begun = time.perf_counter()
    for _ in range(200):
        assert trial.question is not None
    took = (time.perf_counter() - begun) / 200 * 1e6
    with capsys.disabled():
        print(f"\n{took:.0f} us for a question of 12 robots to come to Python")


def test_results_are_compared_and_reported(tmp_path: Path, short: usar.Scenario) -> None:
    results = usar.sweep(short, ["RNE", "RANDOM"], 6, out=tmp_path / "r", progress=False)
    one = usar.compare(results, metrics=["rescuees.total"], margins={"rescuees.total": 3})
    assert [(each["a"], each["b"]) for each in one] == [("RNE", "RANDOM")] and one[0]["n"] == 6
    assert usar.report(results).read_text().startswith("<!DOCTYPE html>")
    assert len(results.groups) > 0 and len(results.rounds) > 0
    with pytest.raises(ValueError, match="metric"):
        usar.compare(results, metrics=["nonsense"])
    with pytest.raises(FileNotFoundError, match="no folder of results"):
        usar.Results(tmp_path)
    frames = [usar.Results(results.path, kind).trials for kind in ("pandas", "polars")]
    rows = usar.Results(results.path, "lists").trials
    for name in ("rescuees_total", "state_hash"):
        values = [row[name] for row in rows]
        assert [list(frame[name]) for frame in frames] == [values, values]
