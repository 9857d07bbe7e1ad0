"""The distributions of ROS 2 that the packages installed by pip belong to.

PyPI has the packages of several distributions under one name, and pip installs those of two beside
each other: a node then cannot start.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from importlib.metadata import Distribution, distributions

RELEASES: tuple[tuple[str, Mapping[str, str]], ...] = (
    ("rclpy", {"3.3": "Humble", "7.1": "Jazzy", "9.1": "Kilted"}),
    ("rmw-fastrtps-cpp", {"6.2": "Humble", "8.4": "Jazzy", "9.3": "Kilted"}),
    ("action-msgs builtin-interfaces lifecycle-msgs rcl-interfaces rosgraph-msgs test-msgs",
     {"1.2": "Humble", "2.0": "Jazzy", "2.3": "Kilted"}),
    ("rosidl-parser rosidl-runtime-c", {"3.1": "Humble", "4.6": "Jazzy", "4.9": "Kilted"}),
    ("actionlib-msgs diagnostic-msgs geometry-msgs nav-msgs sensor-msgs shape-msgs std-msgs "
     "std-srvs stereo-msgs trajectory-msgs visualization-msgs",
     {"4.9": "Humble", "5.3": "Jazzy", "5.5": "Kilted"}),
)  # fmt: skip
"""Packages, and the distributions of their versions, by major and minor number."""


def installed_distributions(
    packages: Iterable[Distribution] | None = None,
) -> dict[str, list[str]]:
    """The packages of ROS 2, with their versions, by the distribution that they belong to; both in
    alphabetical order. Packages of other versions are in none."""
    releases = {f"ros-{name}": known for names, known in RELEASES for name in names.split()}
    found: dict[str, set[str]] = {}
    for package in distributions() if packages is None else packages:
        name = (package.metadata["Name"] or "").lower().replace("_", "-")
        release = ".".join(package.version.split(".")[:2])
        distribution = releases.get(name, {}).get(release)
        if distribution is not None:
            found.setdefault(distribution, set()).add(f"{name} {package.version}")
    return {distribution: sorted(found[distribution]) for distribution in sorted(found)}
