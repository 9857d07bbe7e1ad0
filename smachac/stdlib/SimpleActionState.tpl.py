{% extends "State.tpl.py" %}
{% if goal is mapping %}{% include "MessageFields.tpl.py" %}{% endif %}
{% block imports %}
{{ super() }}
{{ action | ros_import("action", goal | ros_fields(action, "action", "Goal")) }}
{% endblock imports %}
{% block body %}
{% if exec_timeout is number %}{% set longest = ("rospy.Duration(" ~ exec_timeout | literal ~ ")") | code %}{% endif %}
{% if server_wait_timeout is number %}{% set wait = ("rospy.Duration(" ~ server_wait_timeout | literal ~ ")") | code %}{% endif %}
{{ add("smach_ros.SimpleActionState", action_server_namespace, action | ros_class("action"),
       goal=goal | ros_fields(action, "action", "Goal") | ros_code(action, "action"), goal_slots=goal_slots,
       goal_cb=goal_cb | exptostr | code, result_slots=result_slots, result_cb=result_cb | exptostr | code,
       input_keys=input_keys | besides(goal_slots, goal_cb, result_cb),
       output_keys=output_keys | besides(result_slots, goal_cb, result_cb), exec_timeout=longest, server_wait_timeout=wait) }}
{% endblock body %}
