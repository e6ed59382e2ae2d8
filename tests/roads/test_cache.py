import json
import os
import random
from functools import partial
from pathlib import Path

import pytest

from tests.roads.nets import CROSSING
from tmpud.errors import MapError
from tmpud.roads.cache import cache_folder, read_cached
from tmpud.roads.loading import map_file
from tmpud.roads.network import RoadNetwork
from tmpud.roads.sumo_net import read_sumo_net


class Reader:
    """Reads nets and counts how often."""

    def __init__(self) -> None:
        self.times = 0

    def __call__(self, file: Path) -> RoadNetwork:
        self.times += 1
        return read_sumo_net(file, segment_length=60.0)


@pytest.fixture
def net(tmp_path: Path) -> Path:
    path = tmp_path / "crossing.net.xml"
    path.write_text(CROSSING)
    return path


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return tmp_path / "cache"


def test_the_network_is_the_same_read_from_the_cache(folder: Path) -> None:
    town, reader = map_file("millbrook"), Reader()
    first, again = (read_cached(town, 60.0, reader, folder, 0) for _ in range(2))
    assert reader.times == 1
    assert first == again == read_sumo_net(town, segment_length=60.0)
    assert [*first.lanes] == [*again.lanes]
    assert repr(first) == repr(again)
    uncut = read_cached(town, 1e9, reader, folder, 0)
    assert uncut == read_sumo_net(town, segment_length=1e9)


def test_a_network_of_many_blocks_is_the_same_from_the_cache(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for module in ("late", "rows"):
        monkeypatch.setattr(f"tmpud.roads.{module}.BLOCK", 7)
    town, reader = map_file("millbrook"), Reader()
    first, again = (read_cached(town, 60.0, reader, folder, 0) for _ in range(2))
    assert reader.times == 1
    assert [again.outgoing(lane) for lane in again.lanes] == [first.outgoing(lane) for lane in first.lanes]
    assert again == first


def test_the_streets_keep_their_names(net: Path, folder: Path) -> None:
    net.write_text(CROSSING.replace('<edge id="in"', '<edge id="in" name="Mill Street"'))
    for _ in range(2):
        assert read_cached(net, 60.0, Reader(), folder, 0).street_names == {"in": "Mill Street"}


def test_another_file_of_the_same_content_is_named_as_it_is(net: Path, folder: Path) -> None:
    reader = Reader()
    read_cached(net, 60.0, reader, folder, 0)
    other = net.rename(net.with_name("other.net.xml"))
    found = read_cached(other, 60.0, reader, folder, 0)
    assert reader.times == 1
    assert (found.name, found.source) == ("other", str(other))


def test_a_changed_map_is_read_anew(net: Path, folder: Path) -> None:
    reader = Reader()
    read_cached(net, 60.0, reader, folder, 0)
    net.write_text(CROSSING.replace("</net>", "<!-- changed --></net>"))
    assert read_cached(net, 60.0, reader, folder, 0).digest != ""
    assert reader.times == 2


def test_any_damage_to_the_cache_is_as_good_as_no_cache(net: Path, folder: Path) -> None:
    right = read_cached(net, 60.0, Reader(), folder, 0)
    (kept,) = folder.iterdir()
    whole, rng = kept.read_bytes(), random.Random(1)
    for _ in range(100):
        damaged = bytearray(whole[: rng.choice((len(whole), rng.randrange(len(whole))))])
        for _ in range(rng.randrange(1, 4)):
            if damaged:
                damaged[rng.randrange(len(damaged))] ^= 1 << rng.randrange(8)
        kept.write_bytes(damaged)
        reader = Reader()
        assert read_cached(net, 60.0, reader, folder, 0) == right
        assert reader.times == (bytes(damaged) != whole)
        assert kept.read_bytes() == whole


def test_what_another_version_kept_is_replaced(net: Path, folder: Path) -> None:
    read_cached(net, 60.0, Reader(), folder, 0)
    (kept,) = folder.iterdir()
    stamp, _, body = kept.read_bytes().partition(b"\n")
    kept.write_bytes(json.dumps(json.loads(stamp) | {"code": "older"}).encode() + b"\n" + body)
    reader = Reader()
    read_cached(net, 60.0, reader, folder, 0)
    read_cached(net, 60.0, reader, folder, 0)
    assert reader.times == 1


def test_small_maps_and_those_with_errors_are_not_kept(net: Path, folder: Path) -> None:
    read_cached(net, 60.0, Reader(), folder)
    net.write_text("<net>")
    with pytest.raises(MapError):
        read_cached(net, 60.0, Reader(), folder, 0)
    with pytest.raises(MapError, match="cannot be read"):
        read_cached(net.with_name("none.net.xml"), 60.0, Reader(), folder, 0)
    assert not folder.exists()


def test_a_folder_that_cannot_be_written_is_done_without(net: Path, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    read = partial(read_cached, net, 60.0, read_sumo_net, tmp_path / "file" / "maps", 0)
    assert read() == read()


def test_what_could_not_be_kept_leaves_nothing_behind(net: Path, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object) -> None:
        raise OSError("no space left on device")

    monkeypatch.setattr(Path, "replace", full)
    assert read_cached(net, 60.0, Reader(), folder, 0).digest
    assert list(folder.iterdir()) == []


def test_the_user_says_where_and_whether(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.delenv("TMPUD_NO_CACHE", raising=False)
    monkeypatch.setenv("XDG_CACHE_HOME", os.fspath(tmp_path))
    assert cache_folder() == tmp_path / "tmpud" / "maps"
    monkeypatch.setenv("TMPUD_NO_CACHE", "1")
    assert cache_folder() is None
