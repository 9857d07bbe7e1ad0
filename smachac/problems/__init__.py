"""The faults that phases before the rules find: in the text, its shape, its calls, templates."""

from smachac.problems.allowances import (
    bad_allowance,
    bad_comment,
    unfounded_allowance,
    unknown_code,
    unused_allowances,
    vain_allowance,
)
from smachac.problems.calls import (
    bad_robot,
    bad_sub_script,
    recursive_include,
    script_not_found,
    template_error,
    template_not_found,
    unresolved_look_up,
)
from smachac.problems.targets import (
    interfaces_differ,
    no_code_for_target,
    stale_code,
    unsupported_by_target,
)
from smachac.problems.templates import defined_twice, python_2_code
from smachac.problems.text import (
    bad_type,
    duplicate_key,
    missing_variable,
    too_big,
    undefined_name,
    unknown_variable,
    unreadable_file,
    wrong_shape,
    yaml_syntax,
)
from smachac.problems.wording import listed

__all__ = [
    "bad_allowance",
    "bad_comment",
    "bad_robot",
    "bad_sub_script",
    "bad_type",
    "defined_twice",
    "duplicate_key",
    "interfaces_differ",
    "listed",
    "missing_variable",
    "no_code_for_target",
    "python_2_code",
    "recursive_include",
    "script_not_found",
    "stale_code",
    "template_error",
    "template_not_found",
    "too_big",
    "undefined_name",
    "unfounded_allowance",
    "unknown_code",
    "unknown_variable",
    "unreadable_file",
    "unresolved_look_up",
    "unsupported_by_target",
    "unused_allowances",
    "vain_allowance",
    "wrong_shape",
    "yaml_syntax",
]
