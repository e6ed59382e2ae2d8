"""Writes a film as GIF or MP4."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image as Pictures

from tmpud.errors import RequestError, TmpudError
from tmpud.viewer.aside import written_aside
from tmpud.viewer.film.film import Film, Moment

GIF_FPS, MP4_FPS = 10.0, 25.0
MOST = 1500  # pictures in a GIF: all of them are held in memory, and nobody wants to load more
COLOURS = 96  # in a GIF
SAMPLED = 12  # pictures from which these are taken


class VideoError(TmpudError):
    """A film that cannot be encoded."""


def write_gif(film: Film, file: Path) -> None:
    """Write an animated GIF that repeats for ever; raises RequestError for one that is too long."""
    delay = max(round(100 / (film.fps or GIF_FPS)), 2)  # [1/100 s] which is how a GIF counts
    moments = film.moments(100 / delay)
    if len(moments) > MOST:
        raise RequestError(
            f"{len(moments)} pictures are too many for a GIF ({MOST} at most): "
            "choose a shorter part, fewer pictures a second or a higher speed"
        )
    colours = _palette(film, moments)
    first, *others = (_reduced(film, moment, colours) for moment in moments)
    durations = [round(1000 * moment.stays) for moment in moments]
    with written_aside(file) as draft:
        first.save(draft, "GIF", save_all=True, append_images=others, duration=durations, loop=0, optimize=False)


def _palette(film: Film, moments: list[Moment]) -> Pictures.Image:
    """Return one palette for all pictures, such that what stands still stays the same."""
    sampled = moments[:: max(len(moments) // SAMPLED, 1)] + [moment for moment in moments if moment.telling.pause][:2]
    strip = np.concatenate([film.draw(moment) for moment in sampled])
    return Pictures.fromarray(strip).quantize(COLOURS, dither=Pictures.Dither.NONE)


def _reduced(film: Film, moment: Moment, colours: Pictures.Image) -> Pictures.Image:
    return Pictures.fromarray(film.draw(moment)).quantize(palette=colours, dither=Pictures.Dither.NONE)


def write_mp4(film: Film, file: Path) -> None:
    """Write an H.264 video; raises VideoError where it cannot be encoded."""
    ffmpeg = encoder()
    fps = film.fps or MP4_FPS
    moments = film.moments(fps)
    repeats = [range(max(round(moment.stays * fps), 1)) for moment in moments]
    height, width, _ = film.draw(moments[0]).shape
    with written_aside(file) as draft:
        sink = ffmpeg.write_frames(
            str(draft), (width, height), fps=fps, codec="libx264", macro_block_size=2, ffmpeg_log_level="error"
        )
        try:
            sink.send(None)
            for moment, repeat in zip(moments, repeats, strict=True):
                picture = np.ascontiguousarray(film.draw(moment))
                for _ in repeat:
                    sink.send(picture)
        except OSError as error:
            raise VideoError(f"{file}: the encoder gave up; is the disk full?") from error
        finally:
            sink.close()
        if not _complete(ffmpeg, draft, sum(map(len, repeats))):
            raise VideoError(f"{file}: the video could not be written as a whole; is the disk full?")


def _complete(ffmpeg: Any, video: Path, pictures: int) -> bool:
    """Whether a video can be read to its end: the encoder may die without a word."""
    try:
        return bool(ffmpeg.count_frames_and_secs(str(video))[0] == pictures)
    except (OSError, RuntimeError):
        return False


def encoder() -> Any:
    """Return the library that encodes videos; VideoError, naming the extra, where it is not installed."""
    try:
        import imageio_ffmpeg
    except ImportError as error:
        raise VideoError('for MP4 install the extra: pip install "tmpud[video]"; a GIF needs none') from error
    return imageio_ffmpeg
