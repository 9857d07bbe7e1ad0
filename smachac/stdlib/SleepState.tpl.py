{% block imports %}
import threading
from typing import Any
{% endblock %}
{% block class_defs %}
{{ "SleepState" | addition }}
{% endblock %}
