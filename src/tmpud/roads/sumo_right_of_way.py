"""Who gives way to whom at the junctions of a SUMO net."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from tmpud.roads.network import LaneConnection
from tmpud.roads.sumo_links import Links
from tmpud.roads.xml_reading import Element, shown


def with_right_of_way(
    links: Links, nodes: Mapping[str, Element], rows: Mapping[str, Sequence[Element]]
) -> tuple[LaneConnection, ...]:
    """Return the connections with ``yields_to`` and ``foes`` filled in from the junctions' request rows.

    A junction numbers its links along its incoming lanes (``incLanes``) and, for each lane, in the file's order of
    connections; those of pedestrians on walking areas have no number. Bit k from the right is about link k.
    """
    lanes = {lane.text("id") for row in rows.values() for lane in row}
    connections = list(links.connections)
    for node in nodes.values():
        requests = [child for child in node.children if child.tag == "request"]
        order = _link_order(node, links, lanes)
        if not requests:
            continue
        if len(order) > len(requests):
            raise node.error(f"{len(order)} links enter it but it has {len(requests)} request rows")
        order += [None] * (len(requests) - len(order))
        for number, request in enumerate(requests):
            if request.natural("index") != number:
                raise request.error(f"index={shown(request.text('index'))} should be {number}, its place here")
            responses, foes = (_bits(request, name, order) for name in ("response", "foes"))
            if (index := order[number]) is not None:
                connections[index] = replace(connections[index], yields_to=responses, foes=foes)
    return tuple(connections)


def _link_order(node: Element, links: Links, lanes: set[str]) -> list[int | None]:
    """Return the index in ``links.connections`` of each of a junction's links, None for one that is left out."""
    order: list[int | None] = []
    for lane in node.text("incLanes", "").split():
        if lane not in lanes:
            raise node.error(f"incLanes: {shown(lane)} is not a lane of this net")
        order += [index for index, counts in links.leaving.get(lane, ()) if counts]
    return order


def _bits(request: Element, name: str, order: Sequence[int | None]) -> tuple[int, ...]:
    """Return the connections whose bit is set."""
    bits = request.text(name)
    if len(bits) != len(order) or not set(bits) <= {"0", "1"}:
        raise request.error(f"{name}={shown(bits)} is not {len(order)} digits 0 or 1")
    return tuple(index for index, bit in zip(order, reversed(bits), strict=True) if bit == "1" and index is not None)
