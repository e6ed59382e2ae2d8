"""A strict reader of SUMO nets (``.net.xml``, ``.net.xml.gz``): a whole road network or a MapError with file and line.

Coordinates stay the net's own. What is not for cars is left out, as are turnarounds unless asked for.
Source of the format: SUMO's documentation, "SUMO Road Networks".
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from tmpud.geometry import Polyline
from tmpud.roads.network import NOWHERE, SEGMENT_LENGTH, WHOLE, Frame, Junction, Lane, RoadNetwork, SignalProgram
from tmpud.roads.rows import map_name
from tmpud.roads.sumo_links import Links, read_links
from tmpud.roads.sumo_right_of_way import with_right_of_way
from tmpud.roads.vehicle_classes import names_cars, open_to_cars
from tmpud.roads.xml_reading import Element, read_xml, shown

_KEPT = frozenset(["location", "edge", "lane", "junction", "request", "connection", "tlLogic", "phase"])
_FUNCTIONS = frozenset(["normal", "internal", "connector", "crossing", "walkingarea"])
_LIGHTS = frozenset("rugGyYsoO")
_DEFAULT_WIDTH = 3.2  # [m]
_LONGEST = 100_000.0  # [m] a longer lane is a mistake, and would be cut into very many segments


def read_sumo_net(path: Path, *, turnarounds: bool = False, segment_length: float = SEGMENT_LENGTH) -> RoadNetwork:
    """Read a net; ``turnarounds`` keeps the connections back to the road's other side. Raises MapError."""
    root, digest = read_xml(path, "net", _KEPT)
    if root.attributes.get("lefthand", "false") not in ("false", "0"):
        raise root.error("left-hand traffic is not supported; mirror the net first")
    found: dict[str, list[Element]] = {tag: [] for tag in _KEPT}
    for element in root.children:
        found[element.tag].append(element)
    nodes = _by_id(found["junction"])
    edges = _by_id(found["edge"])
    functions = {edge_id: edge.choice("function", _FUNCTIONS, "normal") for edge_id, edge in edges.items()}
    _check_ends(edges, functions, nodes)
    rows = _lane_elements(edges)
    lanes = _open_lanes(rows, functions)
    if not lanes:
        raise root.error("there is no lane that is open to cars")
    signals = _signals(found["tlLogic"])
    links = read_links(found["connection"], edges, rows, functions, lanes, turnarounds)
    _check_signals(links, signals)
    return RoadNetwork(
        name=map_name(path),
        lanes=lanes,
        connections=with_right_of_way(links, nodes, rows),
        junctions=_junctions(nodes, {edges[lane.edge].text(end) for lane in lanes.values() for end in ("from", "to")}),
        signals=signals,
        frame=_frame(found["location"]),
        source=str(path),
        digest=digest,
        warnings=tuple(_warnings(rows, functions, lanes, links)),
        segment_length=segment_length,
        street_names=_street_names(edges, lanes),
    )


def _by_id(elements: Iterable[Element]) -> dict[str, Element]:
    found: dict[str, Element] = {}
    for element in elements:
        name = element.identifier("id")
        if name in found:
            raise element.error(f"id {shown(name)} is already used in line {found[name].line}")
        found[name] = element
    return found


def _check_ends(edges: dict[str, Element], functions: dict[str, str], nodes: dict[str, Element]) -> None:
    """Refuse a road that starts or ends at a junction which is not in the net."""
    for edge_id, edge in edges.items():
        if functions[edge_id] != "normal":
            continue
        for end in ("from", "to"):
            if edge.text(end) not in nodes:
                raise edge.error(f"{end}={shown(edge.text(end))} is not a junction of this net")


def _lane_elements(edges: dict[str, Element]) -> dict[str, list[Element]]:
    """Return each edge's lanes, rightmost first; a road's indices must be 0, 1, 2, ... in this order.

    (netconvert itself repeats indices within junctions, where nothing depends on them.)
    """
    rows: dict[str, list[Element]] = {}
    seen: dict[str, Element] = {}
    for edge_id, edge in edges.items():
        rows[edge_id] = row = [child for child in edge.children if child.tag == "lane"]
        if not row:
            raise edge.error(f"edge {shown(edge_id)} has no lane")
        for place, lane in enumerate(row):
            if lane.natural("index") != place and "from" in edge.attributes:
                raise lane.error(f"index={shown(lane.text('index'))} should be {place}, its place in the edge")
        for lane in row:
            lane_id = lane.identifier("id")
            if lane_id in seen:
                raise lane.error(f"id {shown(lane_id)} is already used in line {seen[lane_id].line}")
            seen[lane_id] = lane
    return rows


def _open_lanes(rows: dict[str, list[Element]], functions: dict[str, str]) -> dict[str, Lane]:
    return {
        lane.text("id"): _lane(edge_id, lane)
        for edge_id, row in rows.items()
        if functions[edge_id] == "normal"
        for lane in row
        if open_to_cars(lane)
    }


