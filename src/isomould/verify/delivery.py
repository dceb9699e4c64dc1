"""A delivered folder, read lazily: every file once, when the first check asks for it."""

import hashlib
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from isomould.errors import OutputFault
from isomould.verify.read.design import Design, read_design
from isomould.verify.read.dxf import Drawing, read_dxf, with_layers
from isomould.verify.read.dxf_texts import read_dxf_texts
from isomould.verify.read.glb import Model, read_glb
from isomould.verify.read.layout import Layout, read_layout
from isomould.verify.read.mesh import Mesh, edge_vectors, read_mesh
from isomould.verify.read.nc1 import NcFile, read_nc1
from isomould.verify.read.page import Page, read_page
from isomould.verify.read.pdf import Book, read_pdf
from isomould.verify.read.solid import Solid, read_3mf
from isomould.verify.read.tables import Table, pairs, read_table
from isomould.verify.read.text import Json, read_json
from isomould.verify.read.workbook import Workbook, read_workbook
from isomould.verify.rules import Floats, Unreadable
from isomould.verify.space import SEAM, frame_gap
from isomould.workers import Spread, one_by_one


@dataclass(frozen=True)
class Delivery:
    """A folder to prove; `final` says whether its certificate and final manifest must be there."""

    folder: Path
    final: bool = True
    spread: Spread = one_by_one

    @cached_property
    def mesh(self) -> Mesh:
        """The mesh of `model/geometry.npz`."""
        return read_mesh(self.folder / "model" / "geometry.npz")

    @cached_property
    def design(self) -> Design:
        """The design of `model/design.json`."""
        return read_design(self.folder / "model" / "design.json")

    @property
    def nesting(self) -> Json:
        """What was asked of the nests: gap, kerf, trim, mm."""
        return self.design.raw["nesting"]

    @property
    def flippable(self) -> bool:
        """Whether panels may be turned over."""
        return bool(self.design.raw["panel"].get("flippable", False))

    @cached_property
    def shapes(self) -> dict[str, "Delivery"]:
        """The other shapes of the project by name: complete folders of their own."""
        names = self.design.raw.get("shapes", [])
        return {name: Delivery(self.folder / "shapes" / name, spread=self.spread) for name in names}

    @cached_property
    def model(self) -> Model:
        """The placed parts of `model/model.glb`."""
        return read_glb(self.folder / "model" / "model.glb")

    @cached_property
    def certificate(self) -> Json:
        """The content of `certificate.json`."""
        return read_json(self.folder / "certificate.json")

    @cached_property
    def page(self) -> Page:
        """The tables, references and title of `report.html`."""
        return read_page(self.folder / "report.html")

    @cached_property
    def manifest(self) -> Json:
        """The content of `manifest.json`."""
        return read_json(self.folder / "manifest.json")

    @cached_property
    def scope(self) -> str:
        """What the manifest says that the folder holds; everything, if it cannot say."""
        try:
            return str(self.manifest["scope"])
        except (OutputFault, KeyError, TypeError):
            return "delivery"

    @cached_property
    def layout(self) -> Layout:
        """The nest of `sheets/nesting.json`."""
        return read_layout(self.folder / "sheets" / "nesting.json")

    @cached_property
    def tables(self) -> dict[str, Table]:
        """All tables by name."""
        return {path.stem: read_table(path) for path in self.files("tables", "csv")}

    @cached_property
    def workbook(self) -> Workbook:
        """The workbook `schedules.xlsx`."""
        return read_workbook(self.folder / "schedules.xlsx")

    @cached_property
    def panels(self) -> dict[str, Drawing]:
        """The part files of the panels by mark."""
        return self.drawings("panels")

    @cached_property
    def members(self) -> dict[str, Drawing]:
        """The part files of the members by mark."""
        return self.drawings("members")

    @cached_property
    def node_drawings(self) -> dict[str, Drawing]:
        """The part files of nodes by name: plans of drums, base plates, stems."""
        return self.drawings("nodes")

    @cached_property
    def fitting_drawings(self) -> dict[str, Drawing]:
        """The part files of flat fittings by mark."""
        return self.drawings("fittings")

    @cached_property
    def sheets(self) -> dict[str, Drawing]:
        """The cut sheets by name."""
        return self.drawings("sheets")

    @cached_property
    def books(self) -> dict[str, Book]:
        """The shop drawings by name: texts and bookmarks of their pages."""
        paths = self.files("drawings", "pdf")
        return {path.stem: book for path, book in zip(paths, self.spread(read_pdf, paths), strict=True)}

    @cached_property
    def plan(self) -> Book:
        """The cutting plan, `sheets/cutting-plan.pdf`."""
        return read_pdf(self.folder / "sheets" / "cutting-plan.pdf")

    @cached_property
    def saw_plan(self) -> Book:
        """The saw list on paper, `bars/saw-list.pdf`."""
        return read_pdf(self.folder / "bars" / "saw-list.pdf")

    @cached_property
    def sheet_texts(self) -> dict[str, tuple[str, ...]]:
        """The texts of the drawings' DXF files by name."""
        paths = self.files("drawings", "dxf")
        return {path.stem: found for path, found in zip(paths, self.spread(read_dxf_texts, paths), strict=True)}

    @cached_property
    def twins(self) -> dict[str, dict[str, Drawing]]:
        """The R12 twins of part files, cut sheets and strips by folder and name."""
        return {name: self.drawings(f"r12/{name}") for name in ("panels", "members", "sheets", "strips")}

    @cached_property
    def strips(self) -> dict[str, Drawing]:
        """The unrolled strips by name."""
        return self.drawings("strips")

    @cached_property
    def nc1(self) -> dict[str, NcFile]:
        """The NC1 files of the members by mark."""
        return {path.stem: read_nc1(path) for path in self.files("members", "nc1")}

    @cached_property
    def plate_nc1(self) -> dict[str, dict[str, NcFile]]:
        """The NC1 files of fittings and bases by folder and name."""
        folders = ("fittings", "nodes")
        return {name: {path.stem: read_nc1(path) for path in self.files(name, "nc1")} for name in folders}

    @cached_property
    def solids(self) -> dict[str, Solid]:
        """The node solids by mark."""
        return {path.stem: read_3mf(path) for path in self.files("nodes", "3mf")}

    @cached_property
    def solid_records(self) -> Json:
        """What the maker of the solids measured, `nodes/solids.json`."""
        return read_json(self.folder / "nodes" / "solids.json")

    @cached_property
    def hashes(self) -> dict[str, tuple[str, int]]:
        """SHA-256 and size of every file in the folder, by its path with forward slashes."""
        paths = sorted(path for path in self.folder.rglob("*") if path.is_file() or path.is_symlink())
        return {path.relative_to(self.folder).as_posix(): _hash(path) for path in paths}

    @cached_property
    def edge_slopes(self) -> Floats:
        """Sine of the angle between every edge and the axes of its two nodes, (e, 2)."""
        edges = edge_vectors(self.mesh)
        unit = edges / np.linalg.norm(edges, axis=1)[:, None]
        return np.linalg.norm(np.cross(unit[:, None], self.mesh.node_axes[self.mesh.edges]), axis=2)

    @cached_property
    def seam(self) -> tuple[float, float]:
        """What the frame of a closed rail in space misses itself by: mm, and rad at its edges; 0 for all others.

        So far the last strip may leave its planes: the twist is never spread (V10 holds it to the shop's limit).
        """
        if self.design.plane is not None or not self.design.rail.closed:
            return 0.0, 0.0
        gap = min(frame_gap(self.design), SEAM)
        shortest = np.linalg.norm(edge_vectors(self.mesh), axis=1).min()
        reach = np.linalg.norm(self.design.generatrix.vertices, axis=1).max()
        return gap, float(4 * gap / min(shortest, reach))

    @cached_property
    def node_kinds(self) -> dict[str, str]:
        """Kind of the node (interior, flat, boundary, support) by mark."""
        return pairs(self.table("nodes"), "mark", "kind")

    def files(self, folder: str, suffix: str) -> list[Path]:
        """Give the files of a subfolder with a suffix, sorted."""
        return sorted((self.folder / folder).glob(f"*.{suffix}"))

    def drawings(self, folder: str) -> dict[str, Drawing]:
        """Read the drawings of a subfolder ("." is the folder itself) by name, shop layers under our names."""
        named = {shop: layer for layer, shop in self.design.raw.get("layers", {}).items()}
        paths = self.files(folder, "dxf")
        drawings = self.spread(read_dxf, paths)
        return {path.stem: with_layers(drawing, named) for path, drawing in zip(paths, drawings, strict=True)}

    def table(self, name: str) -> Table:
        """Give one table, or say that it is missing."""
        if name not in self.tables:
            message = f"tables/{name}.csv is missing"
            raise Unreadable(message)
        return self.tables[name]


def _hash(path: Path) -> tuple[str, int]:
    if path.is_symlink():
        return "a link, not a file", 0
    content = path.read_bytes()
    return hashlib.sha256(content).hexdigest(), len(content)
