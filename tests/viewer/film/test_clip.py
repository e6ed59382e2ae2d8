import pytest

from tests.viewer.made_runs import START, frame, header
from tmpud.errors import RequestError, RunFileError
from tmpud.events import Event, Judged, Refused
from tmpud.symbols import Action, State, Transition
from tmpud.viewer.film.clip import LENGTH, choose
from tmpud.viewer.intact import Intact

STEP = Transition(State("park1e_0/0", 0), Action.MERGELEFT, State("park1e_1/1", 0))


def run(frames: int = 600, *events: Event) -> Intact:
    return Intact(header(), list(events), [frame(number) for number in range(frames)])


def begin(made: Intact) -> float:
    return made.frames[0].time


def test_a_short_drive_is_shown_whole() -> None:
    clip = choose(run(100), None, None)
    assert (clip.begin, clip.end) == pytest.approx((0.0, 9.9))


@pytest.mark.parametrize("moment", [0.0, 3.0, 30.0, 58.0])
def test_of_a_long_drive_the_first_moment_of_interest_is_within_the_clip(moment: float) -> None:
    quiet = run(600)
    at = begin(quiet) + moment
    later = Judged(at + 1.0, "collision", "car1", "merge", "ego", "")
    for event in (Refused(at, STEP, 0.1, ""), Judged(at, "forced_stop", "car1", "merge", "ego", "")):
        clip = choose(run(600, event, later), None, None)
        assert 0.0 <= clip.begin <= moment < clip.end <= 60.0
        assert clip.end - clip.begin == pytest.approx(LENGTH)
    assert choose(run(600, Judged(at, "speeding", None, "limit", "ego", "")), None, None).begin == 0.0


def test_what_was_asked_for_is_shown_as_far_as_there_is_something() -> None:
    assert (choose(run(), 10.0, None).begin, choose(run(), None, 10.0).end) == (10.0, 10.0)
    assert choose(run(), 50.0, 1e9).end == pytest.approx(59.9)


@pytest.mark.parametrize(("first", "last"), [(60.0, None), (5.0, 5.0), (7.0, 3.0), (-1.0, 3.0)])
def test_a_part_that_is_none_is_refused(first: float, last: float | None) -> None:
    with pytest.raises(RequestError, match=r"the drive took 59\.9 s"):
        choose(run(), first, last)


def test_a_run_without_frames_says_so() -> None:
    with pytest.raises(RunFileError, match="no frames"):
        choose(Intact(header(), [Refused(START, STEP, 0.1, "")]), None, None)
