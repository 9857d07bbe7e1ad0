{% block meta %}
name: Greet
description: Greets somebody.
language: Python
type: State
variables:
- greeting:
    description: What to say.
    type: str
- - volume:
      description: How loud.
      type: int
input_keys:
- who:
    description: Whom.
outcomes:
- succeeded
- aborted
{% endblock meta %}
{% from "words.tpl" import shout %}
{% block imports %}
{% if 'import_sys' not in defined_headers %}
{% do defined_headers.append('import_sys') %}
import sys
{% endif %}
{% endblock imports %}
{% block class_defs %}
{% if 'class_Greet' not in defined_headers %}
{% do defined_headers.append('class_Greet') %}
class Greet(smach.State):
    def __init__(self, greeting):
        smach.State.__init__(self, outcomes=['succeeded', 'aborted'], input_keys=['who'])
        self.greeting = greeting

    def execute(self, userdata):
        sys.stdout.write(self.greeting + ' ' + userdata.who + '\n')
        return 'succeeded'
{% endif %}
{% endblock class_defs %}
{% block header_userdata %}
{% if userdata is defined %}
{{ parent_sm_name }}.userdata.who = '{{ userdata.who }}'
{% endif %}
{% endblock header_userdata %}
{% block body %}
smach.{{ parent_type }}.add('{{ name }}', Greet('{{ shout(greeting) }}'),
                       transitions={{ transitions }})
{% endblock body %}
