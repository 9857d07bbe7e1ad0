{% extends "Base.tpl.py" %}
{% set is_node = true %}
{% block imports %}
{% if "import threading" not in imports %}import threading
{% endif %}
{% if "import rospy" not in imports %}import rospy{% endif %}
{{ super() }}
{% endblock imports %}
