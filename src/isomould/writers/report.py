"""The page `report.html`: one file that needs no other and no network. The only importer of plotly."""

from collections.abc import Iterable, Iterator
from html import escape
from itertools import groupby
from pathlib import Path
from string import Template
from urllib.parse import quote

import numpy as np
from plotly import graph_objects as go
from plotly.offline import get_plotlyjs

from isomould.arrays import Floats
from isomould.documents.charts import Chart
from isomould.documents.digits import shown
from isomould.documents.numbers import format_number
from isomould.documents.report import FileRow, Report
from isomould.documents.scene import Facets, Points, Scene, Strokes
from isomould.documents.table import Cell, Table, cells
from isomould.documents.title_block import heading, title_lines
from isomould.writers.disk import write_bytes
from isomould.writers.svg import svg_text

_PLAIN = "#e3e8ec"

_EYE = {"x": 0.95, "y": -1.45, "z": 0.86}
_CAMERA = {"eye": _EYE, "center": {"x": 0, "y": 0, "z": -0.08}}
"""So far away that the whole building is in the frame, whatever its proportions."""

_CONFIG = {"displaylogo": False, "responsive": True}

_PAGE = Template("""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>$title</title>
<style>
body { font: 15px/1.45 system-ui, sans-serif; color: #26323d; margin: 0 auto; max-width: 76rem; padding: 1rem; }
h1 { margin-bottom: 0; } h2 { border-bottom: 1px solid #c5ced6; margin-top: 2rem; }
nav a { margin-right: 1rem; } a { color: #1f5fa8; }
table { border-collapse: collapse; } td, th { padding: .15rem .7rem .15rem 0; text-align: left; vertical-align: top; }
tr:nth-child(even) { background: #f5f7f9; } td.number { text-align: right; font-variant-numeric: tabular-nums; }
.pass { color: #14692f; } .fail { color: #fff; background: #b3261e; } .not_applicable { color: #6b7780; }
.banner { padding: .5rem .8rem; border-left: .4rem solid #14692f; background: #edf6ef; }
.banner.bad { border-color: #b3261e; background: #fbeceb; }
.hash { font: 12px ui-monospace, monospace; color: #6b7780; word-break: break-all; }
.plot { height: 24rem; } .plot > div { height: 100%; } #scene-room { height: 40rem; }
svg { max-width: 100%; height: auto; }
@media print { nav, #model { display: none; } }
</style>
<script>$library</script>
</head>
<body>
<h1>$name</h1>
$head
$banner
<nav>$links</nav>
$sections
</body>
</html>
""")


def write_report(path: Path, report: Report) -> None:
    """Write the page; the same report gives the same bytes."""
    write_bytes(path, report_text(report).encode())


def report_text(report: Report) -> str:
    """Give the page's text: sections in the order in which people ask."""
    sections = list(_sections(report))
    return _PAGE.substitute(
        title=escape(heading(report.project)),
        name=escape(report.project.name),
        library=get_plotlyjs(),
        head=_pairs(title_lines(report.project)[1:]),
        banner=_banner(report.checks),
        links=" ".join(f'<a href="#{key}">{escape(title)}</a>' for key, title, _ in sections),
        sections="\n".join(
            f'<section id="{key}"><h2>{escape(title)}</h2>\n{body}</section>' for key, title, body in sections
        ),
    )


def _sections(report: Report) -> Iterator[tuple[str, str, str]]:
    """Key, title and content."""
    yield "model", "Model", _figure("scene", scene_figure(report.scene))
    yield "figures", "Key figures", _figures_table(report.summary)
    if report.notes:
        yield "notes", "Notes", _pairs([(note.code, f"{note.field}: {note.text}") for note in report.notes])
    plots = (_figure(f"chart-{k}", chart_figure(chart)) for k, chart in enumerate(report.charts))
    yield "charts", "Charts", "\n".join([*plots, *(svg_text(picture) for picture in report.pictures)])
    yield "checks", "Checks", _table("certificate", report.checks)
    yield "files", "Files", "\n".join(_folders(report.files))


def _banner(checks: Table) -> str:
    """Say first whether the delivery holds."""
    status = checks.frame["status"].tolist()
    failed, passed = status.count("fail"), status.count("pass")
    said = f"{failed} checks failed" if failed else f"All {passed} checks that apply passed"
    return (
        f'<p class="banner{" bad" if failed else ""}">{said}; {len(status)} were made on the files of this folder.</p>'
    )


def _pairs(pairs: Iterable[tuple[str, str]]) -> str:
    rows = "".join(f"<tr><th>{escape(label)}</th><td>{escape(text)}</td></tr>" for label, text in pairs)
    return f"<table>{rows}</table>"


def _figures_table(summary: Table) -> str:
    """Write the key figures with the digits of their units; the workbook keeps what was rounded away."""
    rows = zip(*(cells(summary, column) for column in summary.columns), strict=True)
    return _rows("summary", summary, [f"<tr>{''.join(_figure_cells(*row))}</tr>" for row in rows])


def _figure_cells(item: Cell, value: Cell, unit: Cell) -> tuple[str, str, str]:
    number = shown(value, str(unit or "")) if isinstance(value, int | float) else ""
    return _cell(item), f'<td class="number">{number}</td>', _cell(unit)


