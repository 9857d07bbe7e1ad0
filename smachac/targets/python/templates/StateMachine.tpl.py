{% block body %}
# {{ place }}
{{ construct }}
{% for line in userdata %}{{ line }}
{% endfor %}with {{ sm_name }}:
{{ children }}
{% for line in after %}{{ line }}
{% endfor %}
{{ add }}
{% endblock %}
