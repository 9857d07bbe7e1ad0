{% block meta %}
name: Load
type: Container
{% endblock %}
{% block class_defs %}
class Load(smach.State):
    def __init__(self, name, path):
        smach.State.__init__(self, outcomes=['succeeded'])
        rospy.Publisher('x')
{% endblock %}
{% block body %}
smach.{{ parent_type }}.add('{{ name }}', Load({% if model_name is not_string %}{{ model_name }}{% else %}'{{ model_name }}'{% endif %}, {% if model_path is not_string %}{{ model_path }}{% else %}'{{ model_path }}'{% endif %}), transitions={{ transitions }})
{% endblock body %}
{% block execute %}
rospy.on_shutdown(lambda: delete('{{ model_name }}'))
{% endblock execute %}
