{% extends "State.tpl.py" %}
{% set callback = request_cb if request_cb is defined else none %}
{% set is_set_later = callback is not none or request_slots is defined and request_slots is not none or request is defined and request is not none and request is not mapping %}
{% block imports %}
{{ super() }}
{{ service | ros_import("srv") }}
{% if request is mapping %}
from smachac.runtime.smach_ros2.message_fields import filled
{% endif %}
{% if is_set_later %}
from smachac.runtime.smach_ros2.message_fields import checking
{% endif %}
{% endblock imports %}
{% block body %}
{% set class = service | ros_class("srv") %}
{% if is_set_later %}{% set checks = callback | checking(class ~ ".Request") %}{% endif %}
{{ add("smach_ros.ServiceState", "node" | code, service_namespace, class,
       request=request | ros_fields(service, "srv", "Request") | ros_code(service, "srv"),
       request_slots=request_slots, request_cb=checks, response_slots=response_slots,
       response_cb=response_cb | exptostr | code, input_keys=input_keys | besides(request_slots, request_cb, response_cb),
       output_keys=output_keys | besides(response_slots, request_cb, response_cb)) }}
{% endblock body %}
