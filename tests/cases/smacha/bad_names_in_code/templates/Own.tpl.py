{% extends "State.tpl.py" %}
{% block class_defs %}
class Own(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=['done'])
        self.word = '{{ word }}'

    def execute(self, userdata):
        return 'done'
{% endblock %}
{% block body %}
smach.StateMachine.add('{{ name }}', Own(), transitions={{ transitions }})
{% endblock %}
