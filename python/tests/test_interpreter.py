"""The interpreter lives on, and so do results, whatever is passed, closed, copied, forked or ended."""

from __future__ import annotations

import copy
import io
import os
import pickle
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Callable

import pytest

import usar
from usar import _usar

LINUX = pytest.mark.skipif(sys.platform != "linux", reason="looks into /proc")


def nested(depth: int, kind: Callable[[Any], Any] = lambda entry: [entry]) -> Any:
    value: Any = kind(1)
    for _ in range(depth - 1):
        value = kind(value)
    return value


def in_itself() -> list[Any]:
    value: list[Any] = []
    value.append(value)
    return value


def run(program: str, *words: str) -> str:
    """What a program prints, in an interpreter of its own."""
    done = subprocess.run([sys.executable, "-c", program, *words], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done
    return done.stdout.strip()


@pytest.mark.parametrize(
    "value", [in_itself(), (in_itself(),), nested(65), nested(10_000), nested(10_000, lambda entry: (entry,))]
)
def test_lists_without_an_end_are_a_recursion_error(short: usar.Scenario, value: Any) -> None:
    for call in (
        lambda: short.set(tasks=value),
        lambda: _usar.ron(value),
        lambda: usar.sweep("paper", ["DIS"], 1, set={"tasks": value}, progress=False),
        lambda: usar.sweep(short, ["DIS"], 1, set={"tasks": value}, progress=False),
    ):
        with pytest.raises(RecursionError, match="at most 64 lists within one another"):
            call()


def test_lists_that_are_long_are_written_or_refused() -> None:
    assert _usar.ron(nested(64)) == "[" * 64 + "1" + "]" * 64
    assert _usar.ron([(), [1, (2.5, None)], True, "Some(3)"]) == "[(), [1, (2.5, None)], true, Some(3)]"
    wide: Any = [0] * 10
    for _ in range(40):
        wide = [wide, wide]  # few lists, but a text without an end
    with pytest.raises(ValueError, match="at most 4194304 bytes"):
        _usar.ron(wide)


@pytest.mark.parametrize("brackets", ["[", "(", "Some(", "{1:"])
def test_texts_without_an_end_are_refused(short: usar.Scenario, brackets: str) -> None:
    endless = brackets * 100_000
    trial = usar.Simulation(short)
    trial.until_asked()
    for call in (
        lambda: short.set(tasks=endless),
        lambda: usar.Scenario.from_str(endless),
        lambda: usar.run(short, f"RNE({endless}"),
        lambda: usar.run(short, f"EXEC(command: {endless}"),
        lambda: trial.oracle(endless),
    ):
        with pytest.raises(ValueError):
            call()


def spoiled(value: Any) -> Iterator[Any]:
    """The value with each of its parts, at any depth, missing or replaced."""
    yield from (None, -1, 10**30, "x", {}, {1: 2}, {"x": 1}, [])
    yield from (in_itself(), nested(10_000), float("nan"), object())
    parts = value if isinstance(value, dict) else range(min(len(value), 2)) if isinstance(value, list) else ()
    for key in parts:
        without = copy.copy(value)
        del without[key]
        yield without
        for part in spoiled(value[key]):
            changed = copy.copy(value)
            changed[key] = part
            yield changed


def test_a_question_that_cannot_be_read_says_so(short: usar.Scenario) -> None:
    question: Any = usar.Simulation(short).until_asked()
    refused = 0
    for wrong in spoiled(question):
        try:
            usar.group(wrong, "DIS")
        except Exception as error:
            assert isinstance(error, (ValueError, TypeError, OverflowError, usar.PolicyError)), error
            refused += 1
    assert refused > 500
    with pytest.raises(ValueError, match="the question: missing field `schema_version`"):
        usar.group({})  # type: ignore[typeddict-item]
    with pytest.raises(ValueError, match="schema_version must be 3, found 2; since version 3, levels stand in"):
        question["schema_version"] = 2
        usar.group(question)


def test_answers_without_an_end_are_refused(short: usar.Scenario) -> None:
    for answer in (in_itself(), nested(10_000), {"groups": in_itself()}, {"idle": nested(10_000)}):

        def mine(question: Any, answer: Any = answer) -> Any:
            return answer

        with pytest.raises(usar.PolicyError):
            usar.run(short, mine)


THREADS = """
import os, sys, numpy, usar
from usar import _usar
short = usar.Scenario.builtin("paper").set(duration_s=30)
def count():
    "Threads that are not ending: the kernel lists a thread for a moment after it has been waited for."
    threads = 0
    for task in os.listdir("/proc/self/task"):
        try:
            words = open(f"/proc/self/task/{task}/stat").read().rpartition(")")[2].split()
        except (FileNotFoundError, ProcessLookupError):
            continue
        threads += not int(words[6]) & 4
    return threads
before, most = count(), 0
trial = usar.Simulation(short)
question = trial.until_asked()
def mine(question):
    global most
    most = max(most, count())
    return usar.group(question, "DIS")
for call in (
    lambda: usar.sweep(short, ["DIS", mine], 3, jobs=1, progress=False),
    lambda: usar.sweep(short, ["DIS", mine], 3, progress=False),
    lambda: usar.run(short, mine),
    lambda: usar.group(question, "RNE"),
    lambda: trial.oracle(limit=10),
    lambda: trial.finish(),
    lambda: _usar.advance_all([usar.Simulation(short, seed) for seed in range(3)], 10**6),
    lambda: _usar.advance_all([usar.Simulation(short, seed) for seed in range(3)], 0),
    lambda: _usar.advance_all([], 10**6),
):
    call()
    assert count() == before, (count(), before)
print(most - before)
"""


@LINUX
def test_no_thread_outlives_a_call() -> None:
    assert 1 <= int(run(THREADS)) < 3 * (os.cpu_count() or 1) + 4


FORKS = """
import os, sys, usar
short = usar.Scenario.builtin("paper").set(duration_s=30)
def call():
    usar.run(short, "RNE")
    return usar.sweep(short, ["DIS"], 2, jobs={jobs}, progress=False, frames="lists")
results = call()
child = os.fork()
if child == 0:
    assert len(call().trials) == 2
    sys.exit(0)  # with all that is done at the end of an interpreter
assert os.waitpid(child, 0)[1] == 0
print(len(results.trials))
"""


@LINUX
@pytest.mark.parametrize("jobs", [None, 1, 2])
def test_a_child_sweeps_and_leaves_the_results_of_its_parent(jobs: object) -> None:
    assert run(FORKS.format(jobs=jobs)) == "2"


@pytest.mark.parametrize("jobs", [0, -1, 1025, 10**6, 10**30])
def test_jobs_are_some_and_not_too_many(short: usar.Scenario, jobs: int) -> None:
    with pytest.raises(ValueError, match=f"jobs must be from 1 to 1024, found {jobs}"):
        usar.sweep(short, ["DIS"], 1, jobs=jobs)


def test_the_oracle_plays_some_and_not_too_many(short: usar.Scenario) -> None:
    trial = usar.Simulation(short)
    trial.until_asked()
    for limit in (0, 1, 2**64 - 1):
        with pytest.raises(ValueError, match=f"limit must be from 2 to 1000000, found {limit}"):
            trial.oracle(limit=limit)


class Odd(io.StringIO):
    """A stderr that fails."""

    def write(self, text: str) -> int:
        raise BrokenPipeError(text)


class Closed(Odd):
    def isatty(self) -> bool:
        raise ValueError("I/O operation on closed file")


@pytest.mark.parametrize("stderr", [None, object(), Odd(), Closed()])
def test_a_sweep_needs_no_stderr(short: usar.Scenario, monkeypatch: pytest.MonkeyPatch, stderr: Any) -> None:
    monkeypatch.setattr(sys, "stderr", stderr)
    assert len(usar.sweep(short, ["DIS"], 2, frames="lists").trials) == 2


@LINUX
@pytest.mark.parametrize("end", ["2>&-", "2>/dev/full", "1>&- 2>&- 0<&-"])
def test_a_sweep_needs_no_standard_streams(tmp_path: Path, end: str) -> None:
    program = """
import sys, usar
short = usar.Scenario.builtin("paper").set(duration_s=30)
dies = 'EXEC(command: ["sh", "-c", "exit 3"])'
results = usar.sweep(short, ["DIS"], 2, frames="lists")
open(sys.argv[1], "w").write(str(len(results.trials)))
try: usar.run(short, dies)
except usar.PolicyError: open(sys.argv[1], "a").write(" and an error")
"""
    words = ["sh", "-c", f'"$@" {end}', "sh", sys.executable, "-c", program, str(tmp_path / "told")]
    subprocess.run(words, timeout=60)
    assert (tmp_path / "told").read_text() == "2 and an error"


def test_what_cannot_be_used_is_refused_before_the_first_trial(short: usar.Scenario) -> None:
    def never(question: Any) -> Any:
        raise AssertionError("a trial began")

    with pytest.raises(ValueError, match="frames must be"):
        usar.sweep(short, [never], 1, frames="arrow")
    with pytest.raises(TypeError, match="progress must be true, false or a function of two numbers, found 5"):
        usar.sweep(short, [never], 1, progress=5)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    "copied", [copy.copy, copy.deepcopy, lambda results: pickle.loads(pickle.dumps(results))]
)
def test_copies_of_results_outlive_them(
    short: usar.Scenario, copied: Callable[[usar.Results], usar.Results]
) -> None:
    results = usar.sweep(short, ["DIS", "RNE"], 2, progress=False, frames="lists")
    rows, path = results.trials, results.path
    other = copied(copied(results))
    del results
    assert other.trials == rows and len(other.rounds) > 0
    assert usar.compare(other)[0]["a"] == "DIS" and usar.report(other).exists()
    last = other.path
    del other
    assert not path.exists() and not last.exists() and not last.parent.exists()


