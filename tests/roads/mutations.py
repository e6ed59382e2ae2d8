"""Damaged nets: each must be refused in one line or be a sound map, whatever was done to it."""

from __future__ import annotations

import gzip
import math
import random
import re
import time
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path

from tmpud.errors import MapError
from tmpud.roads import read_sumo_net
from tmpud.roads.network import RoadNetwork
from tmpud.roads.survey import survey

ATTRIBUTE = re.compile(rb'([\w:]+)="([^"]*)"')
ELEMENT = re.compile(rb"<\w[^>]*/>")
VALUES = (
    b"nan inf -inf NaN 1e999 -1 0 1e308 -1e308 1_000 0x10 \xd9\xa3 \xff 99999999999999999999 x , ,, 1,2 1,2,3,4 1,nan "
    b"0,0 :x_0 &amp; &#10; &lt; &#0; &x; true passenger all none t internal junction/../../etc"
).split(b" ")
BOMB = b'<!DOCTYPE net [<!ENTITY a "aaaaaaaaaa">%s]>' % b"".join(
    b'<!ENTITY %c "%s">' % (letter, b"&%c;" % (letter - 1) * 10) for letter in b"bcdefghij"
)
SLOW = 10.0  # [s] a mutant that takes longer hangs

Mutation = Callable[[bytes, random.Random], bytes]


def cut_short(net: bytes, rng: random.Random) -> bytes:
    return net[: rng.randrange(len(net))]


def drop_a_span(net: bytes, rng: random.Random) -> bytes:
    start = rng.randrange(len(net))
    return net[:start] + net[start + rng.choice([1, 10, 200, 5000]) :]


def repeat_a_span(net: bytes, rng: random.Random) -> bytes:
    start = rng.randrange(len(net))
    return net[: start + rng.choice([1, 10, 200, 5000])] + net[start:]


def flip_bytes(net: bytes, rng: random.Random) -> bytes:
    damaged = bytearray(net)
    for _ in range(rng.choice([1, 2, 20])):
        damaged[rng.randrange(len(damaged))] = rng.randrange(256)
    return bytes(damaged)


def _pick(pattern: re.Pattern[bytes], net: bytes, rng: random.Random) -> re.Match[bytes]:
    found = None
    while found is None:
        found = pattern.search(net, rng.randrange(len(net))) or pattern.search(net)
    return found


def set_a_value(net: bytes, rng: random.Random) -> bytes:
    there = _pick(ATTRIBUTE, net, rng)
    return net[: there.start(2)] + rng.choice([*VALUES, b"", b"7" * 10**5]) + net[there.end(2) :]


def swap_two_values(net: bytes, rng: random.Random) -> bytes:
    first, second = sorted((_pick(ATTRIBUTE, net, rng) for _ in range(2)), key=lambda match: match.start())
    if first.start() == second.start():
        return net
    middle = net[first.end(2) : second.start(2)]
    return net[: first.start(2)] + second[2] + middle + first[2] + net[second.end(2) :]


def damage_a_number(net: bytes, rng: random.Random) -> bytes:
    there = _pick(re.compile(rb"-?\d+\.\d+"), net, rng)
    return net[: there.start()] + rng.choice(VALUES[:10]) + net[there.end() :]


def drop_an_attribute(net: bytes, rng: random.Random) -> bytes:
    there = _pick(ATTRIBUTE, net, rng)
    return net[: there.start()] + net[there.end() :]


def rename_an_attribute(net: bytes, rng: random.Random) -> bytes:
    there = _pick(ATTRIBUTE, net, rng)
    other = _pick(ATTRIBUTE, net, rng)
    return net[: there.start(1)] + other[1] + net[there.end(1) :]


def drop_an_element(net: bytes, rng: random.Random) -> bytes:
    there = _pick(ELEMENT, net, rng)
    return net[: there.start()] + net[there.end() :]


def repeat_an_element(net: bytes, rng: random.Random) -> bytes:
    there = _pick(ELEMENT, net, rng)
    return net[: there.end()] + there[0] * rng.choice([1, 1, 100]) + net[there.end() :]


