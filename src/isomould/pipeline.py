"""The stages in the order of the data: project, design, solids, nests, tables, files, proof."""

import importlib.metadata
from collections.abc import Generator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path

from isomould.curves.drawn_settings import DxfSettings, RhinoSettings
from isomould.cutting import nest_kit
from isomould.delivery.folder import write_delivery
from isomould.delivery.goods import Delivery
from isomould.delivery.model import write_record
from isomould.delivery.report import write_page
from isomould.delivery.schedules import write_schedules
from isomould.delivery.stages import BUILDING, CERTIFICATE, DESIGN, NESTING, SCHEDULES, SCHEDULING, SOLIDS
from isomould.design import Design, kit_settings
from isomould.documents.table import Table
from isomould.errors import CertificateFailed, Refused
from isomould.expected_time import expect_stages, name_stages
from isomould.family import kit_table
from isomould.nesting.search import Search
from isomould.parts.building import make_shapes
from isomould.parts.clash import refuse_clashes
from isomould.parts.solid import make_solids
from isomould.progress import Course
from isomould.project.load import LoadedProject
from isomould.project.schema import MAIN
from isomould.rehearsal import rehearse
from isomould.revision import keep_design_marks, read_former
from isomould.running import Built, Run
from isomould.verify import Certificate, verify_folder, verify_page
from isomould.workers import Spread, workers
from isomould.writers.disk import write_bytes
from isomould.writers.folder import candidate
from isomould.writers.manifest import MANIFEST, Scope, listed_files, write_manifest

CERTIFICATE_FILE, PAGE = "certificate.json", "report.html"

_LIBRARIES = (
    "numpy",
    "scipy",
    "shapely",
    "ezdxf",
    "manifold3d",
    "pandas",
    "XlsxWriter",
    "pydantic",
    "trimesh",
    "reportlab",
    "plotly",
    "pypdf",
)


def build_folder(loaded: LoadedProject, target: Path, run: Run) -> Built:
    """Run all stages and publish the folder by one rename.

    Raises
    ------
    Refused
        If the project cannot be built, or the target may not be replaced.
    CertificateFailed
        If the written files do not prove what they claim; nothing is published.
    OutputFault
        If the folder cannot be written.
    """
    with _working(loaded, target, run, BUILDING) as (folder, begun):
        designs, kit = _design(begun)
        work = begun.expecting(designs)
        for name in list(designs)[1:]:
            _built(folder / "shapes" / name, designs[name], work.of(name), None)
        delivery, certificate = _built(folder, designs[MAIN], work, kit)
    return Built(target, delivery.design, delivery.tables, certificate)


def schedule_folder(loaded: LoadedProject, target: Path, run: Run) -> Built:
    """Publish workbook and tables without drawings and solids, proved as far as they go; of several shapes the first's.

    Raises
    ------
    Refused, CertificateFailed, OutputFault
        As `build_folder`.
    """
    with _working(loaded, target, run, SCHEDULING) as (folder, begun):
        designs, kit = _design(begun)
        work = begun.expecting({MAIN: designs[MAIN]})
        delivery = replace(_compute(designs[MAIN], work, kit), filed=False)
        work.course.begin(SCHEDULES)
        write_record(folder / "model", delivery)
        write_schedules(folder, delivery)
        certificate = _certify(folder, delivery, work)
    return Built(target, delivery.design, delivery.tables, certificate)


@dataclass(frozen=True)
class _Work:
    """What a project is built with: how it is run, on which processes, and the course of its stages."""

    loaded: LoadedProject
    run: Run
    spread: Spread
    names: tuple[str, ...]
    course: Course

    def of(self, shape: str) -> "_Work":
        """Give the work on another shape than the first."""
        return replace(self, course=self.course.of(shape))

    def expecting(self, designs: Mapping[str, Design]) -> "_Work":
        """Give the work as it is expected once its designs are known."""
        stages = expect_stages(designs, self.names)
        return replace(self, course=replace(self.course, stages=stages))


@contextmanager
def _working(loaded: LoadedProject, target: Path, run: Run, names: tuple[str, ...]) -> Generator[tuple[Path, _Work]]:
    """Give the folder to fill, which is published if nothing fails, and what it is filled with."""
    shapes = [*(name for name, _ in loaded.shapes), MAIN] if names is BUILDING else [MAIN]
    course = Course(name_stages(shapes, names), run.tell)
    with candidate(target, replace=run.overwrite) as folder, workers(run.jobs) as spread:
        yield folder, _Work(loaded, run, spread, names, course)


