"""A tiny net, written out, whose parts the tests swap for others."""

from __future__ import annotations

# Road "in" (two lanes and a pavement) leads to junction C: lane in_1 goes straight on to "out", lane in_2 turns left
# into "north" by way of a waiting point; "side" comes from the south and gives way. Signal "C" controls all of it.
CROSSING = """<net version="1.20">
<location netOffset="100.00,50.00" convBoundary="0,0,0,0" origBoundary="0,0,0,0" projParameter="!"/>
<edge id=":C_0" function="internal">
<lane id=":C_0_0" index="0" speed="13.89" length="20.00" shape="90.00,-4.80 110.00,-4.80"/></edge>
<edge id=":C_1" function="internal">
<lane id=":C_1_0" index="0" speed="8.00" length="6.00" shape="90.00,-1.60 96.00,-1.00"/></edge>
<edge id=":C_2" function="internal">
<lane id=":C_2_0" index="0" speed="8.00" length="9.00" shape="96.00,-1.00 101.60,3.00 101.60,10.00"/></edge>
<edge id=":C_3" function="internal">
<lane id=":C_3_0" index="0" speed="8.00" length="9.00" shape="101.60,-10.00 104.00,-6.00 110.00,-4.80"/></edge>
<edge id="in" from="A" to="C" priority="-1">
<lane id="in_0" index="0" allow="pedestrian" speed="13.89" length="90.00" width="2.00" shape="0.00,-7.40 90.00,-7.40"/>
<lane id="in_1" index="1" disallow="pedestrian tram" speed="13.89" length="90.00" shape="0.00,-4.80 90.00,-4.80"/>
<lane id="in_2" index="2" disallow="pedestrian tram" speed="13.89" length="90.00" changeRight="authority"
 shape="0.00,-1.60,3.00 90.00,-1.60,5.00"/></edge>
<edge id="out" from="C" to="B" priority="-1">
<lane id="out_0" index="0" speed="13.89" length="130.00" shape="110.00,-4.80 240.00,-4.80"/>
<lane id="out_1" index="1" speed="13.89" length="130.00" shape="110.00,-1.60 240.00,-1.60"/></edge>
<edge id="north" from="C" to="N" priority="-1">
<lane id="north_0" index="0" speed="13.89" length="50.00" shape="101.60,10.00 101.60,60.00"/></edge>
<edge id="side" from="S" to="C" priority="-1">
<lane id="side_0" index="0" speed="13.89" length="50.00" shape="101.60,-60.00 101.60,-10.00"/></edge>
<tlLogic id="C" type="static" programID="0" offset="0"><phase duration="30" state="Ggr"/>
<phase duration="3" state="yyr"/><phase duration="20" state="rrG"/></tlLogic>
<junction id="A" type="dead_end" x="0.00" y="0.00" incLanes="" intLanes="" shape="0.00,0.00 0.00,-8.00"/>
<junction id="B" type="dead_end" x="240.00" y="0.00" incLanes="out_0 out_1" intLanes="" shape=""/>
<junction id="N" type="dead_end" x="100.00" y="60.00" incLanes="north_0" intLanes="" shape=""/>
<junction id="S" type="dead_end" x="100.00" y="-60.00" incLanes="" intLanes="" shape=""/>
<junction id="C" type="traffic_light" x="100.00" y="0.00" incLanes="side_0 in_0 in_1 in_2"
 intLanes=":C_3_0 :C_0_0 :C_2_0" shape="90.00,0.00 90.00,-8.00 110.00,-8.00 110.00,0.00">
<request index="0" response="010" foes="010" cont="0"/>
<request index="1" response="000" foes="101" cont="0"/>
<request index="2" response="010" foes="010" cont="1"/></junction>
<connection from="in" to="out" fromLane="1" toLane="0" via=":C_0_0" tl="C" linkIndex="0" dir="s" state="O"/>
<connection from="in" to="north" fromLane="2" toLane="0" via=":C_1_0" tl="C" linkIndex="1" dir="l" state="o"/>
<connection from="side" to="out" fromLane="0" toLane="0" via=":C_3_0" tl="C" linkIndex="2" dir="r" state="o"/>
<connection from=":C_0" to="out" fromLane="0" toLane="0" dir="s" state="M"/>
<connection from=":C_1" to="north" fromLane="0" toLane="0" via=":C_2_0" dir="l" state="m"/>
<connection from=":C_2" to="north" fromLane="0" toLane="0" dir="l" state="M"/>
<connection from=":C_3" to="out" fromLane="0" toLane="0" dir="r" state="M"/>
</net>
"""


def altered(old: str, new: str) -> str:
    """Return the crossing with one part swapped for another."""
    assert CROSSING.count(old) == 1, f"{old!r} stands {CROSSING.count(old)} times in the net"
    return CROSSING.replace(old, new)
