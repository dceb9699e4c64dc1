"""The stages in the order of the data: project, design, solids, nests, tables, files, proof."""

import importlib.metadata
from dataclasses import replace
from pathlib import Path

from isomould.curves.drawn_settings import DxfSettings, RhinoSettings
from isomould.cutting import nest_kit
from isomould.delivery.folder import write_delivery
from isomould.delivery.goods import Delivery
from isomould.delivery.model import write_record
from isomould.delivery.report import write_page
from isomould.delivery.schedules import write_schedules
from isomould.design import Design, kit_settings
from isomould.documents.info import Logo
from isomould.documents.table import Table
from isomould.errors import CertificateFailed, Refused
from isomould.family import kit_table
from isomould.nesting.search import Search
from isomould.parts.building import make_shapes
from isomould.parts.clash import refuse_clashes
from isomould.parts.solid import make_solids
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

CERTIFICATE, PAGE = "certificate.json", "report.html"

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
    with candidate(target, replace=run.overwrite) as folder, workers(run.jobs) as spread:
        designs, kit = _design(loaded, run)
        for name in list(designs)[1:]:
            shape = _compute(designs[name], None, loaded.logo, run, spread)
            write_delivery(folder / "shapes" / name, shape, spread)
            _certify(folder / "shapes" / name, shape, loaded, run, spread)
        delivery = _compute(designs[MAIN], kit, loaded.logo, run, spread)
        run.report("schedules, drawings, models")
        write_delivery(folder, delivery, spread)
        certificate = _certify(folder, delivery, loaded, run, spread)
    return Built(target, delivery.design, delivery.tables, certificate)


def schedule_folder(loaded: LoadedProject, target: Path, run: Run) -> Built:
    """Publish workbook and tables without drawings and solids, proved as far as they go; of several shapes the first's.

    Raises
    ------
    Refused, CertificateFailed, OutputFault
        As `build_folder`.
    """
    with candidate(target, replace=run.overwrite) as folder, workers(run.jobs) as spread:
        designs, kit = _design(loaded, run)
        delivery = replace(_compute(designs[MAIN], kit, loaded.logo, run, spread), filed=False)
        run.report("schedules")
        write_record(folder / "model", delivery)
        write_schedules(folder, delivery)
        certificate = _certify(folder, delivery, loaded, run, spread)
    return Built(target, delivery.design, delivery.tables, certificate)


def _design(loaded: LoadedProject, run: Run) -> tuple[dict[str, Design], Table | None]:
    """Compute all shapes, and the table of their kit if there are several."""
    if run.previous and loaded.shapes:
        found, limit = "a project of several shapes", "a project of one shape"
        way_out = "Build without --previous: the marks of the kit belong to all shapes."
        raise Refused("E-SHAPE-PREVIOUS", "--previous", found, limit, way_out)
    run.report("curves, surface, parts")
    designs = rehearse(loaded)
    designs[MAIN] = replace(designs[MAIN], notes=(*loaded.notes, *designs[MAIN].notes))
    return designs, kit_table(designs) if loaded.shapes else None


def _compute(design: Design, kit: Table | None, logo: Logo | None, run: Run, spread: Spread) -> Delivery:
    """Compute everything that is to be written of one shape."""
    project, report = design.project, run.report
    former = read_former(run.previous) if run.previous else None
    report(f"{len(design.kit.nodes.marks)} node solids")
    solids = make_solids(design.kit.nodes, design.kit.joints)
    design = keep_design_marks(design, solids, former) if former else design
    settings = kit_settings(project)
    bodies = make_shapes(design.kit, settings, solids)
    refuse_clashes(design.kit, settings, bodies)
    report(f"nesting {len(design.kit.panels.locations)} panels and {len(design.kit.members.locations)} members")
    cutting = nest_kit(design.kit, project.stock, Search(run.effort), spread)
    design = replace(design, notes=(*design.notes, *cutting.notes))
    return Delivery(design, solids, bodies, cutting, former, kit, logo)


def _certify(folder: Path, delivery: Delivery, loaded: LoadedProject, run: Run, spread: Spread) -> Certificate:
    """Prove the candidate from its files, add certificate and page, close the manifest."""
    run.report("certificate")
    scope: Scope = "delivery" if delivery.filed else "schedules"
    inputs, libraries = read_inputs(loaded) | read_previous(run.previous), versions()
    write_manifest(folder, inputs, libraries, scope)
    certificate = _passed(verify_folder(folder, final=False, spread=spread))
    _rewrite(folder / CERTIFICATE, certificate)
    if delivery.filed:
        write_page(folder / PAGE, delivery, certificate, listed_files(folder))
        certificate = _passed(verify_page(folder, certificate))
        _rewrite(folder / CERTIFICATE, certificate)
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
