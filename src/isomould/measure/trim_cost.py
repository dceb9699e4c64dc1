"""What a trim costs in kinds of nodes: planes cut members at ever other places and angles (geometry §6)."""

from isomould.errors import Note
from isomould.form.assemble import Form
from isomould.form.mesh import make_mesh
from isomould.parts.arms import find_arms
from isomould.parts.kit import Kit
from isomould.parts.nodes import classify_nodes
from isomould.parts.settings import CongruenceSettings


def trim_cost_notes(form: Form, kit: Kit, tolerance: CongruenceSettings) -> tuple[Note, ...]:
    """Say how many node classes the trimmed design has, and how many the same surface has without planes."""
    whole = make_mesh(form.surface)
    before = len(classify_nodes(whole, find_arms(whole), tolerance).marks)
    after = len(kit.nodes.marks)
    if after <= before:
        return ()
    text = f"the planes cost node classes: {after} for {before} without them"
    return (Note("W-TRIM-CLASSES", "surface.trim", text),)
