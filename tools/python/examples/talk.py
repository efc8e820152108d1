"""A diver calls an ROV by sound; a buoy finds the ROV by its modem and tells it where it is."""

import struct
import sys
from pathlib import Path

import numpy as np

import neritic

SCENE = str(Path(__file__).resolve().parents[3] / "assets/scenes/talk.toml")


def main(scene: str = SCENE, seconds: float = 40.0) -> dict[str, float]:
    world = neritic.open(scene, seed=1)
    diver, rov, buoy = world["diver"], world["rov"], world["buoy"]
    lost: list[str] = []
    fixes: list[neritic.Reading] = []
    for agent in (diver, rov, buoy):
        world.on(f"{agent.name}/modem", lambda seen: lost.append(neritic.MODEM_EVENTS[int(seen.event)])
                 if seen.event > 2 else None)
    world.on("buoy/usbl", fixes.append)
    worst_m, told, answered = 0.0, 0, 0
    call_at = 1.4
    while world.time < seconds:
        world.tick(24)
        if world.time >= call_at:  # between the buoy's requests and answers
            diver.send("come", to="rov")
            call_at += 6.0
        while fixes:
            fix = fixes.pop(0)
            if fix.heard:
                buoy.send(struct.pack("<3f", *fix.position), to="rov")
        for message in rov.receive():
            if message.sender == "buoy":
                off = np.linalg.norm(struct.unpack("<3f", message.data) - world.truth("rov").position)
                worst_m, told = max(worst_m, float(off)), told + 1
            elif message.data == b"come":
                rov.send("coming", to="diver")
        for message in diver.receive():
            answered += 1
            print(f"{world.time:5.1f} s: the diver hears '{message.data.decode()}' from the {message.sender}, "
                  f"{(message.heard - message.sent) * 1e3:.1f} ms away, {message.snr_db:.0f} dB above the noise")
    print(f"{told} places told by the buoy, up to {worst_m:.2f} m off when they came; lost: "
          f"{', '.join(lost) or 'nothing'}")
    return {"told": told, "worst_m": worst_m, "answered": answered, "lost": len(lost)}


if __name__ == "__main__":
    main(*sys.argv[1:])
