{% extends "Base.tpl.py" %}
{% block imports %}
{{ super() }}
import tools
{% endblock %}
