"""Films of a run, for the commands that make them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from tmpud.cli.options import number

if TYPE_CHECKING:
    from tmpud.viewer.film.film import Cut
    from tmpud.viewer.intact import Intact

Gif = Annotated[Path | None, typer.Option(metavar="FILE", help="An animation to write, as GIF.")]
Mp4 = Annotated[Path | None, typer.Option(metavar="FILE", help="An animation to write, as MP4; needs tmpud[video].")]
Begin = Annotated[
    float | None,
    typer.Option("--from", min=0.0, callback=number, help="Where it begins, in seconds on the replay's clock."),
]
End = Annotated[
    float | None, typer.Option("--to", min=0.0, callback=number, help="Where it ends, in the same seconds.")
]
Fps = Annotated[
    float | None, typer.Option(min=1.0, max=60.0, callback=number, help="Pictures a second; default: 10, or 25 as MP4.")
]
Width = Annotated[int, typer.Option(min=320, max=3840, help="Width of the animation [px]; its height is 5/8 of it.")]
Speed = Annotated[float, typer.Option(min=0.1, max=100.0, callback=number, help="Simulated seconds a second.")]


@dataclass(frozen=True, slots=True, kw_only=True)
class Films:
    """Which films to make."""

    gif: Gif = None
    mp4: Mp4 = None

    def check(self) -> None:
        """Raise VideoError at once where an encoder is missing."""
        if self.mp4:
            from tmpud.viewer.film.writing import encoder

            encoder()

    def __bool__(self) -> bool:
        return bool(self.gif or self.mp4)


@dataclass(frozen=True, slots=True, kw_only=True)
class Cutting:
    """What a film shows; without --from and --to, 20 s around the first refused action or unsafe moment."""

    begin: Begin = None
    end: End = None
    fps: Fps = None
    width: Width = 640
    speed: Speed = 1.0

    def cut(self) -> Cut:
        from tmpud.viewer.film.film import Cut

        return Cut(begin=self.begin, end=self.end, fps=self.fps, width=self.width, speed=self.speed)


def write_films(run: Intact, films: Films, cutting: Cutting) -> None:
    """Write what was asked for, once it is checked; say on stderr what is missing, what is shown, and why that."""
    from tmpud.viewer.film.film import Film
    from tmpud.viewer.film.writing import write_gif, write_mp4

    film = Film(run, cutting.cut())
    clip = film.clip
    for line in run.missing:
        typer.echo(f"missing: {line}", err=True)
    typer.echo(f"showing {clip.begin:.1f} s to {clip.end:.1f} s of the drive: {clip.why}", err=True)
    for file, write in ((films.gif, write_gif), (films.mp4, write_mp4)):
        if file:
            write(film, file)
            typer.echo(f"wrote {file} ({file.stat().st_size / 1e3:,.0f} kB)", err=True)
