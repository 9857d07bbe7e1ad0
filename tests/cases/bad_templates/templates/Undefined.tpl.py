{% block body %}
{{ nowhere }}
{% endblock %}
