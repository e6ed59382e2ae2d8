"""XML from strangers: no DTD, no entities, limits on size and depth, finite numbers, errors with file and line."""

from __future__ import annotations

import gzip
import hashlib
import io
import math
import re
import stat
import zlib
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO
from xml.parsers import expat

from tmpud.errors import MapError
from tmpud.geometry import Point

MAX_BYTES = 1 << 30  # of a file, stored or unpacked
MAX_DEPTH = 32  # of nested elements
MAX_NUMBER = 1e8  # no coordinate, time or speed of a map is larger
_CHUNK = 1 << 20
_SHORT = 20  # [characters]
_NOT_IN_AN_ID = re.compile(r'[\s"\\\x00-\x1f\x7f]')


@dataclass(slots=True)
class Element:
    """One element of a file, with the line on which it starts."""

    tag: str
    attributes: dict[str, str]
    source: str
    line: int
    children: Sequence[Element] = ()  # a list only where there are some: a city has millions without

    def error(self, cause: str) -> MapError:
        return MapError(self.source, self.line, f"{self.tag}: {cause}")

    def text(self, name: str, default: str | None = None) -> str:
        """Return an attribute; MapError where it is missing and has no default."""
        value = self.attributes.get(name, default)
        if value is None:
            raise self.error(f"attribute '{name}' is missing")
        return value

    def identifier(self, name: str) -> str:
        """Return an attribute that names something: not empty, no blanks, quotes or backslashes."""
        value = self.text(name)
        if not value or _NOT_IN_AN_ID.search(value):
            raise self.error(f"{name}={shown(value)} is not an id (empty, or blanks, quotes or backslashes in it)")
        return value

    def number(self, name: str, default: float | None = None, low: float = -MAX_NUMBER) -> float:
        """Return a finite attribute of at least ``low``."""
        if name not in self.attributes and default is not None:
            return default
        text = self.text(name)
        try:
            value = _number(text)
        except ValueError:
            value = math.nan
        if not value >= low:
            raise self.error(f"{name}={shown(text)} is not a number from {low:g} to {MAX_NUMBER:g}")
        return value

    def natural(self, name: str) -> int:
        """Return an attribute that is 0, 1, 2, ... below a million."""
        text = self.text(name)
        if not (text.isascii() and text.isdigit() and len(text) < 7):
            raise self.error(f"{name}={shown(text)} is not one of 0, 1, 2, ...")
        return int(text)

    def choice(self, name: str, choices: Collection[str], default: str | None = None) -> str:
        """Return an attribute that is one of the choices."""
        value = self.text(name, default)
        if value not in choices:
            raise self.error(f"{name}={shown(value)} is not one of: {' '.join(sorted(choices))}")
        return value

    def points(self, name: str, default: str | None = None) -> tuple[list[Point], tuple[float, ...]]:
        """Return the points ``x,y`` or ``x,y,z`` of a shape, and the elevation of each (0 where none is given) [m]."""
        points: list[Point] = []
        elevation: list[float] = []
        for word in self.text(name, default).split():
            try:
                x, y, *rest = map(_number, word.split(","))
                (z,) = rest or (0.0,)
            except ValueError:
                raise self.error(f"{name}: {shown(word)} is not a point x,y or x,y,z of finite numbers") from None
            points.append((x, y))
            elevation.append(z)
        return points, tuple(elevation)


def shown(text: str) -> str:
    """Return a value in quotes, on one line, shortened where it is long."""
    return repr(text if len(text) <= 60 else text[:57] + "...")


def _number(text: str) -> float:
    """Return a number within bounds; ValueError for others, NaN and Python's own spelling 1_000."""
    value = float(text)
    if "_" in text or not -MAX_NUMBER <= value <= MAX_NUMBER:
        raise ValueError
    return value


