{% include "MessageClass.tpl.py" %}
{% block defs %}
def filled(message, values):
    """Set the fields of a message from a mapping, or from a list in their order.

    A number of seconds makes a time or a duration. Raises TypeError or ValueError if the values
    do not fit.
    """
    from genpy import SerializationError

    if isinstance(values, type(message)):
        return values
    types = dict(zip(message.__slots__, message._slot_types))
    if not isinstance(values, dict):
        if len(values) != len(types):
            raise ValueError(f"{message._type} has the fields {', '.join(types)}")
        values = dict(zip(types, values))
    for name, value in values.items():
        if name not in types:
            raise ValueError(f"{message._type} has no field {name}: it has {', '.join(types)}")
        item, is_list, _ = types[name].partition("[")
        field = getattr(message, name)
        if "/" in item and is_list:
            value = [filled(message_class(item)(), each) for each in value]
        elif "/" in item:
            value = filled(field, value)
        elif item in ("time", "duration") and isinstance(value, (int, float)):
            value = type(field).from_sec(value)
        setattr(message, name, value)
    try:
        message._check_types()
    except SerializationError as error:
        raise ValueError(f"{message._type}: {error}") from None
    return message
{% endblock %}
