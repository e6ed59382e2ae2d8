from __future__ import annotations

import gzip
import hashlib
from pathlib import Path

import pytest

from tests.roads.nets import CROSSING, altered
from tmpud.errors import MapError
from tmpud.roads.network import RoadNetwork
from tmpud.roads.sumo_net import read_sumo_net
from tmpud.symbols import Action


def read(folder: Path, text: str, **options: bool) -> RoadNetwork:
    path = folder / "tiny.net.xml"
    path.write_text(text)
    return read_sumo_net(path, **options)


@pytest.fixture
def crossing(tmp_path: Path) -> RoadNetwork:
    return read(tmp_path, CROSSING)


def test_streets_have_the_names_that_the_net_gives_them(tmp_path: Path) -> None:
    path = tmp_path / "named.net.xml"
    path.write_text(CROSSING.replace('<edge id="in"', '<edge id="in" name="Mill &amp; Co"'))
    assert read_sumo_net(path).street_names == {"in": "Mill & Co"}


def test_lanes_for_pedestrians_are_left_out_and_the_others_keep_their_index(crossing: RoadNetwork) -> None:
    assert crossing.edges["in"] == ("in_1", "in_2")
    assert [crossing.lanes[lane].index for lane in crossing.edges["in"]] == [1, 2]
    assert "lanes closed to cars, left out: 1" in crossing.warnings


def test_a_left_turn_with_a_waiting_point_has_its_whole_path(crossing: RoadNetwork) -> None:
    turn = crossing.outgoing("in_2")[0]
    assert turn.action is Action.TURNLEFT
    assert turn.internal_lanes == (":C_1_0", ":C_2_0")
    assert turn.path.points == ((90.0, -1.6), (96.0, -1.0), (101.6, 3.0), (101.6, 10.0))
    assert crossing.internal[":C_2_0"] == crossing.connections.index(turn)


def test_links_are_numbered_along_the_incoming_lanes(crossing: RoadNetwork) -> None:
    straight, left, right = crossing.connections
    assert right.yields_to == (0,)
    assert (straight.yields_to, straight.foes) == ((), (2, 1))
    assert left.yields_to == (0,)


def test_lights_widths_heights_limits_and_permissions_are_read(crossing: RoadNetwork) -> None:
    assert (crossing.connections[1].signal, crossing.connections[1].link) == ("C", 1)
    assert crossing.signals["C"].phases == ((30.0, "Ggr"), (3.0, "yyr"), (20.0, "rrG"))
    lane = crossing.lanes["in_2"]
    assert (lane.width, lane.speed, lane.elevation, lane.level) == (3.2, 13.89, (3.0, 5.0), 4.0)
    assert crossing.may_change("in_1", Action.MERGELEFT)
    assert not crossing.may_change("in_2", Action.MERGERIGHT)
    assert crossing.frame.offset == (100.0, 50.0)


def test_a_road_is_cut_into_segments_of_at_most_sixty_metres(crossing: RoadNetwork) -> None:
    assert [segment.id for segment in crossing.segments_of("out_0")] == ["out_0/0", "out_0/1", "out_0/2"]
    assert crossing.segment_at("in_1", 45.0).number == 1


def test_turnarounds_are_left_out_unless_asked_for(tmp_path: Path) -> None:
    text = altered('via=":C_1_0" tl="C" linkIndex="1" dir="l"', 'via=":C_1_0" tl="C" linkIndex="1" dir="t"')
    assert [c.turnaround for c in read(tmp_path, text).connections] == [False, False]
    kept = read(tmp_path, text, turnarounds=True).connections[1]
    assert kept.turnaround
    assert kept.action is Action.TURNLEFT


def test_a_packed_net_is_the_same_net_with_the_digest_of_its_stored_bytes(tmp_path: Path) -> None:
    packed = tmp_path / "tiny.net.xml.gz"
    packed.write_bytes(gzip.compress(CROSSING.encode(), mtime=0))
    network = read_sumo_net(packed)
    assert network.lanes == read(tmp_path, CROSSING).lanes
    assert network.name == "tiny"
    assert network.digest == hashlib.sha256(packed.read_bytes()).hexdigest()


