from pathlib import Path

import pytest

from tmpud.errors import RequestError
from tmpud.experiments.trials.grid import Route
from tmpud.experiments.trials.sweep import read_sweep

FULL = """
maps: millbrook
missions: [paper, "random:2", {from: park1e_0, to: high4n, via: mill4n}]
traffic: {light: 40, heavy: 200}
algorithms: [tmpud, threshold(0.3)]
presets: [tmpud, "tmpud:gamma=1500"]
seeds: 5..8
"""


def written(folder: Path, text: str) -> Path:
    file = folder / "sweep.yaml"
    file.write_text(text, encoding="utf-8")
    return file


def test_a_file_is_the_grid_it_describes(tmp_path: Path) -> None:
    grid = read_sweep(written(tmp_path, FULL))
    assert grid.missions == ("paper", "random:2", Route("park1e_0", "high4n", ("mill4n",)))
    assert grid.traffic == {"light": 40, "heavy": 200}
    assert grid.seeds == (5, 6, 7, 8)
    assert grid.presets == ("tmpud", "tmpud:gamma=1500")


def test_counts_of_vehicles_name_their_conditions(tmp_path: Path) -> None:
    assert read_sweep(written(tmp_path, "traffic: [50, 60]")).traffic == {"50 vehicles": 50, "60 vehicles": 60}


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("seed: 3", "seed: no such key; keys are maps, missions"),
        ("traffic: {heavy: many}", "traffic.heavy: "),
        ("traffic: {heavy: -1}", "traffic.heavy: "),
        ("missions: [{from: park1e_0}]", "missions.0.to: "),
        ("seeds: [1, x]", "seeds.1: "),
        ("seeds: [1, 1]", "1 stands there twice"),
        ("seeds: 0..100000", "100,001 seeds; at most 100,000"),
        ("seeds: 5..3", "seeds: "),
        ("algorithms: []", "algorithms: "),
        ("algorithms: [best]", "'best'"),
        ("maps: nowhere", "nowhere"),
        ("- a list", "not a mapping"),
        ("maps: !!python/object/apply:os.system [id]", "sweep.yaml:1: "),
        ("maps: [", "sweep.yaml:"),
        ("presets: tmpud:gamma", "gamma"),
    ],
)
def test_what_is_wrong_is_said_in_one_line_with_its_place(tmp_path: Path, text: str, said: str) -> None:
    with pytest.raises(RequestError) as caught:
        read_sweep(written(tmp_path, text))
    assert said in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_file_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(RequestError, match=r"none\.yaml"):
        read_sweep(tmp_path / "none.yaml")
