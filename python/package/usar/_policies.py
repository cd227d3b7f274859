"""Policies of all kinds, as the native half takes them."""

from __future__ import annotations

import hashlib
import inspect
import re
from dataclasses import dataclass
from typing import Any, Callable, Optional, Union

from ._types import Policy


@dataclass
class Own:
    """A policy in Python."""

    name: str
    decide: Callable[[Any], Any]
    fingerprint: str
    deterministic: bool


def given(policy: Policy, name: Optional[str] = None) -> Union[str, Own]:
    """The policy under this name, or under its own."""
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
    return Own(str(own), decide, _fingerprint(policy), deterministic)


def _fingerprint(policy: Any) -> str:
    """A text that changes with the policy's source, its version and its public values."""
    source = policy if inspect.isroutine(policy) or inspect.isclass(policy) else type(policy)
    try:
        text = inspect.getsource(source)
    except (OSError, TypeError):  # typed at a prompt, or not in Python
        code = getattr(policy, "__code__", None)
        text = repr(policy) if code is None else f"{code.co_code!r} {code.co_consts!r} {code.co_names!r}"
    values = {} if inspect.isroutine(policy) else dict(sorted(getattr(policy, "__dict__", {}).items()))
    text = f"{text}\n{getattr(policy, 'version', '')}\n{values!r}"
    return "python " + hashlib.sha256(text.encode()).hexdigest()[:32]
