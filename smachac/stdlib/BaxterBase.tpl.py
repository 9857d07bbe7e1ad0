{% extends "PyBulletBase.tpl.py" %}
{%- block imports %}{{ super() }}
from smachac.sim.gazebo import Point, Pose, Quaternion, rospkg  # noqa: F401
{%- endblock %}
{%- block robot %}{{ robot | default("baxter") | literal }}{% endblock %}