MISTAKES = {
    "a road to nowhere": ('from="C" to="B"', 'from="C" to="X"', "'X' is not a junction"),
    "a lane id used twice": ('id="out_1"', 'id="out_0"', "already used in line"),
    "an edge id used twice": ('edge id="north"', 'edge id="out"', "already used in line"),
    "a lane out of order": ('id="out_1" index="1"', 'id="out_1" index="2"', "should be 1"),
    "a coordinate that is not a number": ("110.00,-1.60 240.00,-1.60", "110.00,nan 240.00,-1.60", "finite"),
    "a point of one coordinate": ("110.00,-1.60 240.00,-1.60", "110.00 240.00,-1.60", "not a point"),
    "a lane of one point": ("110.00,-1.60 240.00,-1.60", "110.00,-1.60", "two distinct points"),
    "a lane round the world": ("110.00,-1.60 240.00,-1.60", "110.00,-1.60 4e7,-1.60", "longer than any lane"),
    "a lane without a shape": (' shape="110.00,-1.60 240.00,-1.60"', "", "'shape' is missing"),
    "an infinite phase": ('duration="30"', 'duration="inf"', "not a number from 0"),
    "a phase short of a letter": ('state="Ggr"', 'state="Gg"', "a letter for each"),
    "a light nobody defined": ('via=":C_0_0" tl="C"', 'via=":C_0_0" tl="D"', "no tlLogic"),
    "a letter the light lacks": ('linkIndex="2"', 'linkIndex="3"', "3 letters"),
    "a connection from nowhere": ('from="side" to="out"', 'from="slide" to="out"', "not an edge"),
    "a connection from a lane too many": ('to="out" fromLane="1" toLane="0"', 'to="out" fromLane="9" toLane="0"', "9"),
    "a connection through nothing": ('via=":C_3_0" tl', 'via=":C_9_0" tl', "not a lane"),
    "an unknown direction": ('linkIndex="2" dir="r"', 'linkIndex="2" dir="q"', "not one of: L R l r s t"),
    "a request too few": ('<request index="2" response="010" foes="010" cont="1"/>', "", "request rows"),
    "request bits that are no bits": ('response="000"', 'response="00x"', "3 digits"),
    "an incoming lane nobody knows": ('incLanes="north_0"', 'incLanes="north_7"', "not a lane"),
    "an unknown vehicle class": ('allow="pedestrian"', 'allow="pedestrians"', "not a vehicle class"),
    "left-hand traffic": ('version="1.20"', 'version="1.20" lefthand="true"', "left-hand"),
    "another kind of file": ("<net", "<nets", "root element"),
}


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_mistake_is_named_with_file_line_and_cause(tmp_path: Path, mistake: str) -> None:
    old, new, cause = MISTAKES[mistake]
    text = (
        altered(old, new) if mistake != "another kind of file" else CROSSING.replace("net>", "nets>").replace(old, new)
    )
    with pytest.raises(MapError, match=cause) as caught:
        read(tmp_path, text)
    assert str(caught.value).startswith(f"{tmp_path / 'tiny.net.xml'}:{caught.value.line}: ")
    assert "\n" not in str(caught.value)


def test_of_several_programs_of_a_light_the_last_one_counts(tmp_path: Path) -> None:
    night = '<tlLogic id="C" type="static" programID="night" offset="7"><phase duration="90" state="OOo"/></tlLogic>'
    network = read(tmp_path, altered('<junction id="A"', night + '<junction id="A"'))
    assert (network.signals["C"].offset, network.signals["C"].phases) == (7.0, ((90.0, "OOo"),))


def test_a_connection_may_stand_only_once(tmp_path: Path) -> None:
    line = '<connection from=":C_3" to="out" fromLane="0" toLane="0" dir="r" state="M"/>'
    with pytest.raises(MapError, match="connected to 'out_0' twice"):
        read(tmp_path, altered(line, line + line))


def test_a_path_that_leads_back_to_itself_is_refused(tmp_path: Path) -> None:
    with pytest.raises(MapError, match="leads back to itself"):
        read(tmp_path, altered('via=":C_2_0" dir="l" state="m"', 'via=":C_1_0" dir="l" state="m"'))


def test_a_lane_that_states_another_length_is_measured_along_its_shape_with_a_warning(tmp_path: Path) -> None:
    network = read(tmp_path, altered('id="north_0" index="0" speed="13.89" length="50.00"', _FALSE_LENGTH))
    assert network.lanes["north_0"].length == 50.0
    assert any("stated length" in warning for warning in network.warnings)


_FALSE_LENGTH = 'id="north_0" index="0" speed="13.89" length="80.00"'
