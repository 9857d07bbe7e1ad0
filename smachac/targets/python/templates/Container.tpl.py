{% block body %}
# {{ place }}
{{ construct }}
{% for line in presets %}{{ line }}
{% endfor %}with {{ sm_name }}:
{{ children }}
{% for line in after %}{{ line }}
{% endfor %}
{{ add }}
{% endblock %}
