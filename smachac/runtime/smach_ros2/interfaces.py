"""The classes of messages, services and actions by their names."""

from __future__ import annotations

from importlib import import_module
from typing import Any


def message_class(name: str) -> Any:
    """The message `pkg/Type` or `pkg/msg/Type`. Raises ImportError with the package."""
    return _load(name, "msg")


def service_class(name: str) -> Any:
    """The service `pkg/Type` or `pkg/srv/Type`. Raises ImportError with the package."""
    return _load(name, "srv")


def action_class(name: str) -> Any:
    """The action `pkg/Type` or `pkg/action/Type`. Raises ImportError with the package."""
    return _load(name, "action")


def _load(name: str, kind: str) -> Any:
    package, *middle, type_name = name.split("/")
    if middle not in ([], [kind]):
        raise ImportError(f"`{name}` is not the name of a type in {kind}")
    module = import_module(f"{package}.{kind}")
    if not hasattr(module, type_name):
        raise ImportError(f"the package {package} has no {kind}/{type_name}")
    return getattr(module, type_name)
