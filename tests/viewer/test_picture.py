from pathlib import Path

from tests.viewer.made_runs import recorded
from tmpud.events import Refused
from tmpud.recording import read_run
from tmpud.roads.loading import load_map
from tmpud.viewer.picture import LOW, draw_run


def test_an_estimate_that_changed_the_plan_is_shown_close_by(tmp_path: Path) -> None:
    events = list(read_run(recorded(tmp_path / "run")))
    assert [event.safe >= LOW for event in events if isinstance(event, Refused)] == [True]
    draw_run(load_map("millbrook"), events, tmp_path / "map.svg")
    drawn = (tmp_path / "map.svg").read_text(encoding="utf-8")
    assert "Safe(mergeleft) = 0.50" in drawn
