{% block defs %}
def message_class(kind):
    """The class of a message type such as `std_msgs/Bool`. Raises ValueError without one."""
    if isinstance(kind, type):
        return kind
    from roslib.message import get_message_class

    package, *_, name = kind.replace(".", "/").split("/")
    found = get_message_class(f"{package}/{name}")
    if found is None:
        raise ValueError(f"the message type {kind} is not available")
    return found
{% endblock %}
