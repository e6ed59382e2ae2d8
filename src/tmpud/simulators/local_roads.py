"""The roads of the local simulation: parallel one-way roads of two lanes, in which many merges run side by side."""

from __future__ import annotations

from pathlib import Path

LENGTH = 240.0  # [m]
LANES = 2
WIDTH = 3.5  # [m] of a lane
SPEED = 13.89  # [m/s] limit, as in the towns that ship
APART = 200.0  # [m] between two roads: nobody on one is seen from another


def road_name(number: int) -> str:
    return f"road{number}"


def lane_name(road: int, lane: int) -> str:
    """Return the id of a road's lane; 0 is the right one."""
    return f"{road_name(road)}_{lane}"


def write_net(folder: Path, roads: int) -> Path:
    """Write a SUMO net of some parallel roads to the east; road n lies ``n * APART`` metres north of road 0."""
    height = (roads - 1) * APART
    box = f"0.00,0.00,{LENGTH:.2f},{height:.2f}"
    lines = [
        '<net version="1.20">',
        f'<location netOffset="0.00,0.00" convBoundary="{box}" origBoundary="{box}" projParameter="!"/>',
        *(_edge(number) for number in range(roads)),
        *(_ends(number) for number in range(roads)),
        "</net>",
    ]
    path = folder / f"local{roads}.net.xml"
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def _edge(number: int) -> str:
    name = road_name(number)
    lanes = "".join(_lane(number, lane) for lane in range(LANES))
    return f'<edge id="{name}" from="{name}a" to="{name}b" priority="-1">{lanes}</edge>'


def _lane(number: int, lane: int) -> str:
    y = number * APART + (lane + 0.5 - LANES / 2) * WIDTH
    sizes = f'speed="{SPEED}" length="{LENGTH:.2f}" width="{WIDTH:.2f}"'
    return f'<lane id="{lane_name(number, lane)}" index="{lane}" {sizes} shape="0.00,{y:.2f} {LENGTH:.2f},{y:.2f}"/>'


def _ends(number: int) -> str:
    name, y = road_name(number), number * APART
    inner = " ".join(lane_name(number, lane) for lane in range(LANES))
    left, right = y + LANES * WIDTH / 2, y - LANES * WIDTH / 2
    rows = (("a", 0.0, ""), ("b", LENGTH, inner))
    return "".join(
        f'<junction id="{name}{end}" type="dead_end" x="{x:.2f}" y="{y:.2f}" incLanes="{lanes}" intLanes="" '
        f'shape="{x:.2f},{left:.2f} {x:.2f},{right:.2f}"/>'
        for end, x, lanes in rows
    )
