{% extends "State.tpl.py" %}
{% if request is mapping %}{% include "MessageFields.tpl.py" %}{% endif %}
{% block imports %}
{{ super() }}
{{ service | ros_import("srv", request | ros_fields(service, "srv", "Request")) }}
{% endblock imports %}
{% block body %}
{{ add("smach_ros.ServiceState", service_namespace, service | ros_class("srv"),
       request=request | ros_fields(service, "srv", "Request") | ros_code(service, "srv"),
       request_slots=request_slots, request_cb=request_cb | exptostr | code, response_slots=response_slots,
       response_cb=response_cb | exptostr | code, input_keys=input_keys | besides(request_slots, request_cb, response_cb),
       output_keys=output_keys | besides(response_slots, request_cb, response_cb)) }}
{% endblock body %}
