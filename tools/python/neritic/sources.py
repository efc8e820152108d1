"""The sources of a world's samples (devices, programs, clients), and what became of what they sent."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Mapping, Optional, Sequence, TypedDict


@dataclass(frozen=True)
class Link:
    """The link of a device that the scene opens. None: its packets have no clock."""

    device: str  # "mxtp"
    where: str  # "udp://127.0.0.1:9763"
    rate_hz: float  # packets of late
    lost: int  # packets that never came, by their own counter
    clock_offset_s: Optional[float]  # this machine's clock minus the device's
    clock_drift_ppm: Optional[float]  # by which the device's clock is slow; 0 in the first half minute
    jitter_ms: Optional[float]  # mean of the way's time beyond the shortest
    trouble: str  # of the connection, or why nothing is used


@dataclass(frozen=True)
class Source:
    """A source, and its samples since the world was opened."""

    name: str
    accepted: int
    dropped: int  # accepted, then replaced by newer ones in a burst: more than some 1000 between two steps
    lost: int  # by their numbers, which never came
    late: int  # captured more than 0.5 s before they came, or after
    repeated: int
    out_of_order: int
    not_finite: int
    not_plausible: int  # a place, speed or force that cannot be, a rotation that is none
    not_of_stream: int
    health: str  # "good", "waiting" (never heard), "lost" (fell silent), "" (nothing listens to it)
    link: Optional[Link]  # None: it is no device of the scene, or the scene's devices are not listened to


class Counts(TypedDict):
    """Losses of a world in this process."""

    dropped_readings: int  # readings and images that came faster than they were taken
    sources: dict[str, Source]


class ServerCounts(Counts):
    """Losses of a server, and of this client's readings."""

    clients: int
    requests: int
    refused: int
    busy: int  # requests of clients with too many on their way
    lost_messages: int
    too_fast: int
    too_many: int
    unknown_keys: int
    failed_handshakes: int
    crowded_out: int
    endless: int
    lost_readings: int
    lost_images: int


def sources_of(told: Sequence[Mapping[str, Any]]) -> dict[str, Source]:
    """The sources by name, from the core's dicts or a server's answer."""
    return {one["name"]: Source(**{**one, "link": Link(**one["link"]) if "link" in one else None}) for one in told}
