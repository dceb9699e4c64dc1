"""Form finding (paper §4.5): time from a changed value to surface, classes and mismatch, as a slider asks for it.

    python benchmarks/form_finding.py

Times are the best of several runs; the last column divides them by one pass of numpy over the same arrays: lengths of
all edges, areas of all faces.
"""

import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

import isomould
from isomould.form.mesh import Mesh
from isomould.study import Study

TEMPLATE = Path(__file__).parents[1] / "templates" / "barrel-vault.toml"
SIZES = {"1,000 panels": (24, 10), "4,000 panels": (48, 20), "10,000 panels": (76, 32)}
"""Nodes of the rail, and nodes per arc of the generatrix."""
_RUNS = 5


def start(rail: int, arc: int) -> Study:
    """A barrel vault of about so many panels; large ones have finer limits, for their members are short."""
    sizes = [f"rail.divide.nodes={rail}", f"generatrix.divide.per_arc={arc}"]
    scale = max(1.0, rail / 24)
    spans = [f"rail.curve.span={24_000 * scale}", f"generatrix.curve.wavelength={14_000 * scale}"]
    heights = [f"rail.curve.rise={9_000 * scale}", f"generatrix.curve.amplitude={1_000 * scale}"]
    return isomould.explore(TEMPLATE, [*sizes, *spans, *heights])


def numpy_pass(mesh: Mesh) -> float:
    """One pass over the mesh that any program must make."""
    corner = mesh.nodes[mesh.faces.reshape(-1, 4)]
    areas = np.linalg.norm(np.cross(corner[:, 2] - corner[:, 0], corner[:, 3] - corner[:, 1]), axis=1)
    return float(
        np.linalg.norm(mesh.nodes[mesh.edges[:, 1]] - mesh.nodes[mesh.edges[:, 0]], axis=1).sum() + areas.sum()
    )


def best(work: Callable[[], object]) -> float:
    """Best time of several runs, in seconds."""
    found = float("inf")
    for _ in range(_RUNS):
        begin = time.perf_counter()
        work()
        found = min(found, time.perf_counter() - begin)
    return found


def measure(rail: int, arc: int) -> tuple[int, float, float]:
    """Panels, seconds per change, and seconds of the numpy pass."""
    study = start(rail, arc)
    height = study.tables["rail"]["curve"]["rise"]
    seconds = best(lambda: study.with_changes({"rail.curve.rise": 0.98 * height}).facts)
    return len(study.design.kit.mesh.face_ij), seconds, best(lambda: numpy_pass(study.design.kit.mesh))


def main() -> None:
    print("size              panels   a change   changes/s   numpy pass   ratio")
    for name, sizes in SIZES.items():
        panels, seconds, once = measure(*sizes)
        times = f"{1e3 * seconds:7.1f} ms {1 / seconds:11.1f} {1e3 * once:9.3f} ms {seconds / once:7.0f}"
        print(f"{name:16} {panels:7d} {times}")


if __name__ == "__main__":
    main()
