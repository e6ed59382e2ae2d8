"""Maps by name: the towns that ship with the package, or a map from a file."""

from __future__ import annotations

from functools import partial
from pathlib import Path

from tmpud.errors import MapError
from tmpud.roads.cache import LARGE, cache_folder, read_cached
from tmpud.roads.network import SEGMENT_LENGTH, RoadNetwork
from tmpud.roads.sumo_net import read_sumo_net
from tmpud.roads.towns import street_names
from tmpud.roads.xml_reading import shown

OPENDRIVE = ".xodr"
_TOWNS = Path(__file__).parent / "towns"
NETS = (".net.xml", ".net.xml.gz")
_SUFFIXES = (*NETS, OPENDRIVE)


def shipped_towns() -> tuple[str, ...]:
    """Return the names of the towns that ship with the package."""
    return tuple(sorted(path.name.removesuffix(".net.xml.gz") for path in _TOWNS.glob("*.net.xml.gz")))


def map_file(name_or_path: str | Path) -> Path:
    """Return the file of a shipped town or a path; MapError where it is neither."""
    text = str(name_or_path)
    if text in shipped_towns():
        return _TOWNS / f"{text}.net.xml.gz"
    if text.endswith(_SUFFIXES):
        return Path(text)
    raise MapError(
        shown(text),
        None,
        f"no such town (there are: {', '.join(shipped_towns())}), nor a {' or '.join(_SUFFIXES)} file",
    )


def load_map(name_or_path: str | Path, segment_length: float = SEGMENT_LENGTH) -> RoadNetwork:
    """Return the road network of a shipped town or a file, in segments of at most this length [m].

    A large one, and any from OpenDRIVE, is kept in the user's cache folder (``roads.cache``). Raises MapError.
    """
    file = map_file(name_or_path)
    if file.suffix != OPENDRIVE:
        read = partial(read_sumo_net, segment_length=segment_length)
        network = read_cached(file, segment_length, read, cache_folder(), LARGE)
        if str(name_or_path) in shipped_towns():
            network.street_names = street_names(network.edges)
        return network
    from tmpud.roads.opendrive.reading import read_opendrive

    read = partial(read_opendrive, segment_length=segment_length)
    return read_cached(file, segment_length, read, cache_folder(), 0)
