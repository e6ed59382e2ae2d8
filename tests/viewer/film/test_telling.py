from tests.viewer.made_runs import MERGE_LATER, MERGE_NOW, START, events
from tmpud.viewer.film.telling import PAUSE, STAYS, tellings


def test_the_film_stands_still_where_an_action_is_refused_and_then_says_what_was_planned_instead() -> None:
    told = [now for time, now in tellings(events()) if time == START]
    refused = next(now for now in told if now.pause)
    assert refused.pause == PAUSE
    assert refused.news == "Merging left is not safe enough: Safe = 0.50 because of car1 (red)"
    assert (refused.number, refused.plan, refused.risk, refused.alarm) == (0, MERGE_NOW, "car1", True)
    last = told[-1]
    assert last.news == "Replanned from A to B because Safe(mergeleft) = 0.50"
    assert (last.number, last.plan, last.given_up, last.alarm, last.pause) == (1, MERGE_LATER, MERGE_NOW, False, 0.0)


def test_news_grow_old() -> None:
    last = [now for time, now in tellings(events()) if time == START][-1]
    assert last.later(START + STAYS - 0.1) == last
    old = last.later(START + STAYS)
    assert (old.news, old.risk, old.given_up) == ("", None, ())
    assert (old.plan, old.number) == (last.plan, last.number)


def test_an_unsafe_moment_marks_its_vehicle_and_stops_the_film() -> None:
    judged = next(now for time, now in tellings(events()) if time == 13.0)
    assert (judged.risk, judged.alarm, judged.pause) == ("car2", True, PAUSE)
    assert judged.news.startswith("forced stop, blame: ego")