def read_xml(path: Path, root: str, keep: Collection[str]) -> tuple[Element, str]:
    """Return a file's root element, with the descendants whose tags are to be kept, and the file's sha256.

    A name that ends in ``.gz`` is unpacked; the digest is that of the stored bytes. Raises MapError.
    """
    source = str(path) if str(path).isprintable() else shown(str(path))
    try:
        status = path.stat()
        if not stat.S_ISREG(status.st_mode):
            raise MapError(source, None, "cannot be read: not a regular file")
        if status.st_size > MAX_BYTES:
            raise MapError(source, None, f"larger than {MAX_BYTES} bytes")
        builder, digest = _TreeBuilder(source, root, keep), hashlib.sha256()
        with path.open("rb") as stored:
            chunks = _chunks(stored, digest)
            builder.feed(_unpacked(source, b"".join(chunks)) if path.suffix == ".gz" else chunks)
    except (OSError, ValueError) as error:
        raise MapError(source, None, f"cannot be read: {getattr(error, 'strerror', None) or error}") from error
    return builder.root, digest.hexdigest()


def _chunks(file: BinaryIO, digest: hashlib._Hash) -> Iterator[bytes]:
    """Yield a file's bytes, and add them to a digest."""
    while chunk := file.read(_CHUNK):
        digest.update(chunk)
        yield chunk


def _unpacked(source: str, stored: bytes) -> Iterator[bytes]:
    total = 0
    try:
        with gzip.GzipFile(fileobj=io.BytesIO(stored)) as packed:
            while chunk := packed.read(_CHUNK):
                total += len(chunk)
                if total > MAX_BYTES:
                    raise MapError(source, None, f"unpacks to more than {MAX_BYTES} bytes")
                yield chunk
    except (OSError, EOFError, zlib.error) as error:
        raise MapError(source, None, f"not a whole gzip file: {error}") from error


class _TreeBuilder:
    """Receives the parser's events; keeps the elements that are asked for."""

    def __init__(self, source: str, root: str, keep: Collection[str]) -> None:
        self._source, self._root, self._keep = source, root, keep
        self._known: dict[str, str] = {}  # short values, of which most come again and again: each is kept once
        self._open: list[Element | None] = []  # None: within an element that is not kept
        self.root: Element
        self._parser = expat.ParserCreate()
        self._parser.buffer_text = True
        self._parser.StartDoctypeDeclHandler = self._refuse_doctype
        self._parser.StartElementHandler = self._start
        self._parser.EndElementHandler = self._end

    def feed(self, chunks: Iterator[bytes]) -> None:
        """Parse the whole file; MapError where it is not well-formed."""
        try:
            for chunk in chunks:
                self._parser.Parse(chunk, False)
            self._parser.Parse(b"", True)
        except expat.ExpatError as error:
            raise MapError(self._source, error.lineno, f"not well-formed XML: {str(error).split(':')[0]}") from error
        except (LookupError, ValueError) as error:
            raise MapError(self._source, 1, f"an encoding other than UTF-8: {error}") from error

    def _refuse_doctype(self, *_: object) -> None:
        raise MapError(self._source, self._parser.CurrentLineNumber, "a document type (DTD) is not allowed in a map")

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        line = self._parser.CurrentLineNumber
        if not self._open:
            if tag != self._root:
                raise MapError(self._source, line, f"the root element is {shown(tag)}, not '{self._root}'")
            self.root = Element(tag, attributes, self._source, line)
            self._open.append(self.root)
            return
        if len(self._open) >= MAX_DEPTH:
            raise MapError(self._source, line, f"elements are nested deeper than {MAX_DEPTH}")
        parent = self._open[-1]
        if parent is None or tag not in self._keep:
            self._open.append(None)
            return
        for name, value in attributes.items():
            if len(value) < _SHORT:
                attributes[name] = self._known.setdefault(value, value)
        element = Element(tag, attributes, self._source, line)
        if isinstance(parent.children, list):
            parent.children.append(element)
        else:
            parent.children = [element]
        self._open.append(element)

    def _end(self, _: str) -> None:
        self._open.pop()
