{% extends "Base.tpl.py" %}
{% block imports %}
{% if "import rospy" not in imports %}import rospy{% endif %}
{{ super() }}
{% endblock imports %}
{% block node %}
    rospy.init_node({{ node_name | default(name) | literal }})
{% endblock node %}
{% block execute %}
    rospy.on_shutdown({{ sm_name }}.request_preempt)
{{ super() }}
{% endblock execute %}
