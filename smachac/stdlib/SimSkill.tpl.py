{% block imports %}
from smachac import sim
{% endblock %}
{% block defs %}
def outcome_of(state, result):
    """The outcome of a skill; the reason is logged when it did not succeed."""
    if result.outcome == "preempted":
        state.service_preempt()
    if result.outcome != "succeeded":
        smach.logwarn(f"{type(state).__name__}: {result.reason}")
    return result.outcome


def optional(userdata, key):
    """The value under a key that may be absent, else None."""
    if key in userdata:
        return userdata[key]
    return None
{% endblock %}
{% block class_defs %}{% endblock %}
