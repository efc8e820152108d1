"""The three divers: one body, other suits and gear. Colours are linear, those of the suit in sRGB as textures have them."""
from dataclasses import dataclass

YELLOW, ORANGE, WHITE, STEEL = (0.66, 0.45, 0.04), (0.85, 0.22, 0.03), (0.72, 0.73, 0.72), (0.34, 0.36, 0.37)


@dataclass(frozen=True)
class Look:
    model: str
    suit: tuple = (0.115, 0.12, 0.13)
    panel: tuple = (0.06, 0.27, 0.44)
    tank: tuple = YELLOW
    fins: tuple = YELLOW
    accent: tuple = ORANGE  # lobes of the jacket, knife
    mask: tuple = (0.03, 0.03, 0.032)
    snorkel: bool = True
    twin: bool = False  # two cylinders, as divers of wrecks and caves wear
    texture_px: int = 1024


LOOKS = (
    Look("diver"),
    Look("diver_grey", suit=(0.24, 0.25, 0.27), panel=(0.50, 0.11, 0.10), tank=WHITE, fins=(0.05, 0.16, 0.42),
         accent=(0.30, 0.03, 0.03), mask=(0.45, 0.46, 0.46), snorkel=False),
    Look("diver_twin", suit=(0.10, 0.10, 0.105), panel=(0.14, 0.14, 0.15), tank=STEEL, fins=(0.035, 0.035, 0.037),
         accent=(0.05, 0.05, 0.052), snorkel=False, twin=True),
)