def _street_names(edges: dict[str, Element], lanes: dict[str, Lane]) -> dict[str, str]:
    named = ((edge, edges[edge].text("name", "")) for edge in dict.fromkeys(lane.edge for lane in lanes.values()))
    return {edge: name for edge, name in named if name}


def _lane(edge_id: str, element: Element) -> Lane:
    points, elevation = element.points("shape")
    try:
        centre = Polyline(points)
    except ValueError as error:
        raise element.error(f"shape: {error}") from error
    if centre.length > _LONGEST:
        raise element.error(f"shape: {centre.length:.0f} m is longer than any lane ({_LONGEST:.0f} m)")
    if len(centre.points) < len(points):  # the polyline left out points that equal the one before
        height = dict(zip(reversed(points), reversed(elevation), strict=True))
        elevation = tuple(height[point] for point in centre.points)
    return Lane(
        id=element.text("id"),
        edge=edge_id,
        index=element.natural("index"),
        centre=centre,
        elevation=elevation,
        width=element.number("width", _DEFAULT_WIDTH, low=0.01),
        speed=element.number("speed", low=0.01),
        change_left=WHOLE if names_cars(element, "changeLeft") else NOWHERE,
        change_right=WHOLE if names_cars(element, "changeRight") else NOWHERE,
    )


def _junctions(nodes: dict[str, Element], used: set[str]) -> dict[str, Junction]:
    """Return the junctions at which roads for cars start or end."""
    return {node_id: _junction(node_id, node) for node_id, node in nodes.items() if node_id in used}


def _junction(node_id: str, element: Element) -> Junction:
    shape, _ = element.points("shape", "")
    return Junction(node_id, element.text("type", "unknown"), element.number("x"), element.number("y"), tuple(shape))


def _signals(elements: Iterable[Element]) -> dict[str, SignalProgram]:
    """Return the program of each light; of several with one id the last, which is the one SUMO starts with."""
    signals: dict[str, SignalProgram] = {}
    seen: set[tuple[str, str]] = set()
    for element in elements:
        name, program = element.identifier("id"), element.text("programID", "0")
        if (name, program) in seen:
            raise element.error(f"program {shown(program)} of light {shown(name)} is defined twice")
        seen.add((name, program))
        phases = tuple(_phase(child) for child in element.children if child.tag == "phase")
        if not phases or len({len(state) for _, state in phases}) > 1:
            raise element.error(f"light {shown(name)} needs phases, all with a letter for each of its links")
        signals[name] = SignalProgram(name, _offset(element), phases)
    return signals


def _offset(element: Element) -> float:
    return 0.0 if element.attributes.get("offset") == "begin" else element.number("offset", 0.0)


def _phase(element: Element) -> tuple[float, str]:
    state = element.text("state")
    if not state or not _LIGHTS.issuperset(state):
        raise element.error(f"state={shown(state)} is not made of the letters {''.join(sorted(_LIGHTS))}")
    return element.number("duration", low=0.0), state


def _check_signals(links: Links, signals: dict[str, SignalProgram]) -> None:
    """Refuse a connection under a light, or a letter of it, that the net does not define."""
    for element, connection in zip(links.elements, links.connections, strict=True):
        if connection.signal is None:
            continue
        program = signals.get(connection.signal)
        if program is None:
            raise element.error(f"tl={shown(connection.signal)} has no tlLogic in this net")
        letters = len(program.phases[0][1])
        if connection.link >= letters:
            raise element.error(f"linkIndex={connection.link}: the light's states have {letters} letters")


def _frame(locations: list[Element]) -> Frame:
    if not locations:
        return Frame()
    location = locations[0]
    offsets, _ = location.points("netOffset", "0,0")
    if len(offsets) != 1:
        raise location.error("netOffset is not one point x,y")
    return Frame(offsets[0], location.text("projParameter", "!"))


def _warnings(
    rows: dict[str, list[Element]], functions: dict[str, str], lanes: dict[str, Lane], links: Links
) -> Iterable[str]:
    total = sum(len(row) for edge, row in rows.items() if functions[edge] == "normal")
    reached = {connection.to_lane for connection in links.connections}
    left = {connection.from_lane for connection in links.connections}
    stated = [(lane.number("length", low=0.0), lanes.get(lane.text("id"))) for row in rows.values() for lane in row]
    odd = sum(lane is not None and abs(length - lane.length) > 1.0 + 0.05 * lane.length for length, lane in stated)
    counts = [
        (total - len(lanes), "lanes closed to cars, left out"),
        (links.closed, "connections closed to cars, left out"),
        (links.turnarounds, "turnarounds, left out"),
        (len(lanes.keys() - left), "lanes without an exit"),
        (len(lanes.keys() - reached), "lanes without an entry"),
        (odd, "lanes whose stated length is not their shape's, which counts"),
    ]
    return [f"{what}: {count}" for count, what in counts if count]
