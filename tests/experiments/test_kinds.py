"""What an experiment's folder says, as a notebook shows it."""

from __future__ import annotations

import xml.etree.ElementTree as ET  # of our own making

import numpy as np
import pytest

from tests.experiments.planted import planted
from tests.viewer.hostile import NAMES
from tmpud.experiments.kinds import KINDS, Findings
from tmpud.experiments.reports.analysis import analyse
from tmpud.experiments.running.store import Results


def found(name: str) -> Findings:
    manifest = {
        "begun": name,
        "options": {name: name},
        "versions": {name: name},
        "code": name,
        "command": name,
        "tasks": {"count": 0, "digest": name},
    }
    kind = KINDS["table1"]
    rows = planted(20, seed=1)
    analysis = analyse(rows, kind.reference, np.random.default_rng(1), resamples=50)
    return Findings(kind=kind, results=Results(manifest, (), ()), rows=tuple(rows), analysis=analysis)


@pytest.mark.parametrize("name", ["plain", NAMES[0], NAMES[4]])
def test_results_show_their_tables_and_their_picture(name: str) -> None:
    shown = found(name)._repr_html_()
    page = ET.fromstring(f"<div>{shown}</div>")  # noqa: S314 - our own
    tags = [element.tag.rpartition("}")[2] for element in page.iter()]
    assert tags.count("table") >= 2
    assert tags.count("svg") == 1
    assert "script" not in tags
    heads = [heading.text for heading in page.iter("h2")]
    assert {"Verdicts", "Results", "Claims"} <= set(heads)
