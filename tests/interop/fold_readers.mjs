// What two readers of FOLD make of the files named as arguments: one JSON object a line.
// Run in a folder whose node_modules holds the npm packages fold and rabbit-ear.
import { readFileSync } from "node:fs";
import FOLD from "fold";
import ear from "rabbit-ear";

const copy = (value) => JSON.parse(JSON.stringify(value));
const cycle = (face) => {
  const k = face.indexOf(Math.min(...face));
  return [...face.slice(k), ...face.slice(0, k)].join();
};

function foldLibrary(document) {
  const flat = copy(document);
  const traced = FOLD.convert.edges_vertices_to_faces_vertices(copy({
    vertices_coords: flat.vertices_coords,
    edges_vertices: flat.edges_vertices,
  }));
  const sides = FOLD.convert.faces_vertices_to_edges({ faces_vertices: copy(flat.faces_vertices) });
  const moved = FOLD.filter.transform(copy(flat), FOLD.geom.matrixTranslate([1, 2]));
  const short = copy(flat);
  FOLD.filter.removeEdge(short, 0);
  return {
    json: JSON.stringify(JSON.parse(FOLD.convert.toJSON(flat))) === JSON.stringify(document),
    vertices: FOLD.filter.numVertices(flat),
    edges: FOLD.filter.numEdges(flat),
    faces: FOLD.filter.numFaces(flat),
    mountains: FOLD.filter.mountainEdges(flat),
    valleys: FOLD.filter.valleyEdges(flat),
    boundary: FOLD.filter.boundaryEdges(flat),
    traced: traced.faces_vertices.map(cycle).sort(),
    stated: flat.faces_vertices.map(cycle).sort(),
    sides: sides.edges_vertices.map((side) => side.slice().sort((a, b) => a - b).join()).sort(),
    once: sides.edges_faces.filter((faces) => faces.filter((f) => f !== null).length < 2).length,
    moved: moved.vertices_coords[0],
    short: [short.edges_vertices.length, short.edges_assignment.length, short.edges_foldAngle.length],
    facesEdges: FOLD.convert.faces_vertices_to_faces_edges(copy(flat)),
  };
}

function rabbitEar(document) {
  const frames = [0, 1].map((k) => ear.graph.flattenFrame(copy(document), k));
  return {
    frames: ear.graph.countFrames(document),
    folded: ear.graph.getFramesByClassName(copy(document), "foldedForm").length,
    problems: frames.map((frame) => ear.graph.validate(copy(frame))),
    vertices: frames.map((frame) => frame.vertices_coords.length),
    components: frames.map((frame) => [...new Set(frame.vertices_coords.map((p) => p.length))]),
    inherited: frames[1].edges_vertices.length,
    classes: frames.map((frame) => frame.frame_classes),
    isFoldedForm: frames.map((frame) => ear.graph.isFoldedForm(frame)),
    angles: ear.graph.makeEdgesFoldAngleFromFaces(copy(frames[1])),
    orders: frames[1].faceOrders ?? [],
    foldedByEar: ear.graph.makeVerticesCoordsFlatFolded(copy(frames[0])),
    motion: Array.from({ length: ear.graph.countFrames(document) - 1 }, (_, k) => {
      const frame = ear.graph.flattenFrame(copy(document), k + 1);
      return {
        problems: ear.graph.validate(copy(frame)),
        coords: frame.vertices_coords,
        edges: frame.edges_vertices.length,
        letters: frame.edges_assignment.join(""),
        angles: ear.graph.makeEdgesFoldAngleFromFaces(copy(frame)),
      };
    }),
  };
}

for (const path of process.argv.slice(2)) {
  const document = JSON.parse(readFileSync(path, "utf-8"));
  console.log(JSON.stringify({ fold: foldLibrary(document), ear: rabbitEar(document) }));
}
