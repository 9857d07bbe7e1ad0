{% block imports %}
from smachac import sim
{% endblock %}
{% block defs %}
def outcome_of(state, result):
    """The outcome of a skill; unless it is `succeeded`, the reason is logged."""
    if result.outcome == "preempted":
        state.service_preempt()
    if result.outcome != "succeeded":
        smach.logwarn(f"{type(state).__name__}: {result.reason}")
    return result.outcome


def optional(userdata, key):
    """The value of a userdata key, or None if the key is absent."""
    if key in userdata:
        return userdata[key]
    return None
{% endblock %}
{% block class_defs %}{% endblock %}
