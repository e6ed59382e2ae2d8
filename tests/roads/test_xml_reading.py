from __future__ import annotations

import gzip
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.roads.mutations import BOMB
from tmpud.errors import MapError
from tmpud.roads import xml_reading
from tmpud.roads.xml_reading import MAX_NUMBER, Element, read_xml


def element(**attributes: str) -> Element:
    return Element("lane", attributes, "town.net.xml", 7)


def write(folder: Path, content: bytes, name: str = "a.net.xml") -> Path:
    path = folder / name
    path.write_bytes(content)
    return path


def test_elements_that_are_not_asked_for_are_left_out_with_all_within(tmp_path: Path) -> None:
    path = write(tmp_path, b'<net>\n<lane id="a"><param><lane id="b"/></param></lane>\n<lane id="c"/></net>')
    root, _ = read_xml(path, "net", ["lane"])
    assert [(child.text("id"), child.line, child.children) for child in root.children] == [("a", 2, ()), ("c", 3, ())]


@pytest.mark.parametrize("doctype", [b"<!DOCTYPE net>", BOMB, b'<!DOCTYPE net SYSTEM "file:///etc/passwd">'])
def test_a_document_type_is_refused_before_anything_else(tmp_path: Path, doctype: bytes) -> None:
    with pytest.raises(MapError, match=r"a\.net\.xml:2: a document type"):
        read_xml(write(tmp_path, b'<?xml version="1.0"?>\n' + doctype + b'<net a="&j;"/>'), "net", [])


def test_an_entity_that_is_not_xml_s_own_is_refused(tmp_path: Path) -> None:
    with pytest.raises(MapError, match="undefined entity"):
        read_xml(write(tmp_path, b'<net a="&j;"/>'), "net", [])


def test_elements_nested_too_deeply_are_refused(tmp_path: Path) -> None:
    with pytest.raises(MapError, match="deeper than 32"):
        read_xml(write(tmp_path, b"<net>" * 10**5), "net", ["net"])


def test_a_file_that_unpacks_to_too_much_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(xml_reading, "MAX_BYTES", 10**6)
    bomb = gzip.compress(b"<net>" + b" " * 10**7, mtime=0)
    with pytest.raises(MapError, match="unpacks to more than"):
        read_xml(write(tmp_path, bomb, "a.net.xml.gz"), "net", [])


def test_a_file_that_is_too_large_is_not_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(xml_reading, "MAX_BYTES", 10)
    with pytest.raises(MapError, match="larger than"):
        read_xml(write(tmp_path, b"<net></net>"), "net", [])


@pytest.mark.parametrize(
    "content", [b"", b"garbage", gzip.compress(b"<net/>", mtime=0)[:-4], gzip.compress(b"<net/>", mtime=0) + b"x"]
)
def test_a_file_that_is_not_whole_is_refused(tmp_path: Path, content: bytes) -> None:
    with pytest.raises(MapError):
        read_xml(write(tmp_path, content, "a.net.xml.gz"), "net", [])


@given(st.floats(-MAX_NUMBER, MAX_NUMBER))
def test_a_finite_number_is_read_as_python_writes_it(number: float) -> None:
    assert element(x=repr(number)).number("x") == number


@pytest.mark.parametrize("text", ["nan", "inf", "-inf", "1e9", "1_0", "", "0x1", "1,2", "١_٢"])
def test_what_is_not_a_finite_number_is_refused_with_the_value(text: str) -> None:
    with pytest.raises(MapError, match=r"town.net.xml:7: lane: x='"):
        element(x=text).number("x")


@given(st.lists(st.tuples(*[st.floats(-1000, 1000)] * 3)))
def test_points_come_back_with_their_elevation(points: list[tuple[float, float, float]]) -> None:
    flat, elevation = element(shape=" ".join(f"{x!r},{y!r},{z!r}" for x, y, z in points)).points("shape")
    assert [(*point, z) for point, z in zip(flat, elevation, strict=True)] == points


def test_points_without_elevation_lie_at_zero() -> None:
    assert element(shape="1,2 3,4,5").points("shape") == ([(1.0, 2.0), (3.0, 4.0)], (0.0, 5.0))


@given(st.text())
def test_any_text_is_an_id_or_refused_in_one_line(text: str) -> None:
    try:
        assert element(id=text).identifier("id") == text
    except MapError as error:
        message = str(error)
        assert len(message.splitlines()) == 1, message


def test_limits_are_inclusive() -> None:
    assert element(x="0").number("x", low=0.0) == 0.0
    with pytest.raises(MapError):
        element(x="-0.1").number("x", low=0.0)