def _design(work: _Work) -> tuple[dict[str, Design], Table | None]:
    """Compute all shapes, and the table of their kit if there are several."""
    loaded = work.loaded
    if work.run.previous and loaded.shapes:
        found, limit = "a project of several shapes", "a project of one shape"
        way_out = "Build without --previous: the marks of the kit belong to all shapes."
        raise Refused("E-SHAPE-PREVIOUS", "--previous", found, limit, way_out)
    work.course.begin(DESIGN)
    designs = rehearse(loaded)
    designs[MAIN] = replace(designs[MAIN], notes=(*loaded.notes, *designs[MAIN].notes))
    return designs, kit_table(designs) if loaded.shapes else None


def _built(folder: Path, design: Design, work: _Work, kit: Table | None) -> tuple[Delivery, Certificate]:
    """Write and prove everything of one shape."""
    delivery = _compute(design, work, kit)
    write_delivery(folder, delivery, work.spread, work.course)
    return delivery, _certify(folder, delivery, work)


def _compute(design: Design, work: _Work, kit: Table | None) -> Delivery:
    """Compute everything that is to be written of one shape."""
    project, run = design.project, work.run
    former = read_former(run.previous) if run.previous else None
    solids = make_solids(design.kit.nodes, design.kit.joints, work.course.begin(SOLIDS))
    design = keep_design_marks(design, solids, former) if former else design
    bodies = make_shapes(design.kit, kit_settings(project), solids)
    refuse_clashes(design.kit, kit_settings(project), bodies)
    work.course.begin(NESTING)
    cutting = nest_kit(design.kit, project.stock, Search(run.effort), work.spread)
    design = replace(design, notes=(*design.notes, *cutting.notes))
    return Delivery(design, solids, bodies, cutting, former, kit, work.loaded.logo)


def _certify(folder: Path, delivery: Delivery, work: _Work) -> Certificate:
    """Prove the candidate from its files, add certificate and page, close the manifest."""
    told = work.course.begin(CERTIFICATE)
    scope: Scope = "delivery" if delivery.filed else "schedules"
    inputs, libraries = read_inputs(work.loaded) | read_previous(work.run.previous), versions()
    write_manifest(folder, inputs, libraries, scope)
    certificate = _passed(verify_folder(folder, final=False, spread=work.spread, told=told))
    _rewrite(folder / CERTIFICATE_FILE, certificate)
    if delivery.filed:
        write_page(folder / PAGE, delivery, certificate, listed_files(folder))
        certificate = _passed(verify_page(folder, certificate))
        _rewrite(folder / CERTIFICATE_FILE, certificate)
    (folder / MANIFEST).unlink()
    write_manifest(folder, inputs, libraries, scope)
    return certificate


def _rewrite(path: Path, certificate: Certificate) -> None:
    path.unlink(missing_ok=True)
    write_bytes(path, certificate.to_json().encode())


def _passed(certificate: Certificate) -> Certificate:
    """Hand on a certificate without failures.

    Raises
    ------
    CertificateFailed
        Naming every failure.
    """
    if not certificate.passed:
        listed = "\n".join(
            f"  {c.id} {c.what}: {c.worst} {c.unit} at {c.where} {c.reason}" for c in certificate.failures
        )
        failed = f"the written files failed {len(certificate.failures)} checks; nothing was published."
        message = f"E-CERTIFICATE: {failed} Please report it with the project file.\n{listed}"
        raise CertificateFailed(message)
    return certificate


def read_inputs(loaded: LoadedProject) -> dict[str, bytes]:
    """Give the project file, and the drawings and the logo that it names, by name."""
    projects = (loaded.project, *(project for _, project in loaded.shapes))
    curves = [curve for project in projects for curve in (project.rail.curve, project.generatrix.curve)]
    drawings = {
        curve.file: (loaded.folder / curve.file).read_bytes()
        for curve in curves
        if isinstance(curve, DxfSettings | RhinoSettings)
    }
    logo = {loaded.project.project.logo: loaded.logo.content} if loaded.logo else {}
    return {"project.toml": loaded.source, **drawings, **logo}


def read_previous(folder: Path | None) -> dict[str, bytes]:
    """Give the manifest of the former delivery, if there is one: its hash names that delivery."""
    return {"previous/manifest.json": (folder / MANIFEST).read_bytes()} if folder else {}


def versions() -> dict[str, str]:
    """Give the versions of isomould and of the libraries that its results depend on."""
    return {name: importlib.metadata.version(name) for name in ("isomould", *_LIBRARIES)}
