"""Which lanes of a SUMO net are open to cars (SUMO's vehicle class ``passenger``)."""

from __future__ import annotations

from tmpud.roads.xml_reading import Element, shown

CAR = "passenger"
# SUMO's classes, those of old nets included.
_NAMES = """
all ignoring private emergency authority army vip pedestrian passenger hov taxi bus coach delivery truck trailer
motorcycle moped bicycle evehicle tram rail_urban rail rail_electric rail_fast ship container cable_car subway aircraft
wheelchair scooter drone custom1 custom2 public_emergency public_authority public_army public_transport transport
lightrail cityrail rail_slow
"""
_CLASSES = frozenset(_NAMES.split())


def open_to_cars(element: Element) -> bool:
    """Whether a lane or connection admits cars: ``allow`` counts before ``disallow``, neither means everybody."""
    if element.attributes.get("allow"):
        return names_cars(element, "allow")
    return not names_cars(element, "disallow", default="")


def names_cars(element: Element, attribute: str, default: str = "all") -> bool:
    """Whether a list of vehicle classes includes cars; MapError at a class that SUMO does not have."""
    names = element.attributes.get(attribute, default).split()
    for name in names:
        if name not in _CLASSES:
            raise element.error(f"{attribute}: {shown(name)} is not a vehicle class of SUMO")
    return "all" in names or CAR in names
