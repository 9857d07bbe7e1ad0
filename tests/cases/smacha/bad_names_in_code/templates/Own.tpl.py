{% extends "State.tpl.py" %}
{% block class_defs %}
class Own(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=['done'])
        self.word = '{{ word }}'
{% endblock %}
{% block body %}
smach.StateMachine.add('{{ name }}', Own(), transitions={{ transitions }})
{% endblock %}
