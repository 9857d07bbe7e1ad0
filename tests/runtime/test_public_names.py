"""The public names of the bundled runtime (rule E3)."""

import smachac.runtime.smach as by_path
from smachac.runtime import smach

CLASSES = [
    "State",
    "CBState",
    "UserData",
    "Remapper",
    "Container",
    "StateMachine",
    "Sequence",
    "Concurrence",
    "Iterator",
    "InvalidTransitionError",
    "InvalidStateError",
    "InvalidConstructionError",
    "InvalidUserCodeError",
    "CBInterface",
]
FUNCTIONS = [
    "set_loggers",
    "loginfo",
    "logwarn",
    "logerr",
    "logdebug",
    "is_shutdown",
    "set_shutdown_check",
    "has_smach_interface",
    "cb_interface",
]
MODULES = ["state", "container", "user_data", "util", "log", "exceptions"]


def test_both_import_forms_give_the_same_package() -> None:
    assert by_path is smach


def test_public_names() -> None:
    for name in CLASSES:
        assert isinstance(getattr(smach, name), type), name
    for name in FUNCTIONS:
        assert callable(getattr(smach, name)), name
    for name in MODULES:
        assert getattr(smach, name).__name__ == f"smachac.runtime.smach.{name}"
    assert set(CLASSES + FUNCTIONS + MODULES) <= set(smach.__all__)


def test_the_base_error_is_in_the_submodule_only() -> None:
    assert not hasattr(smach, "SmachError")
    assert issubclass(smach.InvalidStateError, smach.exceptions.SmachError)
