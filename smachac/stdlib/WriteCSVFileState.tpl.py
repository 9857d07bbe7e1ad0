{% block imports %}
import csv
{% endblock %}
{% block defs %}
def columns(name, value, ignored):
    """Pairs of column name and value; each field of a message is one column."""
    fields = getattr(value, "__slots__", None)
    if fields is None or isinstance(value, (str, int, float)):
        return [(name, value)]
    found = []
    for field in fields:
        if field not in ignored:
            found += columns(f"{name}_{field}", getattr(value, field), ignored)
    return found
{% endblock %}
{% block class_defs %}
class WriteCSVFileState(smach.State):
    """Writes values of userdata keys to one row of a CSV file.

    If the only value is a list, each item of the list is one row.
    """

    def __init__(self, delimiter=",", input_keys=("file", "data_keys"), output_keys=()):
        super().__init__(
            outcomes=["succeeded", "aborted"],
            input_keys=list(input_keys),
            output_keys=list(output_keys),
        )
        self.delimiter = delimiter

    def execute(self, userdata):
        try:
            rows = self.rows(userdata)
            names = [name for name, _ in rows[0]] if rows else []
            header = userdata["header"] if "header" in userdata else names
            with open(userdata["file"], "w", newline="", encoding="utf-8") as file:
                writer = csv.writer(file, delimiter=self.delimiter)
                writer.writerow(header)
                writer.writerows([value for _, value in row] for row in rows)
        except (KeyError, OSError) as error:
            smach.logwarn(f"the CSV file cannot be written: {error}")
            return "aborted"
        if "header" in self.get_registered_output_keys():
            userdata["header"] = header
        return "succeeded"

    def rows(self, userdata):
        """The rows as lists of pairs of column name and value."""
        ignored = userdata["ignore"] if "ignore" in userdata else ["header"]
        keys = userdata["data_keys"]
        values = [(key, userdata[key]) for key in keys]
        if len(values) == 1 and isinstance(values[0][1], (list, tuple)):
            key, items = values[0]
            return [columns(key, item, ignored) for item in items]
        return [[pair for key, value in values for pair in columns(key, value, ignored)]]
{% endblock %}
