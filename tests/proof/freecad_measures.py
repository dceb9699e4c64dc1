"""Run inside FreeCAD: closed wires and areas of the drawings of a folder, volumes of its STL files, as JSON.

The folder and the file to write are named by the environment, for FreeCAD opens what its command line names.
"""

import json
import os
from pathlib import Path

import FreeCAD
import Import
import Mesh
import Part

LAYERS = {"CUT", "CUT_INNER", "DRILL", "SHEET"}
FOLDERS = ("panels", "members", "nodes", "fittings", "sheets", "strips")


def measured(path):
    """Areas of the closed wires by layer, mm²; null for a wire that is open."""
    document = FreeCAD.newDocument("part")
    try:
        Import.readDXF(str(path), document.Name)
        shapes = {item.Label: item.Shape for item in document.Objects if item.Label in LAYERS}
        return {layer: [area(edges) for edges in Part.sortEdges(shape.Edges)] for layer, shape in shapes.items()}
    finally:
        FreeCAD.closeDocument(document.Name)


def area(edges):
    wire = Part.Wire(edges)
    return Part.Face(wire).Area if wire.isClosed() else None


def solid(path):
    mesh = Mesh.Mesh()
    mesh.read(str(path))
    return {"volume": mesh.Volume, "sound": mesh.isSolid() and not mesh.hasNonManifolds()}


def main():
    settings = FreeCAD.ParamGet("User parameter:BaseApp/Preferences/Mod/Draft")
    settings.SetBool("groupLayers", True)
    settings.SetBool("dxftext", False)
    folder, version = Path(os.environ["DELIVERED"]), ".".join(FreeCAD.Version()[:3])
    places = [folder / name for name in FOLDERS] + [folder / "r12" / name for name in FOLDERS]
    drawings = {p.relative_to(folder).as_posix(): p for place in places for p in sorted(place.glob("*.dxf"))}
    solids = {p.relative_to(folder).as_posix(): p for place in places for p in sorted(place.glob("*.stl"))}
    found = {
        "version": version,
        "areas": {name: measured(path) for name, path in drawings.items()},
        "solids": {name: solid(path) for name, path in solids.items()},
    }
    Path(os.environ["MEASURED"]).write_text(json.dumps(found))


main()
