{% extends "Base.tpl.py" %}

{% from "Utils.tpl.py" import from_import %}

{% block imports %}
{{ super() }}
{{ from_import(defined_headers, 'my_msgs.srv', 'Door') }}
{{ from_import(defined_headers, 'my_msgs.msg', 'ArmAction') }}
{{ from_import(defined_headers, 'actionlib_msgs.msg', '*') }}
{% endblock imports %}

{% block main_def %}
{{ super() }}
    door = rospy.Service('door', Door, lambda request: GoalStatus())
    arm = SimpleActionServer('arm', ArmAction, auto_start=False)
{% endblock main_def %}
