"""V31c: cut sheets name every part where it lies, and engrave nothing outside of parts."""

import re
from collections import defaultdict
from collections.abc import Iterator

import numpy as np
import shapely

from isomould.verify.checks.sheet_materials import material_text
from isomould.verify.delivery import Delivery
from isomould.verify.read.dxf import Drawing, outlines_on
from isomould.verify.read.layout import Placement
from isomould.verify.rules import Measured, Rule, faults


def marked(delivery: Delivery) -> Measured:
    """Texts on cut sheets against the layout, part by part; strokes of ENGRAVE that leave their part."""
    problems, count = list[str](), 0
    materials = {str(sheet["id"]): material_text(sheet) for sheet in delivery.layout.raw["sheets"]}
    for name, drawing in delivery.sheets.items():
        placed = delivery.layout.on(name)
        problems += [f"{name}: {fault}" for fault in _sheet_faults(drawing, placed, materials.get(name, ""))]
        count += len(placed)
    return faults(count, problems)


def _sheet_faults(drawing: Drawing, placed: list[Placement], material: str) -> Iterator[str]:
    shapes = shapely.STRtree([shapely.Polygon(item.points) for item in placed])
    written = [entity for entity in drawing.entities if entity.kind == "TEXT" and entity.layer == "INFO"]
    below = [entity.text for entity in written if entity.points[0][1] < 0]
    if below != ([_plain(material)] if material else []):
        yield f"its material {material or '(none)'} is written as {', '.join(below) or 'nothing'}"
    texts = [entity for entity in written if entity.points[0][1] >= 0]
    at = shapely.points(np.array([entity.points[0][:2] for entity in texts]).reshape(-1, 2))
    names: defaultdict[int, list[str]] = defaultdict(list)
    for text, part in shapes.query(at, predicate="intersects").T.tolist():
        names[part].append(texts[text].text)
    for part, item in enumerate(placed):
        wanted = _name(item)
        if names[part] != [wanted]:
            yield f"{wanted} is named {', '.join(names[part]) or 'nothing'}"
    if len(texts) != sum(map(len, names.values())):
        yield "a text lies in no part"
    strokes = np.array([shapely.LineString(line.points) for line in outlines_on(drawing, "ENGRAVE")], dtype=object)
    inside = shapes.query(strokes, predicate="within")[0] if len(strokes) else []
    if len(np.unique(inside)) < len(strokes):
        yield "something is engraved outside of parts"


def _name(item: Placement) -> str:
    """Give what stands in a part: two signs of per cent would be a code, and a caret is one without a blank."""
    return _plain(f"{item.mark} {item.location}".strip())


def _plain(text: str) -> str:
    return re.sub(r"%(?=%)", "% ", text).replace("^", "^ ")


RULES = (Rule("V31c", "cut sheets name every part in its place", 0, "faults", marked),)