def test_copies_of_kept_results_are_of_the_same_folder(short: usar.Scenario, tmp_path: Path) -> None:
    results = usar.sweep(short, ["DIS"], 1, out=tmp_path, progress=False, frames="lists")
    for other in (copy.copy(results), copy.deepcopy(results), pickle.loads(pickle.dumps(results))):
        assert other.path == tmp_path and other.trials == results.trials
    del results, other
    assert (tmp_path / "trials.csv").exists()


def test_results_come_from_other_processes(tmp_path: Path) -> None:
    program = """
import pickle, sys, usar
short = usar.Scenario.builtin("paper").set(duration_s=30)
with open(sys.argv[1], "wb") as file:
    pickle.dump(usar.sweep(short, ["DIS"], 2, progress=False, frames="lists"), file)
"""
    run(program, str(tmp_path / "results"))
    results = pickle.loads((tmp_path / "results").read_bytes())
    assert [row["policy"] for row in results.trials] == ["DIS", "DIS"]


def test_a_sweep_that_fails_leaves_no_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    with pytest.raises(ValueError, match="unknown policy"):
        usar.sweep("paper", ["RNF"], 1, progress=False)
    assert list(tmp_path.iterdir()) == []


STUBBORN = """
import signal, sys, threading, time, usar
program = f"trap '' TERM INT HUP; echo $$ >> {sys.argv[1]}; while :; do sleep 0.1; done"
policy = f'EXEC(command: ["sh", "-c", "{program}"])'
def call(): %s
%s
"""
CALLS = [
    "usar.sweep('paper', [policy], 8, jobs=2, progress=False)",
    "usar.run(usar.Scenario.builtin('paper'), policy)",
    "usar.group(usar.Simulation(usar.Scenario.builtin('paper')).until_asked(), policy)",
]


