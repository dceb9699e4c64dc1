"""Table 2 of the paper: time of the isogonal subdivision of a parabola and of a spline with four inflections.

    python benchmarks/subdivision.py

The paper's times are for a script in Rhinoceros on a computer of 2.4 GHz; ours are the best of several runs.
"""

import time
from pathlib import Path

from isomould.curves.construction import build_curve
from isomould.curves.curve import PlanarCurve
from isomould.curves.settings import BsplineSettings, ParabolaSettings
from isomould.curves.turning import arcs, spans
from isomould.form.division import Request, divide_curve
from isomould.form.settings import FormLimits, RailDivide, Treatment

PAPER = {
    "parabola": {25: 0.04, 50: 0.06, 100: 0.12, 200: 0.21},
    "pseudo-sine": {25: 0.10, 50: 0.11, 100: 0.17, 200: 0.27},
}
_RUNS = 7


def curves() -> dict[str, PlanarCurve]:
    """The two curves of Fig. 15: a parabola, and a fourth-order spline with four inner inflections."""
    parabola = ParabolaSettings(kind="parabola", span=20_000, rise=7_500)
    points = tuple((4000.0 * k, 2000.0 * (-1) ** k) for k in range(7))
    wave = BsplineSettings(kind="bspline", degree=3, points=points)
    return {name: build_curve(s, Path())[0] for name, s in (("parabola", parabola), ("pseudo-sine", wave))}


def measure(curve: PlanarCurve, nodes: int) -> tuple[float, int]:
    """Best time in seconds, and the count of nodes obtained."""
    request = Request("rail", RailDivide(nodes=nodes), Treatment(), FormLimits())
    best, count = float("inf"), 0
    for _ in range(_RUNS):
        start = time.perf_counter()
        count = len(divide_curve(curve, request).vertices) - 2
        best = min(best, time.perf_counter() - start)
    return best, count


def main() -> None:
    print("curve        inflections  nodes  obtained    paper      ours  faster")
    for name, curve in curves().items():
        inflections = len(arcs(spans(curve)).sign) - 1
        for nodes, paper in PAPER[name].items():
            seconds, count = measure(curve, nodes)
            times = f"{paper:6.2f} s  {seconds:6.4f} s  {paper / seconds:5.0f} ×"
            print(f"{name:12} {inflections:11d}  {nodes:5d}  {count:8d}  {times}")


if __name__ == "__main__":
    main()
