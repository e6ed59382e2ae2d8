"""How much is checked, and on which maps."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from tmpud.roads import shipped_towns
from tools.verification.figures import ROOT

BESIDE = ROOT.parent / "shared" / "maps"  # maps that do not ship with the package; used where they are present


@dataclass(frozen=True, slots=True, kw_only=True)
class Options:
    """The n of each section; the defaults are the full figures."""

    given_maps: tuple[str, ...] = ()  # net files of the user's
    missions: int = 20  # per map and algorithm
    carla_missions: int = 10  # per density
    repeats: int = 10
    graphs: int = 10_000  # a fifth as many under rules
    cases: int = 10_000
    mutants: int = 300  # per map
    seconds: float = 3600.0  # [s] simulated, of traffic
    traffic: int = 120  # vehicles in missions
    kills: int = 100  # campaigns killed at random moments, and as many at placed ones
    interrupts: int = 50  # campaigns
    disks: int = 100  # campaigns that run out of disk
    meetings: int = 50  # of two supervisors on a folder
    damages: int = 1_000
    table_trials: int = 200  # per algorithm and density
    figure_trials: int = 4_000  # per algorithm and road condition
    same_trials: int = 20  # per algorithm and density, each way
    hangs: int = 100  # tasks that crash, hang or answer nonsense

    @property
    def maps(self) -> tuple[str, ...]:
        """The shipped towns, the maps beside the checkout, and the user's."""
        return (*shipped_towns(), *_beside("*.net.xml"), *self.given_maps)

    @property
    def mission_maps(self) -> tuple[str, ...]:
        """The maps on which missions are driven."""
        return (*shipped_towns(), *(self.given_maps or _beside("Town05.net.xml")))


def map_name(source: str) -> str:
    """Return what a map is called in a report, whatever folder it lies in."""
    return Path(source).name.removesuffix(".gz").removesuffix(".net.xml")


def _beside(pattern: str) -> list[str]:
    return sorted(str(file) for file in BESIDE.glob(pattern))
