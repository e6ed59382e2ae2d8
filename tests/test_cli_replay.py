from dataclasses import replace
from pathlib import Path

from tests.experiments.made_results import GRID, made_results
from tests.test_cli import in_a_process


def test_a_trial_is_driven_again_for_its_replay_and_what_differs_is_said(tmp_path: Path) -> None:
    grid = replace(GRID, traffic={"few": 3}, algorithms=("tmpud",), seeds=(1,))
    made_results(tmp_path / "results" / "made", grid)
    done = in_a_process(tmp_path, "replay", "results/made", "--trial", "few/00000/tmpud")
    assert "not the same as what was kept: distance: 110.0 was kept" in done.err
    assert "wrote runs/made-few-00000-tmpud/replay.html" in done.out
    unknown = in_a_process(tmp_path, "replay", "results/made", "--trial", "few/00001/tmpud")
    assert "no trial 'few/00001/tmpud' has ended here; one is called few/00000/tmpud" in unknown.refusal
