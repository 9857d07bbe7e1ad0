{% block body %}
# {{ place }}
{{ add }}
{% endblock %}
