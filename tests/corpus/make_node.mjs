// Draw the corpus's shapes with maker.js and @tarikjabiri/dxf: node make_node.mjs SHAPES.json FOLDER (run where both are installed)
import { readFileSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";

const require = createRequire(join(process.cwd(), "x.js"));
const makerjs = require("makerjs");
const { DxfWriter, Units, point3d, point2d } = require("@tarikjabiri/dxf");
const [shapes, folder] = [JSON.parse(readFileSync(process.argv[2])), process.argv[3]];
const degrees = (value) => (value * 180) / Math.PI;

function paths([kind, ...rest]) {
  if (kind === "line") return [new makerjs.paths.Line(rest.slice(0, 2), rest.slice(2))];
  if (kind === "arc") return [new makerjs.paths.Arc(rest.slice(0, 2), rest[2], rest[3], rest[4])];
  if (kind === "circle") return [new makerjs.paths.Circle(rest.slice(0, 2), rest[2])];
  if (kind !== "polyline") return null;
  const points = rest[1] ? [...rest[0], rest[0][0]] : rest[0];
  return points.slice(1).map((point, k) => new makerjs.paths.Line(points[k], point));
}

for (const [name, entities] of Object.entries(shapes)) {
  const found = entities.map(paths);
  if (found.some((one) => one === null)) continue;
  const model = { units: makerjs.unitType.Millimeter, paths: { ...found.flat() }, layer: "RAIL" };
  writeFileSync(join(folder, `makerjs-${name}.dxf`), makerjs.exporter.toDXF(model, { units: "Millimeter" }));
}

for (const [name, entities] of Object.entries(shapes)) {
  const dxf = new DxfWriter();
  dxf.setUnits(Units.Millimeters);
  dxf.addLayer("RAIL", 3, "CONTINUOUS");
  dxf.setCurrentLayerName("RAIL");
  for (const [kind, ...rest] of entities) {
    if (kind === "line") dxf.addLine(point3d(rest[0], rest[1]), point3d(rest[2], rest[3]));
    if (kind === "arc") dxf.addArc(point3d(rest[0], rest[1]), rest[2], rest[3], rest[4]);
    if (kind === "circle") dxf.addCircle(point3d(rest[0], rest[1]), rest[2]);
    if (kind === "ellipse") {
      const [x, y, a, b, turn, start, end] = rest;
      dxf.addEllipse(point3d(x, y), point3d(a * Math.cos(turn), a * Math.sin(turn)), b / a, start, end);
    }
    if (kind === "spline") dxf.addSpline({ controlPoints: rest[0].map(([x, y]) => point3d(x, y)), degreeCurve: 3 });
    if (kind === "polyline") {
      const vertices = rest[0].map(([x, y]) => ({ point: point2d(x, y) }));
      dxf.addLWPolyline(vertices, { flags: rest[1] ? 1 : 0 });
    }
  }
  writeFileSync(join(folder, `tarikjabiri-${name}.dxf`), dxf.stringify());
}
