"""Instants that repeat at a rate which need not divide the physics' rate: each at the first step at or after its time, so that their
mean rate is the one that was asked for and none is late by a step or more."""
import math

from scenario import Failed


class Instants:
    """rate_hz: instants a second, at most one a step; step_s: s, of a step of the physics; where: what names the rate, for its refusal."""

    def __init__(self, where, rate_hz, step_s):
        if rate_hz * step_s > 1 + 1e-9:
            raise Failed(f"{where}: found {rate_hz:g}; accepted: at most {1.0 / step_s:g}, the rate of the physics")
        self._between, self._number, self.step = 1.0 / (rate_hz * step_s), 0, 0

    def take(self, step):
        """Goes on to the first instant after this step, which self.step then is; both are counted from the first instant's step."""
        while self.step <= step:
            self._number += 1
            self.step = math.ceil(self._number * self._between - 1e-6)
