import subprocess
import sys
from pathlib import Path

from tmpud.events import Estimated, Finished, Planned, Refused
from tmpud.recording import read_run


def test_the_demo_changes_its_plan_for_a_low_safe_and_arrives(tmp_path: Path) -> None:
    folder = tmp_path / "demo"
    command = [str(Path(sys.executable).parent / "tmpud"), "demo", "--out", str(folder)]
    words = subprocess.run(command, check=True, capture_output=True, text=True, timeout=300).stdout
    events = list(read_run(folder))
    plan_a, plan_b, *_ = (event for event in events if isinstance(event, Planned))
    refused = next(event for event in events if isinstance(event, Refused))
    assert refused.step == plan_a.plan[0]
    assert refused.step not in plan_b.plan
    assert refused.safe == next(event for event in events if isinstance(event, Estimated)).safe < 0.5
    assert next(event for event in events if isinstance(event, Finished)).status == "SUCCESS"
    assert "plan A" in words
    assert "plan B" in words
    assert {file.name for file in folder.iterdir()} == {"run.jsonl.gz", "timing.jsonl", "map.png"}
    assert (folder / "map.png").read_bytes().startswith(b"\x89PNG")
