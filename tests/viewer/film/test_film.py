import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image as Pictures
from PIL import ImageSequence

from tests.viewer.hostile import NAMES
from tests.viewer.made_runs import decision, events, frame, header, recorded
from tmpud.errors import RequestError
from tmpud.events import Event, Judged
from tmpud.viewer.film.film import LAST, Cut, Film
from tmpud.viewer.film.stage import SPAN, Image
from tmpud.viewer.film.telling import PAUSE
from tmpud.viewer.film.writing import MOST, write_gif, write_mp4
from tmpud.viewer.intact import Intact, read_intact

BLACK, RED = (26, 26, 26), (192, 0, 0)  # the ego, and the vehicle that made the merge unsafe


def run(folder: Path, log: list[Event] | None = None) -> Intact:
    return read_intact(recorded(folder / "run", log))


def drawn(picture: Image, colour: tuple[int, int, int]) -> int:
    """Return how many pixels of the scene have a colour."""
    return int((picture[:330, :, :] == colour).all(axis=2).sum())


def test_the_film_shows_the_ego_always_and_the_risk_while_it_stands_still(tmp_path: Path) -> None:
    film = Film(run(tmp_path), Cut())
    moments = film.moments(10.0)
    scale = 640 / SPAN[0]  # [px/m]
    for moment in moments[::5]:
        seen = film.draw(moment)[140:, :, :]  # below the town in the corner
        assert 0.6 < drawn(seen, BLACK) / (4.7 * 1.9 * scale**2) < 2.5
    first = moments[0]
    assert first.telling.pause == PAUSE == first.stays
    assert drawn(film.draw(first), RED) > 0.5 * 5.0 * 1.8 * scale**2


def test_the_film_takes_the_time_of_the_drive_and_of_its_pauses(tmp_path: Path) -> None:
    for fps, speed in ((10.0, 1.0), (20.0, 2.0), (7.0, 0.5)):
        film = Film(run(tmp_path), Cut(speed=speed))
        length = film.clip.end - film.clip.begin
        shown = math.fsum(moment.stays for moment in film.moments(fps))
        assert shown == pytest.approx(length / speed + 2 * PAUSE + LAST, abs=1.5 / fps)


def test_a_later_part_neither_pauses_for_nor_tells_what_was_before(tmp_path: Path) -> None:
    moments = Film(run(tmp_path), Cut(begin=1.0, end=2.0)).moments(10.0)
    assert not any(moment.telling.pause for moment in moments)
    assert {moment.telling.number for moment in moments} == {1}


def test_the_gif_holds_the_pictures_and_how_long_each_is_shown(tmp_path: Path) -> None:
    film = Film(run(tmp_path), Cut(end=1.0, width=320))
    write_gif(film, tmp_path / "new" / "film.gif")
    with Pictures.open(tmp_path / "new" / "film.gif") as gif:
        frames = [(frame.convert("RGB"), frame.info["duration"]) for frame in ImageSequence.Iterator(gif)]
        assert (gif.size, gif.info["loop"]) == ((320, 200), 0)
    moments = film.moments(10.0)
    assert sum(duration for _, duration in frames) == round(sum(1000 * moment.stays for moment in moments))
    for (shown, _), moment in ((frames[0], moments[0]), (frames[-1], moments[-1])):
        assert np.abs(np.asarray(shown, dtype=int) - film.draw(moment)).mean() < 3.0
    assert [file.name for file in (tmp_path / "new").iterdir()] == ["film.gif"]


def test_the_same_run_gives_the_same_gif(tmp_path: Path) -> None:
    for name in ("one.gif", "other.gif"):
        write_gif(Film(run(tmp_path), Cut(end=0.5)), tmp_path / name)
    assert (tmp_path / "one.gif").read_bytes() == (tmp_path / "other.gif").read_bytes()


@pytest.mark.parametrize("name", [*NAMES, "$\\frac{", "日本"])
def test_hostile_names_are_words_and_nothing_else(name: str) -> None:
    frames = [replace(frame(number), ids=(name, "car2")) for number in range(20)]
    judged = Judged(11.0, name, name, name, name, name)
    film = Film(Intact(header(), [*decision(name), judged], frames), Cut())
    for moment in film.moments(5.0):
        film.draw(moment)


def test_without_its_map_the_traffic_is_shown_alone(tmp_path: Path) -> None:
    lost = run(tmp_path, [header(map="gone.net.xml"), *events()[1:]])
    film = Film(lost, Cut())
    assert drawn(film.draw(film.moments(10.0)[5]), BLACK) > 100
    assert any("no roads are drawn" in line for line in lost.missing)


def test_an_interrupt_leaves_the_old_film_and_nothing_half(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    film = Film(run(tmp_path), Cut(end=1.0))
    drawing, drawn_so_far = film.draw, iter(range(20))

    def interrupted(*moment: object) -> Image:
        if next(drawn_so_far) == 18:
            raise KeyboardInterrupt
        return drawing(*moment)  # type: ignore[arg-type]

    monkeypatch.setattr(film, "draw", interrupted)
    (tmp_path / "film.gif").write_text("old")
    with pytest.raises(KeyboardInterrupt):
        write_gif(film, tmp_path / "film.gif")
    assert (tmp_path / "film.gif").read_text() == "old"
    assert sorted(file.name for file in tmp_path.iterdir()) == ["film.gif", "run"]


def test_a_gif_of_too_many_pictures_is_refused(tmp_path: Path) -> None:
    with pytest.raises(RequestError, match=rf"too many for a GIF \({MOST} at most\)"):
        write_gif(Film(run(tmp_path), Cut(speed=0.01)), tmp_path / "film.gif")


def test_the_video_holds_the_pictures(tmp_path: Path) -> None:
    ffmpeg = pytest.importorskip("imageio_ffmpeg")
    film = Film(run(tmp_path), Cut(end=1.0, fps=10.0))
    write_mp4(film, tmp_path / "film.mp4")
    video = ffmpeg.read_frames(str(tmp_path / "film.mp4"))
    about, first = next(video), next(video)
    video.close()
    assert about["size"] == (640, 400)
    assert about["duration"] == pytest.approx(math.fsum(m.stays for m in film.moments(10.0)), abs=0.2)
    shown = np.frombuffer(first, np.uint8).reshape(400, 640, 3)
    assert np.abs(shown.astype(int) - film.draw(film.moments(10.0)[0])).mean() < 4.0
    assert sorted(file.name for file in tmp_path.iterdir()) == ["film.mp4", "run"]
