"""What every test run shares: examples that repeat, no silent skip where all must be there."""

from __future__ import annotations

import compileall
import gc
import importlib.metadata
import os
import re
import signal
import sys
from collections.abc import Generator, Iterator
from contextlib import AbstractContextManager
from functools import cache, partialmethod
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from hypothesis import settings

from smachac.commands import memory
from tests.browser import pages
from tests.ros.ros_graph import Graph, missing
from tests.ros2 import ros2_graph
from tests.support.examples import ALL, SOME
from tests.support.silent_smach import silent_smach

if TYPE_CHECKING:
    from playwright.sync_api import Browser

# A shell starts background jobs with SIGINT ignored; the tests send and raise SIGINT.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)

settings.register_profile("all", derandomize=True, deadline=None, print_blob=True, max_examples=ALL)
settings.register_profile("some", settings.get_profile("all"), max_examples=SOME)


PACKAGE = Path(__file__).parents[1] / "smachac"
TEMPLATES = re.compile(r"\.tpl\.py$")


SELDOM = (200_000, 10, 10)
"""When garbage is collected in a process of many tests: a compiler makes many objects that live to
the end of its run, and the default of 700 takes a fifth of the time."""

KEPT_BY_TESTS = 16_000
"""In MB. The address space that a process of many tests may have taken before a test."""


@pytest.fixture(scope="session", autouse=True)
def memory_beside_other_tests() -> Iterator[None]:
    """The memory limit of a command counts the whole process: one that runs thousands of tests has
    the memory and the threads of earlier ones. At its limit Python can crash."""
    limited = memory.limited_memory

    def beside(megabytes: int) -> AbstractContextManager[None]:
        return limited(megabytes + KEPT_BY_TESTS if megabytes else 0)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(memory, "limited_memory", beside)
        yield


@pytest.fixture(scope="session", autouse=True)
def own_cache_folder(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """The cache folder of the user is left alone."""
    with pytest.MonkeyPatch.context() as patch:
        for name in ("XDG_CACHE_HOME", "LOCALAPPDATA"):
            patch.setenv(name, str(tmp_path_factory.mktemp("cache")))
        yield


@pytest.fixture(scope="session", autouse=True)
def work_done_once() -> Iterator[None]:
    """What does not change is done once: the targets are found in the metadata of all installed
    packages, and the templates compiled."""
    from smachac.targets.templates.sandbox import BoundedEnvironment
    from tests.support.compiled_templates import CompiledTemplates

    made = partialmethod(BoundedEnvironment.__init__, bytecode_cache=CompiledTemplates())
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(importlib.metadata, "entry_points", cache(importlib.metadata.entry_points))
        patch.setattr(BoundedEnvironment, "__init__", made)
        yield


def pytest_configure(config: pytest.Config) -> None:
    """Load the profile of Hypothesis; compile the package once: where PYTHONDONTWRITEBYTECODE is
    set, each command that a test starts would do it again."""
    settings.load_profile("some" if "not nightly" in config.option.markexpr else "all")
    if not hasattr(config, "workerinput"):
        compileall.compile_dir(PACKAGE, rx=TEMPLATES, quiet=1)


@pytest.hookimpl(wrapper=True)
def pytest_collection() -> Generator[None, object, object]:
    """Import the tests without garbage collection and keep them compiled; then exempt the modules
    and the tests themselves from garbage collection, which they slow down."""
    writes_no_bytecode = sys.dont_write_bytecode
    sys.dont_write_bytecode = False
    gc.disable()
    try:
        return (yield)
    finally:
        sys.dont_write_bytecode = writes_no_bytecode
        gc.enable()
        gc.collect()
        gc.freeze()
        gc.set_threshold(*SELDOM)


def _fail_if_skipped(
    report: pytest.TestReport | pytest.CollectReport, demand: str = "SMACHAC_REQUIRE_ALL"
) -> None:
    """Turn a skip into a failure where the variable `demand` says that nothing may be missing."""
    if report.outcome != "skipped" or not os.environ.get(demand):
        return
    if hasattr(report, "wasxfail"):
        return
    reason = report.longrepr[2] if isinstance(report.longrepr, tuple) else report.longrepr
    report.outcome = "failed"
    report.longrepr = f"{reason} ({demand} is set: a skip fails)"


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(
    item: pytest.Item,
) -> Generator[None, pytest.TestReport, pytest.TestReport]:
    """Judge the skip of one test; ROS is asked for on its own."""
    report = yield
    live = any(item.get_closest_marker(one) is not None for one in ("ros", "ros2"))
    _fail_if_skipped(report, "SMACHAC_REQUIRE_ROS" if live else "SMACHAC_REQUIRE_ALL")
    return report


@pytest.hookimpl(wrapper=True)
def pytest_make_collect_report() -> Generator[None, pytest.CollectReport, pytest.CollectReport]:
    """Judge the skip of a whole module."""
    report = yield
    _fail_if_skipped(report)
    return report


@pytest.fixture(name="silent_smach")
def _silent_smach() -> Iterator[None]:
    """The bundled SMACH prints no log during the test."""
    with silent_smach():
        yield


@pytest.fixture
def graph(tmp_path: Path) -> Iterator[Graph]:
    """A ROS graph that nobody else uses; without ROS the test is skipped."""
    if missing():
        pytest.skip(f"ROS is not there ({missing()}): make test-ros")
    live = Graph(tmp_path)
    try:
        yield live
    finally:
        live.stop()


@pytest.fixture
def graph2(tmp_path: Path) -> Iterator[ros2_graph.Graph]:
    """A ROS 2 domain that nobody else uses; without ROS 2 the test is skipped."""
    if ros2_graph.missing():
        pytest.skip(f"ROS 2 is not there ({ros2_graph.missing()}): make test-ros2")
    live = ros2_graph.Graph(tmp_path)
    try:
        yield live
    finally:
        live.stop()


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    """A headless Chromium; where it is not installed the test is skipped."""
    if pages.missing():
        pytest.skip(f"{pages.missing()} is not there: make test-browser")
    with pages.started_browser() as started:
        yield started
