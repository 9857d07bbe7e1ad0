{% block body %}
{% if notes %}{{ notes }}
{% endif %}{{ construct }}
{% for line in presets %}{{ line }}
{% endfor %}with {{ sm_name }}:
{{ children }}
{% for line in after %}{{ line }}
{% endfor %}
{{ add }}
{% endblock %}
