{% block body %}
{% if x %}
{% endblock %}
