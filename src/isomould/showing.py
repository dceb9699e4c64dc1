"""Shows how far a run has come, on stderr: in a terminal, in a pipe, in a notebook.

Rich is imported with the first step: what is refused before waits for nothing.
"""

from __future__ import annotations

import math
import sys
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

from isomould.progress import Step

if TYPE_CHECKING:
    from rich.live import Live
    from rich.text import Text

    from isomould.reader import Reader

_LINE_SECONDS, _NOTEBOOK_SECONDS = 5.0, 0.5
"""Between two lines of one stage in a pipe, and between two texts in a notebook."""

_KNOWN_SECONDS, _KNOWN_SHARE = 3.0, 0.03
"""Run time and share of the work after which the time left is told."""


@dataclass(frozen=True)
class Forecast:
    """A step, and the seconds on the clock when the run began and when the step was told."""

    step: Step
    began: float
    told: float

    def left(self, now: float) -> float | None:
        """Give the seconds that the rest of the run takes if it goes on as it went; None if that is not known.

        Nothing is known of a run that has just begun, nor once a stage takes longer than all was to take.

        >>> Forecast(Step("drawings", share=0.25), began=0.0, told=20.0).left(25.0)
        55.0
        """
        share, spent = self.step.share, self.told - self.began
        if share is None or share < _KNOWN_SHARE or spent < _KNOWN_SECONDS:
            return None
        left = spent * (1 - share) / share - (now - self.told)
        return left if left >= 1 else None

    def text(self, now: float) -> str:
        """Say how far the run has come, and how long it will take if that is known."""
        left = self.left(now)
        return str(self.step) if left is None else f"{self.step}, about {_in_words(left)} left"


def _in_words(seconds: float) -> str:
    """Say a time as roughly as it is known.

    >>> [_in_words(seconds) for seconds in (3.2, 41.0, 100.0, 5000.0)]
    ['4 s', '45 s', '2 min', '84 min']
    """
    if seconds > 90:
        return f"{math.ceil(seconds / 60)} min"
    step = 1 if seconds < 10 else 5
    return f"{math.ceil(seconds / step) * step} s"


class _Screen(Protocol):
    """Where progress is shown."""

    def show(self, forecast: Forecast) -> None:
        """Show the newest step."""
        ...

    def close(self) -> None:
        """Leave nothing half shown."""
        ...


class Progress:
    """Shows every step of a run that it is told: one line that changes, or lines one after another in a pipe.

    Parameters
    ----------
    quiet
        Whether nothing is shown.
    patience
        Seconds before anything is shown.
    by_itself
        Whether the line of a terminal moves between steps too: a thread does that. Those who start processes in the
        meantime have none.
    clock
        Gives seconds.

    Examples
    --------
    >>> with Progress(quiet=True) as progress:
    ...     progress(Step("nesting", 3, 9))
    """

    def __init__(
        self,
        quiet: bool = False,
        patience: float = 0.0,
        by_itself: bool = True,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._by_itself = by_itself
        self._quiet, self._patience, self._clock = quiet, patience, clock
        self._began = clock()
        self._screen: _Screen | None = None

    def __enter__(self) -> Progress:
        return self

    def __call__(self, step: Step) -> None:
        """Show a step."""
        now = self._clock()
        if self._quiet or now - self._began < self._patience:
            return
        if self._screen is None:
            self._screen = _open_screen(self._clock, self._by_itself)
        with suppress(OSError):  # a full log must not stop the work
            self._screen.show(Forecast(step, self._began, now))

    def __exit__(self, *_: object) -> None:
        if self._screen is not None:
            with suppress(OSError):
                self._screen.close()


def _open_screen(clock: Callable[[], float], by_itself: bool) -> _Screen:
    """Give the screen that suits stderr."""
    from isomould.reader import Reader

    console = Reader(stderr=True)
    if console.is_jupyter:
        return _Notebook()
    return _Terminal(console, clock, by_itself) if console.is_terminal else _Lines(console)


class _Terminal:
    """A spinner with a line that counts down, by itself or with every step."""

    def __init__(self, console: Reader, clock: Callable[[], float], by_itself: bool) -> None:
        self._console, self._clock, self._by_itself = console, clock, by_itself
        self._forecast: Forecast | None = None
        self._live: Live | None = None

    def __rich__(self) -> Text:
        """Give what stands beside the spinner now."""
        from rich.text import Text

        return Text(self._forecast.text(self._clock()) if self._forecast else "")

    def show(self, forecast: Forecast) -> None:
        """Show the newest step."""
        self._forecast = forecast
        if self._live is None:
            self._live = self._start()
        elif not self._by_itself:
            self._live.refresh()

    def _start(self) -> Live:
        from rich.live import Live
        from rich.spinner import Spinner

        spinner = Spinner("dots", self)
        live = Live(spinner, console=self._console, auto_refresh=self._by_itself, transient=True)
        live.start(refresh=True)
        return live

    def close(self) -> None:
        """Take the line away."""
        if self._live is not None:
            self._live.stop()


class _Notebook:
    """A line of plain text that is written over: notebooks have no cursor, but they know the return to its start."""

    def __init__(self) -> None:
        self._shown, self._stage, self._width = -math.inf, "", 0

    def show(self, forecast: Forecast) -> None:
        """Show a step that begins a stage, or comes some time after the last that was shown."""
        begins = forecast.step.stage != self._stage
        if begins or forecast.told - self._shown >= _NOTEBOOK_SECONDS:
            text = forecast.text(forecast.told)
            self._write(f"\r{text:{self._width}}")
            self._shown, self._stage, self._width = forecast.told, forecast.step.stage, len(text)

    def close(self) -> None:
        """Go on below."""
        self._write("\n")

    def _write(self, text: str) -> None:
        sys.stderr.write(text)
        sys.stderr.flush()


class _Lines:
    """A line as every stage begins, and others a few seconds apart."""

    def __init__(self, console: Reader) -> None:
        self._console = console
        self._shown, self._stage = -math.inf, ""

    def show(self, forecast: Forecast) -> None:
        """Show a step that begins a stage, or comes some time after the last that was shown."""
        begins = forecast.step.stage != self._stage
        if begins or forecast.told - self._shown >= _LINE_SECONDS:
            self._shown, self._stage = forecast.told, forecast.step.stage
            self._console.out(forecast.text(forecast.told), highlight=False)

    def close(self) -> None:
        """Nothing is half shown."""
