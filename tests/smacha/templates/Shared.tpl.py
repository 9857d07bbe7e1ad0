{% block imports %}
import heapq
{% endblock imports %}

{% block class_defs %}
{% if 'class_Shared' not in defined_headers %}
class Shared:
    """A helper that states share; no state itself."""
    def __init__(self):
        self.items = []
{% do defined_headers.append('class_Shared') %}{% endif %}
{% endblock class_defs %}
