{% extends "Base.tpl.py" %}
{% block imports %}
{% if "import rospy" not in imports %}import rospy{% endif %}
{{ super() }}
{% endblock imports %}
{% block node %}
    rospy.init_node({{ node_name | default(name) | literal }})
{% endblock node %}
