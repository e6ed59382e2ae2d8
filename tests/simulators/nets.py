"""Nets for SUMO, made by netconvert from a few lines."""

from __future__ import annotations

from pathlib import Path

from tmpud.roads.sumo_tools import run_tool

Row = tuple[str, ...]

# Two lanes each way from W by way of J1 and J2 to E; at J2 the left lane turns left into a road to N. Beyond W, E and
# N one-way roads lead back, so that traffic can circulate.
TWO_BLOCKS_NODES = (("W", "0", "0"), ("J1", "118", "0"), ("J2", "236", "0"), ("E", "354", "0"), ("N", "236", "118"))
TWO_BLOCKS_EDGES = (
    ("a", "W", "J1", "2"), ("b", "J1", "J2", "2"), ("c", "J2", "E", "2"), ("goal", "J2", "N", "1"),
    ("-a", "J1", "W", "2"), ("-b", "J2", "J1", "2"), ("-c", "E", "J2", "2"), ("west", "N", "W", "1"),
    ("east", "E", "N", "1"),
)  # fmt: skip
TWO_BLOCKS_LINKS = (
    ("a", "b", "0", "0"), ("a", "b", "1", "1"), ("b", "c", "0", "0"), ("b", "goal", "1", "0"),
    ("-c", "-b", "0", "0"), ("-c", "-b", "1", "1"), ("-b", "-a", "0", "0"), ("-b", "-a", "1", "1"),
    ("goal", "west", "0", "0"), ("east", "west", "0", "0"), ("west", "a", "0", "0"), ("c", "east", "0", "0"),
)  # fmt: skip

# A road out of a ring of one-way roads into a dead end.
SPUR_NODES = (("A", "0", "0"), ("B", "150", "0"), ("C", "75", "120"), ("D", "300", "0"))
SPUR_EDGES = (("ab", "A", "B", "1"), ("bc", "B", "C", "1"), ("ca", "C", "A", "1"), ("spur", "B", "D", "1"))


def two_blocks(folder: Path) -> Path:
    return build(folder / "blocks.net.xml", TWO_BLOCKS_NODES, TWO_BLOCKS_EDGES, TWO_BLOCKS_LINKS)


def spur(folder: Path) -> Path:
    return build(folder / "spur.net.xml", SPUR_NODES, SPUR_EDGES)


def build(net: Path, nodes: tuple[Row, ...], edges: tuple[Row, ...], links: tuple[Row, ...] = ()) -> Path:
    """Convert rows (id, x, y), (id, from, to, lanes) and (from, to, from lane, to lane) to a net file."""
    rows = {
        "node": ("nodes", ("id", "x", "y"), nodes),
        "edge": ("edges", ("id", "from", "to", "numLanes"), edges),
        "connection": ("connections", ("from", "to", "fromLane", "toLane"), links),
    }
    options = {"output-file": str(net), "no-turnarounds.except-deadend": "true", "offset.disable-normalization": "true"}
    for name, (root, keys, table) in rows.items():
        source = net.with_suffix(f".{name}.xml")
        text = "".join(f"<{name} {_attributes(keys, row)}/>\n" for row in table)
        source.write_text(f"<{root}>\n{text}</{root}>\n", encoding="utf-8")
        options[f"{name}-files"] = str(source)
    run_tool("netconvert", options)
    return net


def _attributes(keys: tuple[str, ...], row: Row) -> str:
    return " ".join(f'{key}="{value}"' for key, value in zip(keys, row, strict=True))
