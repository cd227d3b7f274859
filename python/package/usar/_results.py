"""Sweeps and their folders of results."""

from __future__ import annotations

import contextlib
import csv
import importlib.util
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import warnings
import weakref
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, Callable, Optional, Union

from . import _usar
from ._policies import given
from ._types import Policy

HASH = "state_hash"  # text, even where it looks like a number
MOST_THREADS = 1024  # as on the command line

Policies = Union[Iterable[Policy], Mapping[str, Policy]]


class Results:
    """A folder of results.

    Tables are data frames of pandas, or of polars where only that is installed, or else lists of dicts.
    """

    def __init__(self, path: Union[str, os.PathLike[str]], frames: Optional[str] = None) -> None:
        """`frames` is "pandas", "polars" or "lists", for another form of tables."""
        self.path = Path(path)
        if not (self.path / "manifest.json").exists():
            raise FileNotFoundError(f"{self.path}: no folder of results: it has no manifest.json")
        self._frames = _checked(frames)
        self._folder: Optional[_Folder] = None  # that they are in, if it is temporary

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        if self._folder is not None:
            self.path = self._folder.path / "results"

    @property
    def trials(self) -> Any:
        """A row for each trial. Trials of the same `trial` and `case` are pairs."""
        return self.table("trials")

    @property
    def rounds(self) -> Any:
        """A row for each group in each round."""
        return self.table("rounds")

    @property
    def groups(self) -> Any:
        """A row for each robot in each round."""
        return self.table("groups")

    def table(self, name: str) -> Any:
        """The table of this name: also `robots`, `series` and `links`."""
        path = self.path / f"{name}.csv"
        frames = self._frames or next((kind for kind in ("pandas", "polars") if _is_there(kind)), "lists")
        if frames == "pandas":
            import pandas

            return pandas.read_csv(path, keep_default_na=False, na_values="", dtype={HASH: str})
        if frames == "polars":
            import polars

            with path.open() as file:
                texts = {HASH: polars.String} if HASH in file.readline().split(",") else None
            return polars.read_csv(path, infer_schema_length=None, schema_overrides=texts)
        with path.open(newline="") as file:
            rows = csv.DictReader(file)
            return [{key: text if key == HASH else _value(text) for key, text in row.items()} for row in rows]

    def __repr__(self) -> str:
        return f"<usar.Results in {self.path}>"


def sweep(
    file: Union[str, os.PathLike[str], _usar.Scenario],
    policies: Optional[Policies] = None,
    trials: Optional[int] = None,
    *,
    out: Union[str, os.PathLike[str], None] = None,
    jobs: Optional[int] = None,
    first_seed: Optional[int] = None,
    set: Optional[Mapping[str, Any]] = None,
    progress: Union[bool, Callable[[int, int], None]] = True,
    frames: Optional[str] = None,
    allow_programs: bool = False,
) -> Results:
    """Run paired trials of several policies.

    `file` is a scenario, the path of a scenario or a sweep file, or the name of one that the package has.
    `policies` is a list, or a dict from names in tables to policies; without it, those of the file. With
    `out`, finished trials stay there, and the same call goes on where it was interrupted or a policy
    raised an exception; without it, they last as long as the results. `jobs` is the number of threads that
    run trials; a policy in Python answers all of them on the thread that called `sweep`. `progress` prints a
    line on stderr, or is called with the numbers of trials that are done and that there are. Policies of
    a sweep file that are programs are started only with `allow_programs`, or if you have allowed them before.

    >>> import usar
    >>> def by_id(question):
    ...     ids = [[m["id"] for m in question["members"] if m["role"] == r] for r in range(3)]
    ...     sizes = [quota["members"] for quota in question["quotas"]]
    ...     return [[ids[r].pop() for r in range(3) for _ in range(sizes[r][task])] for task in range(2)]
    >>> short = usar.Scenario.builtin("paper").set(duration_s=60)
    >>> results = usar.sweep(short, policies=[by_id, "DIS"], trials=2, progress=False, frames="lists")
    >>> [(row["policy"], row["trial"]) for row in results.trials]
    [('by_id', 1), ('by_id', 2), ('DIS', 1), ('DIS', 2)]
    """
    if jobs is not None:
        counted("jobs", jobs, MOST_THREADS)
    _checked(frames)
    tell = _Line() if progress is True else progress or None
    if tell is not None and not callable(tell):
        raise TypeError(f"progress must be true, false or a function of two numbers, found {progress!r}")
    folder = _Folder() if out is None else None
    path = folder.path / "results" if folder else Path(out or "")
    if isinstance(file, _usar.Scenario):
        file, set = file.set(**(set or {})), None
    settings = [f"{field}={_usar.ron(value)}" for field, value in (set or {}).items()]
    listed = None if policies is None else _listed(policies)
    try:
        _usar.sweep(file, listed, trials, first_seed, settings, path, jobs, tell, allow_programs)
    finally:
        if isinstance(tell, _Line):
            tell.end()
    results = Results(path, frames)
    results._folder = folder
    with (path / "trials.csv").open(newline="") as table:
        failed = sum(row["status"] in ("failed", "panicked", "timed_out") for row in csv.DictReader(table))
    if failed:
        with contextlib.suppress(ValueError):  # a closed stderr
            told = f"{failed} trials failed: the column status of results.trials has them"
            warnings.warn(told, stacklevel=2)
    return results


