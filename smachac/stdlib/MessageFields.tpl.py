{% block defs %}
def filled(message, values):
    """Set the fields of a message from a mapping, or from a list in their order."""
    if not isinstance(values, dict):
        values = dict(zip(message.__slots__, values))
    for name, value in values.items():
        field = getattr(message, name)
        if isinstance(value, (dict, list)) and hasattr(field, "__slots__"):
            value = filled(field, value)
        setattr(message, name, value)
    return message
{% endblock %}
