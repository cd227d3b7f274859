"""Policies of all kinds, as the native half takes them."""

from __future__ import annotations

import hashlib
import inspect
import os
import pickle
import re
from dataclasses import dataclass
from typing import Any, Callable, Optional, Union

from ._types import Policy


@dataclass
class Own:
    """A policy in Python."""

    name: str
    decide: Callable[[Any], Any]
    act: Optional[Callable[[Any], Any]]
    fingerprint: str
    deterministic: bool


def given(policy: Policy, name: Optional[str] = None, is_kept: bool = False) -> Union[str, Own]:
    """The policy under this name, or under its own; with a fingerprint if its trials are kept."""
    if isinstance(policy, str):
        return policy if name in (None, policy) else f"{name}={policy}"
    decide: Any = getattr(policy, "decide", policy)
    if not callable(decide):
        raise TypeError(
            "a policy is a name, a function from a question to groups, or an object with a method "
            f"`decide`, found {policy!r}"
        )
    own = name or getattr(policy, "name", None) or getattr(policy, "__name__", None) or type(policy).__name__
    if not re.fullmatch(r"[A-Za-z_][A-Za-z0-9_.-]*", str(own)):
        raise ValueError(
            f"a policy in Python needs a name of letters, digits, `_`, `.` and `-`, found {own!r}; "
            'give it one with policies={"name": policy}, or an attribute `name`'
        )
    deterministic = bool(getattr(policy, "deterministic", True))
    return Own(str(own), decide, getattr(policy, "act", None), _fingerprint(policy) if is_kept else "", deterministic)


def _fingerprint(policy: Any) -> str:
    """A text that changes with the policy's source, its version and its values; always, if those cannot tell."""
    is_plain = inspect.isroutine(policy) or inspect.isclass(policy)
    try:
        source = inspect.getsource(policy if is_plain else type(policy))
        text = f"{source}\n{getattr(policy, 'version', '')}".encode() + pickle.dumps(_values(policy))
    except Exception:  # typed at a prompt, not in Python, or values that cannot be written
        text = os.urandom(16)
    return "python " + hashlib.sha256(text).hexdigest()[:32]


def _values(policy: Any) -> list[Any]:
    """What a function or an object has beside its source."""
    function = getattr(policy, "__func__", policy)
    closed = [cell.cell_contents for cell in getattr(function, "__closure__", None) or ()]
    defaults = [getattr(function, name, None) for name in ("__defaults__", "__kwdefaults__")]
    owner = getattr(policy, "__self__", policy)
    return [closed, defaults, None if inspect.isclass(owner) else getattr(owner, "__dict__", None)]
