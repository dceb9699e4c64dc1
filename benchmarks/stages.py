"""Time of every stage of a template, and the memory that a million panels take.

    python benchmarks/stages.py [TEMPLATE.toml]

Times are shares of one run, because machines differ; memory is measured in copies of the surface's own array.
"""

import sys
import tempfile
import time
import tracemalloc
from pathlib import Path

import numpy as np

import isomould
from isomould.curves.construction import build_curve
from isomould.curves.plane import build_plane
from isomould.curves.settings import CircleSettings, SineSettings
from isomould.form.division import Request, divide_curve
from isomould.form.orientation import orient_rail, place_generatrix
from isomould.form.profile import make_profile
from isomould.form.rail import planar_rail
from isomould.form.settings import FormLimits, GeneratrixDivide, RailDivide, Treatment
from isomould.form.surface import Surface, make_surface

ROOT = Path(__file__).parents[1]


def time_stages(template: Path) -> list[tuple[str, float]]:
    """Build a template and give the seconds that each stage took."""
    marks: list[tuple[str, float]] = []
    with tempfile.TemporaryDirectory() as folder:
        isomould.build(
            template,
            Path(folder) / "out",
            run=isomould.Run(report=lambda stage: marks.append((stage, time.perf_counter()))),
        )
    ends = [*(moment for _, moment in marks[1:]), time.perf_counter()]
    return [(stage, end - start) for (stage, start), end in zip(marks, ends, strict=True)]


def factors(count: int) -> tuple[object, object]:
    """Rail and profile of a surface of about count × count panels."""
    circle, _ = build_curve(CircleSettings(kind="circle", radius=1e6), ROOT)
    wave, _ = build_curve(SineSettings(kind="sine", amplitude=5e3, wavelength=4e5, waves=2), ROOT)
    limits = FormLimits(min_member=1.0, max_panels=10**7)
    request = Request("rail", RailDivide(nodes=count), Treatment(), limits)
    profile = Request("generatrix", GeneratrixDivide(nodes=count), Treatment(), limits)
    rail = planar_rail(divide_curve(orient_rail(circle, "outer"), request), build_plane("xy"), "square")
    placed = place_generatrix(wave, (0.0, 0.0), "zd", (1.0, 0.0))
    return rail, make_profile(divide_curve(placed, profile), None)


def measure_memory(count: int = 1000) -> tuple[Surface, float, float]:
    """Give the surface, its peak memory in copies of its own array, and its time over that of one numpy pass."""
    rail, profile = factors(count)
    tracemalloc.start()
    start = time.perf_counter()
    surface = make_surface(rail, profile)
    seconds = time.perf_counter() - start
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    start = time.perf_counter()
    np.add(surface.V, 1.0)
    return surface, peak / surface.V.nbytes, seconds / (time.perf_counter() - start)


def main() -> None:
    template = Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "templates" / "barrel-vault.toml"
    stages = time_stages(template)
    total = sum(seconds for _, seconds in stages)
    for stage, seconds in stages:
        print(f"{stage:50} {seconds:8.2f} s {100 * seconds / total:6.1f} %")
    print(f"{'all of ' + template.stem:50} {total:8.2f} s")
    surface, copies, passes = measure_memory()
    panels = (surface.V.shape[0] - 1) * surface.V.shape[1]
    print(f"surface of {panels} panels: peak {copies:.2f} copies of its array, {passes:.1f} times one pass over it")


if __name__ == "__main__":
    main()
