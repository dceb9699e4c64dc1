#!/usr/bin/env bash
# Make the corpus anew: make_corpus.sh FOLDER. Needs openscad, inkscape, xvfb-run, freecadcmd, and node with makerjs and
# @tarikjabiri/dxf below NODE_FOLDER; EZDXF lists folders with several versions of ezdxf, named by version.
set -eu
here=$(cd "$(dirname "$0")" && pwd); out=$(cd "$1" && pwd); python=${PYTHON:-python}
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT
PYTHONPATH="$here" "$python" - "$work" <<'PY'
import json, sys
from pathlib import Path
from corpus_shapes import INK, SCAD, SHAPES, svg_of
work = Path(sys.argv[1])
(work / "shapes.json").write_text(json.dumps({name: drawn.entities for name, drawn in SHAPES.items()}))
for name, (text, _) in SCAD.items():
    (work / f"openscad-{name}.scad").write_text(text)
for name, (text, _) in INK.items():
    (work / f"inkscape-{name}.svg").write_text(svg_of(text))
PY
for file in "$work"/*.scad; do openscad -q -o "$out/$(basename "$file" .scad).dxf" "$file"; done
for file in "$work"/*.svg; do
  xvfb-run -a inkscape --export-extension=org.ekips.output.dxf_outlines -o "$out/$(basename "$file" .svg).dxf" "$file"
done
SHAPES="$work/shapes.json" FOLDER="$out" freecadcmd "$here/make_freecad.py" > "$work/freecad.log" 2>&1
(cd "$NODE_FOLDER" && node "$here/make_node.mjs" "$work/shapes.json" "$out")
"$python" "$here/make_rhino.py" "$work/shapes.json" "$out"
for folder in ${EZDXF:-}; do
  for version in R12 R2000 R2018; do
    PYTHONPATH="$folder" "$python" "$here/make_ezdxf.py" "$work/shapes.json" "$out" $version "ezdxf$(basename "$folder")-$version"
  done
done
