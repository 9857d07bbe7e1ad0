{% extends "State.tpl.py" %}
{% block imports %}
{{ super() }}
{{ msg_type | ros_import("msg") }}
from smachac.runtime.smach_ros2.topics import WaitForMsgState
{% endblock imports %}
{% block body %}
{{ add("WaitForMsgState", "node" | code, topic, msg_type | ros_class("msg"), msg_cb=msg_cb | exptostr | code, output_keys=output_keys, latch=latch, timeout=timeout, qos=qos) }}
{% endblock body %}