def nest_deeply(net: bytes, rng: random.Random) -> bytes:
    there = _pick(ELEMENT, net, rng)
    depth = rng.choice([2, 40, 10**5])
    return net[: there.start()] + b"<edge>" * depth + b"</edge>" * depth + net[there.end() :]


def _root(net: bytes) -> int:
    """Return where the document's root element begins."""
    return re.search(rb"<(?=[A-Za-z])", net).start()  # type: ignore[union-attr]


def with_doctype(net: bytes, rng: random.Random) -> bytes:
    document = net[_root(net) :]
    doctype = rng.choice([b"<!DOCTYPE net>", BOMB, b'<!DOCTYPE net [<!ENTITY x SYSTEM "file:///etc/passwd">]>'])
    return doctype + document.replace(b'id="', b'id="&%s;' % rng.choice([b"j", b"x", b"a"]), 1)


def another_encoding(net: bytes, rng: random.Random) -> bytes:
    name = rng.choice([b"utf-7", b"utf-16", b"shift_jis", b"cp037", b"nonsense", b"idna", b"ascii", b"latin-1"])
    return b'<?xml version="1.0" encoding="%s"?>' % name + net[_root(net) :]


MUTATIONS: tuple[Mutation, ...] = (
    cut_short, drop_a_span, repeat_a_span, flip_bytes, set_a_value, set_a_value, set_a_value, swap_two_values,
    swap_two_values, damage_a_number, drop_an_attribute, rename_an_attribute, drop_an_element, repeat_an_element,
    nest_deeply, with_doctype, another_encoding,
)  # fmt: skip


def mutants(net: bytes, n: int, seed: int) -> Iterator[tuple[str, bytes]]:
    """Yield n file names and damaged contents; one in ten is packed, half of those damaged once more."""
    rng = random.Random(seed)
    for _ in range(n):
        damaged = rng.choice(MUTATIONS)(net, rng)
        if rng.random() >= 0.1:
            yield "mutant.net.xml", damaged
            continue
        packed = gzip.compress(damaged, compresslevel=1)
        yield "mutant.net.xml.gz", rng.choice([packed, flip_bytes(packed, rng), cut_short(packed, rng), damaged])


def fuzz(net: bytes, n: int, seed: int, folder: Path) -> Counter[str]:
    """Read n mutants of a net and count those refused and valid; any other outcome is an exception."""
    return Counter(
        "refused" if outcome(read_sumo_net, folder / name, damaged) else "valid"
        for name, damaged in mutants(net, n, seed)
    )


def outcome(read: Callable[[Path], RoadNetwork], file: Path, damaged: bytes, slow: float = SLOW) -> str:
    """Read a damaged map and return what was said of it, nothing where it is a sound one; else raise."""
    file.write_bytes(damaged)
    began = time.monotonic()
    try:
        assert_sound(read(file))
        message = ""
    except MapError as error:
        message = str(error)
    assert "\n" not in message, "an error of more than one line"
    assert len(message) < 1000, "an error as long as the file"
    assert time.monotonic() - began < slow, f"a mutant took longer than {slow} s"
    return message


def assert_sound(network: RoadNetwork) -> None:
    """Check that a map can be used: finite and positive lengths, references that hold, a survey."""
    for lane in network.lanes.values():
        assert 0 < lane.length < math.inf
        assert 0 < lane.width < math.inf
        assert 0 < lane.speed < math.inf
        assert len(lane.elevation) == len(lane.centre.points)
        assert math.isfinite(lane.level)
    for connection in network.connections:
        assert {connection.from_lane, connection.to_lane} <= network.lanes.keys()
        assert connection.junction in network.junctions
        assert 0 < connection.path.length < math.inf
        assert connection.signal is None or len(network.signals[connection.signal].phases[0][1]) > connection.link >= 0
        assert all(0 <= i < len(network.connections) for i in (*connection.yields_to, *connection.foes))
    assert survey(network).segments == len(network.segments) > 0
