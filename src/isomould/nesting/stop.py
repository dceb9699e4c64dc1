"""Asked by a search whether to stop: after a time limit, or once somebody interrupted it."""

import time
from collections.abc import Callable
from dataclasses import dataclass, field

Stops = Callable[[], bool]
"""Tells whether a search should end."""


def never() -> bool:
    """Let a search run to its end."""
    return False


@dataclass
class Heard:
    """Asks another whether to stop, and knows whether the answer was ever yes."""

    asked: Stops
    told: bool = False

    def __call__(self) -> bool:
        """Tell whether the search should end."""
        self.told = self.told or self.asked()
        return self.told


@dataclass
class Stop:
    """A time limit and a way to interrupt: `interrupt` may be called from a signal handler at any moment."""

    seconds: float | None = None
    interrupted: bool = False
    started: float = field(default_factory=time.monotonic)

    def interrupt(self, *_: object) -> None:
        """Ask for an end at the next checkpoint; takes and ignores what a signal handler is given."""
        self.interrupted = True

    def __call__(self) -> bool:
        """Tell whether the search should end."""
        return self.interrupted or (self.seconds is not None and time.monotonic() - self.started >= self.seconds)