def wait_until(holds: Callable[[], bool]) -> None:
    end = time.monotonic() + 20
    while not holds():
        assert time.monotonic() < end
        time.sleep(0.05)


def lives(process: int) -> bool:
    state = Path(f"/proc/{process}/stat")
    return state.exists() and state.read_text().rsplit(")", 1)[1].split()[0] != "Z"


def programs_end(path: Path) -> bool:
    return not any(lives(int(line)) for line in path.read_text().split())


@LINUX
@pytest.mark.parametrize("call", CALLS)
@pytest.mark.parametrize(("number", "status"), [(signal.SIGTERM, 7), (signal.SIGINT, -signal.SIGINT)])
def test_a_signal_that_python_handles_ends_programs(
    tmp_path: Path, call: str, number: signal.Signals, status: int
) -> None:
    handled = "signal.signal(signal.SIGTERM, lambda *_: sys.exit(7))\n"
    handled += "signal.signal(signal.SIGINT, signal.default_int_handler)\ncall()"
    told = tmp_path / "processes"
    words = [sys.executable, "-c", STUBBORN % (call, handled), str(told)]
    with subprocess.Popen(words, stderr=subprocess.DEVNULL) as process:
        wait_until(lambda: told.exists() and bool(told.read_text().strip()))
        process.send_signal(number)
        assert process.wait(20) == status
    wait_until(lambda: programs_end(told))


