"""JUnit XML report for GitLab, Jenkins and others: one test for each script.

It has only what junit-10.xsd of Jenkins' xUnit plugin allows.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from xml.etree import ElementTree as ET

from smachac.diagnostics.diagnostic import Report
from smachac.report.terminal import on_one_line
from smachac.report.text import render_text, summary

# XML 1.0 (fifth edition), section 2.2: all but these are characters.
_NO_XML = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


def render_junit(reports: Mapping[str, Report], failing: Mapping[str, Report]) -> str:
    """One test for each script of `reports`; it fails if `failing` has findings for it.

    Other findings are printed in the output of the test. The report contains no time stamps.
    """
    suite = ET.Element("testsuite", name="smachac check")
    suite.set("tests", str(len(reports)))
    suite.set("failures", str(sum(bool(failing.get(name)) for name in reports)))
    suite.set("errors", "0")
    whole = ET.Element("testsuites", dict(suite.items()))
    whole.set("name", "smachac")
    whole.append(suite)
    suite.set("skipped", "0")
    for name, report in reports.items():
        shown = xml_text(on_one_line(name))
        test = ET.SubElement(suite, "testcase", name=shown, classname="smachac.check")
        failing_items = failing.get(name, [])
        if failing_items:
            codes = dict.fromkeys(item.code for item in failing_items)
            failure = ET.SubElement(test, "failure", message=xml_text(summary(failing_items)))
            failure.set("type", " ".join(codes))
            failure.text = "\n" + xml_text(render_text(failing_items))
        ids = {id(item) for item in failing_items}
        mild = [item for item in report if id(item) not in ids]
        if mild:
            ET.SubElement(test, "system-out").text = "\n" + xml_text(render_text(mild))
    ET.indent(whole)
    return '<?xml version="1.0" encoding="utf-8"?>\n' + ET.tostring(whole, "unicode") + "\n"


def xml_text(text: str) -> str:
    """A text without the characters that XML does not allow."""
    return _NO_XML.sub(lambda found: f"<U+{ord(found.group()):04X}>", text)
