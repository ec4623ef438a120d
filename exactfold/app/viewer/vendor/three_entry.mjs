// The parts of three.js that the viewer uses; README.md says how the bundle is made from this.
export {
  BackSide, BufferAttribute, BufferGeometry, DirectionalLight, FrontSide, HemisphereLight, Mesh,
  MeshLambertMaterial, PerspectiveCamera, Scene, WebGLRenderer,
} from "three";
export { OrbitControls } from "three/addons/controls/OrbitControls.js";
export { LineMaterial } from "three/addons/lines/LineMaterial.js";
export { LineSegments2 } from "three/addons/lines/LineSegments2.js";
export { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";