@LINUX
@pytest.mark.parametrize("call", CALLS)
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGKILL])
def test_a_signal_that_ends_python_ends_programs(tmp_path: Path, call: str, number: signal.Signals) -> None:
    told = tmp_path / "processes"
    with subprocess.Popen([sys.executable, "-c", STUBBORN % (call, "call()"), str(told)]) as process:
        wait_until(lambda: told.exists() and bool(told.read_text().strip()))
        process.send_signal(number)
        assert process.wait(20) == -number
    wait_until(lambda: programs_end(told))


def test_a_program_of_a_sweep_file_is_started_only_if_it_is_allowed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    monkeypatch.chdir(tmp_path)
    Path("short.ron").write_text('(base: "usar:/paper.ron", name: "short", duration_s: 30.0)')
    Path("marker.py").write_text("open('started', 'w').close()")
    command = 'x=EXEC(command: [\\"python3\\", \\"marker.py\\"])'
    sweep = tmp_path / "short.sweep.ron"
    sweep.write_text(f'(name: "s", scenario: "short.ron", policies: ["DIS", "{command}"], trials: 1)')
    for file in ("short.sweep.ron", "short.ron"):
        with pytest.raises(ValueError, match="allow_programs=True allows it"):
            usar.sweep(file, progress=False)
        assert not Path("started").exists()
        with pytest.raises(ValueError, match="exited with status 0"):
            usar.sweep(file, progress=False, allow_programs=True)
        assert Path("started").exists()
        Path("started").unlink()
        Path("state/usar/allowed").unlink()
    with pytest.raises(ValueError, match="exited with status 0"):
        usar.sweep("short.ron", ['EXEC(command: ["python3", "marker.py"])'], progress=False)
    assert Path("started").exists()


@LINUX
@pytest.mark.parametrize("call", CALLS)
def test_the_end_of_the_interpreter_ends_programs_of_threads(tmp_path: Path, call: str) -> None:
    in_thread = "import os\nthreading.Thread(target=call, daemon=True).start()\n"
    in_thread += "while not os.path.exists(sys.argv[1]): time.sleep(0.05)\ntime.sleep(0.3)"
    told = tmp_path / "processes"
    begun = time.monotonic()
    assert run(STUBBORN % (call, in_thread), str(told)) == ""
    assert time.monotonic() - begun < 20
    wait_until(lambda: programs_end(told))
