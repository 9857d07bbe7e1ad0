{% extends "State.tpl.py" %}
{% include "WaitForMsg.tpl.py" %}
{% block imports %}
{{ super() }}
{{ msg_type | ros_import("msg") }}
{% endblock imports %}
{% block body %}
{{ add(class_name, topic, msg_type | ros_class("msg"), msg_cb=msg_cb | exptostr | code, output_keys=output_keys, latch=latch, timeout=timeout) }}
{% endblock body %}