def _table(key: str, table: Table) -> str:
    """Write a table; numbers as they are, so that they read back exactly."""
    rows = zip(*(cells(table, column) for column in table.columns), strict=True)
    return _rows(key, table, [f"<tr>{''.join(map(_cell, row))}</tr>" for row in rows])


def _rows(key: str, table: Table, rows: Iterable[str]) -> str:
    head = "".join(f"<th>{escape(column.header)}</th>" for column in table.columns)
    body = "\n".join(rows)
    return f'<table id="{key}"><thead><tr>{head}</tr></thead><tbody>\n{body}\n</tbody></table>'


def _cell(value: Cell) -> str:
    if isinstance(value, int | float) and not isinstance(value, bool):
        return f'<td class="number">{_number(value)}</td>'
    text = "" if value is None else str(value)
    known = f' class="{text}"' if text in {"pass", "fail", "not_applicable"} else ""
    return f"<td{known}>{escape(text)}</td>"


def _number(value: float) -> str:
    """Residuals keep their exponent: nobody counts sixteen zeros."""
    return repr(float(value)) if 0 < abs(value) < 1e-4 else format_number(value)


def _folders(files: Iterable[FileRow]) -> Iterator[str]:
    """List the files folder by folder, each a link."""
    for folder, rows in groupby(files, key=lambda row: row.path.rpartition("/")[0]):
        table = _files(rows)
        yield f"<details open><summary>{escape(folder) or '.'}</summary>\n{table}</details>"


def _files(rows: Iterable[FileRow]) -> str:
    listed = "\n".join(map(_file, rows))
    return f'<table class="files">{listed}</table>'


def _file(row: FileRow) -> str:
    link = f'<a href="{quote(row.path)}">{escape(row.path)}</a>'
    return f'<tr><td>{link}</td><td class="number">{row.size}</td><td class="hash">{row.sha256}</td></tr>'


def _figure(key: str, figure: go.Figure) -> str:
    """Put a figure into a room of its own, which gives it its size, whatever plotly writes around it."""
    drawn = figure.to_html(full_html=False, include_plotlyjs=False, div_id=key, config=_CONFIG, default_height="100%")
    return f'<div class="plot" id="{key}-room">{drawn}</div>'


def scene_figure(scene: Scene) -> go.Figure:
    """Draw the building: drag to turn it, point at a part to read its mark and location."""
    figure = go.Figure([_facets(scene.panels), *map(_strokes, scene.members), _points(scene.nodes)])
    bare = {"visible": False}
    figure.update_layout(
        scene={"aspectmode": "data", "xaxis": bare, "yaxis": bare, "zaxis": bare, "camera": _CAMERA},
        margin={"l": 0, "r": 0, "t": 0, "b": 0},
        legend={"orientation": "h"},
        updatemenus=[_colouring(scene.panels)],
    )
    return figure


def _facets(facets: Facets) -> go.Mesh3d:
    i, j, k = facets.triangles.T
    axes = _axes(facets.vertices)
    return go.Mesh3d(
        **axes, i=i, j=j, k=k, facecolor=_plain(facets), text=facets.texts, hoverinfo="text",
        flatshading=True, name=facets.name, showlegend=True,
    )  # fmt: skip


def _plain(facets: Facets) -> list[str]:
    return [_PLAIN] * len(facets.triangles)


def _strokes(strokes: Strokes) -> go.Scatter3d:
    """Join lines into one, blank between two of them; their texts stand at both ends and in the middle."""
    middle = strokes.ends.mean(axis=1)
    path = np.stack([strokes.ends[:, 0], middle, strokes.ends[:, 1], np.full_like(middle, np.nan)], axis=1)
    texts = [text for text in strokes.texts for _ in range(4)]
    line = {"color": strokes.ink, "width": 3}
    axes = _axes(path.reshape(-1, 3))
    return go.Scatter3d(**axes, mode="lines", line=line, text=texts, hoverinfo="text", name=strokes.name)


def _points(points: Points) -> go.Scatter3d:
    marker = {"size": 3, "color": points.colours}
    axes = _axes(points.places)
    return go.Scatter3d(**axes, mode="markers", marker=marker, text=points.texts, hoverinfo="text", name=points.name)


def _axes(places: Floats) -> dict[str, object]:
    """Single precision is plenty for a picture of metres."""
    return dict(zip("xyz", places.astype(np.float32).T, strict=True))


def _colouring(facets: Facets) -> dict[str, object]:
    """Let people choose what colours mean."""
    choices = {"plain panels": _plain(facets), "panels by class": facets.colours}
    buttons = [
        {"label": label, "method": "restyle", "args": [{"facecolor": [colours]}, [0]]}
        for label, colours in choices.items()
    ]
    return {"type": "buttons", "direction": "right", "buttons": buttons, "x": 0, "xanchor": "left", "y": 1.0}


def chart_figure(chart: Chart) -> go.Figure:
    """Draw bars over their labels."""
    figure = go.Figure([go.Bar(x=chart.labels, y=np.array(chart.values), marker_color="#2b61c9")])
    figure.update_layout(
        title=escape(chart.title),
        yaxis_title=escape(chart.unit),
        xaxis_type="category",
        template="plotly_white",
        margin={"l": 60, "r": 20, "t": 50, "b": 60},
    )
    return figure
