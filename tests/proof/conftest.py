"""What runs inside FreeCAD is no module of ours."""

collect_ignore = ["freecad_measures.py"]
