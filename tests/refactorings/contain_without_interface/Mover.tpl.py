{% block imports %}
from movers import Mover
{% endblock imports %}

{% block body %}
smach.{{ parent_type }}.add("{{ name }}", Mover(output_keys=["place"]), transitions={{ transitions }}, remapping={{ remapping }})
{% endblock body %}