def compare(
    results: Union[Results, str, os.PathLike[str]],
    metrics: Iterable[str] = (),
    baseline: Optional[str] = None,
    margins: Optional[Mapping[str, float]] = None,
) -> list[dict[str, Any]]:
    """Compare the policies of a sweep pair by pair, as `usar compare` does.

    Each comparison has `metric`, `a`, `b`, `mean_a`, `mean_b`, `difference`, its 95 % `interval`, `p_holm`,
    the `verdict`, and a sentence `in_words`. `margins` are the largest differences that do not matter.
    """
    chosen = [word for metric in metrics for word in ("--metric", metric)]
    chosen += ["--baseline", baseline] if baseline else []
    chosen += [word for metric, most in (margins or {}).items() for word in ("--margin", f"{metric}={most}")]
    printed = _command("compare", str(_path(results)), "--json", *chosen)
    return list(json.loads(printed)["tables"].get("comparisons", []))


def report(results: Union[Results, str, os.PathLike[str]], title: Optional[str] = None) -> Path:
    """Write the page of a sweep into its folder, as `usar report` does, and return its path."""
    path = _path(results)
    _command("report", str(path), *(["--title", title] if title else []))
    return path / "report.html"


def _path(results: Union[Results, str, os.PathLike[str]]) -> Path:
    return results.path if isinstance(results, Results) else Path(results)


def _listed(policies: Policies) -> list[Any]:
    if isinstance(policies, str):
        raise TypeError(f"policies must be a list or a dict, found the text {policies!r}")
    if isinstance(policies, Mapping):
        return [given(policy, name, is_kept=True) for name, policy in policies.items()]
    return [given(policy, is_kept=True) for policy in policies]


def _command(*words: str) -> str:
    """What the command prints, in a process of its own."""
    done = subprocess.run([sys.executable, "-m", "usar", *words], capture_output=True, text=True)
    if done.returncode == 0:
        return done.stdout
    raise (ValueError if done.returncode == 2 else RuntimeError)(done.stderr.strip().removeprefix("error: "))


class _Folder:
    """A temporary folder. Copies of results share it, and pickled results have its files.

    The process that made it deletes it once no results need it.
    """

    def __init__(self, files: Optional[Mapping[str, bytes]] = None) -> None:
        self.path = Path(tempfile.mkdtemp(prefix="usar-"))
        weakref.finalize(self, _delete, self.path, os.getpid())
        for name, content in (files or {}).items():
            file = self.path / name
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_bytes(content)

    def __deepcopy__(self, memo: Any) -> _Folder:
        return self

    def __reduce__(self) -> Any:
        files = (file for file in self.path.rglob("*") if file.is_file())
        return _Folder, ({file.relative_to(self.path).as_posix(): file.read_bytes() for file in files},)


def _delete(path: Path, maker: int) -> None:
    if os.getpid() == maker:  # the child of a process that forks has its objects as well
        shutil.rmtree(path, ignore_errors=True)


class _Line:
    """Progress as a line on stderr, rewritten on a terminal and written once at the end elsewhere.

    A stderr that is not there, or takes nothing, loses the line and never the sweep.
    """

    def __init__(self) -> None:
        self._last = ""

    def __call__(self, done: int, of: int) -> None:
        self._last = f"{done} of {of} trials are done"
        self._write(f"\r{self._last}", "")

    def end(self) -> None:
        """Take the line away, or write it."""
        self._write("\r\x1b[K", f"{self._last}\n" if self._last else "")

    def _write(self, on_a_terminal: str, elsewhere: str) -> None:
        with contextlib.suppress(Exception):
            sys.stderr.write(on_a_terminal if sys.stderr.isatty() else elsewhere)
            sys.stderr.flush()


def counted(name: str, count: int, most: int) -> int:
    """A count that is from 1 to the most."""
    if not 1 <= count <= most:
        raise ValueError(f"{name} must be from 1 to {most}, found {count}")
    return count


def _checked(frames: Optional[str]) -> Optional[str]:
    if frames not in (None, "pandas", "polars", "lists"):
        raise ValueError(f'frames must be "pandas", "polars" or "lists", found {frames!r}')
    return frames


def _is_there(module: str) -> bool:
    return importlib.util.find_spec(module) is not None


def _value(text: str) -> Any:
    if re.fullmatch(r"-?\d+", text):
        return int(text)
    if re.fullmatch(r"-?\d+(\.\d+)?([eE][+-]?\d+)?", text):
        return float(text)
    return text or None
