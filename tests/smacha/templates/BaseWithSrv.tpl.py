{% extends "ROSBase.tpl.py" %}

{% from "Utils.tpl.py" import from_import %}

{% block imports %}
{{ super() }}
{{ from_import(defined_headers, 'my_msgs.srv', 'GripperSrv') }}
{{ from_import(defined_headers, 'my_msgs.srv', 'GripperSrvRequest') }}
{{ from_import(defined_headers, 'geometry_msgs.msg', '*') }}
{% endblock imports %}

{% block defs %}
{{ super() }}
def gripper_srv(req):
    return True
{% endblock defs %}

{% block main_def %}
{{ super() }}
    # Register a service
    s = rospy.Service('gripper_srv', GripperSrv, gripper_srv)
{% endblock main_def %}

{% block base_footer %}
{{ super() }}
    rospy.signal_shutdown('All done.')
{% endblock base_footer %}
