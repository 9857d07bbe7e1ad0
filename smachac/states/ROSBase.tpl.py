{% extends "Base.tpl.py" %}
{% block imports %}
{% if "import threading" not in imports %}import threading
{% endif %}
{% if "import rospy" not in imports %}import rospy{% endif %}
{{ super() }}
{% endblock imports %}
{% block node %}
    rospy.init_node({{ node_name | default(name) | literal }})
{% endblock node %}
{% block execute %}
    rospy.on_shutdown(threading.Thread(target={{ sm_name }}.request_preempt, daemon=True).start)
{{ super() }}
{% endblock execute %}
