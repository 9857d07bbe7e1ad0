{% extends "State.tpl.py" %}
{% block imports %}
{{ super() }}
{{ service | ros_import("srv") }}
{% if request is mapping %}
from smachac.runtime.smach_ros2.message_fields import filled
{% endif %}
{% endblock imports %}
{% block body %}
{% set class = service | ros_class("srv") %}
{{ add("smach_ros.ServiceState", "node" | code, service_namespace, class,
       request=request | ros_fields(service, "srv", "Request") | ros_code(service, "srv"),
       request_slots=request_slots, request_cb=request_cb | exptostr | code, response_slots=response_slots,
       response_cb=response_cb | exptostr | code, input_keys=input_keys, output_keys=output_keys) }}
{% endblock body %}
