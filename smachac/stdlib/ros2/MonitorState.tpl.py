{% extends "State.tpl.py" %}
{% block imports %}
{{ super() }}
{{ msg_type | ros_import("msg") }}
{% endblock imports %}
{% block body %}
{% if max_checks is defined and max_checks is not none %}{% set most = max_checks %}{% endif %}
{{ add("smach_ros.MonitorState", "node" | code, topic, msg_type | ros_class("msg"), cond_cb | exptostr | code, max_checks=most, input_keys=input_keys, output_keys=output_keys, timeout=timeout, qos=qos) }}
{% endblock body %}
