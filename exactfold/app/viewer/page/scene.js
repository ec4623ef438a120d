// The sheet in space, drawn with three.js: two colours, edges, and a camera that moves round it.

const UPPER = 0x56b4e9, LOWER = 0xf0e442;  // UPPER is the side that is +z in the flat sheet
const EDGE = 0x1d1c1a;
const AZIMUTH = -62, ELEVATION = 34, VIEW = 30;
const TURNS = [0, 18, -18, 36, -36, 54, 72, 90, 108, 126, 144, 162, 180, 198, 216, 234, 252, 270, 288];
const FOLD = 1.3, FINEST = 0.3, ROOM = 14;  // pixels: widths of lines, and the distance for full width
const FILLED = 0.9;  // the sheet fills this share of the picture

export function createScene(canvas, sheet, flat, radius, signal) {
  const renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true });
  const scene = new THREE.Scene();
  const camera = new THREE.PerspectiveCamera(VIEW, 1, radius / 50, radius * 60);
  camera.up.set(0, 0, 1);
  const controls = new THREE.OrbitControls(camera, canvas);
  const calm = matchMedia("(prefers-reduced-motion: reduce)");
  Object.assign(controls, { enablePan: false, enableDamping: !calm.matches, dampingFactor: 0.12, rotateSpeed: 0.9 });

  const corners = sheet.triangles.flat();
  const surface = new THREE.BufferGeometry();
  const places = new THREE.BufferAttribute(new Float32Array(3 * corners.length), 3).setUsage(35048);
  surface.setAttribute("position", places);
  for (const [side, color] of [[THREE.FrontSide, UPPER], [THREE.BackSide, LOWER]]) {
    const material = new THREE.MeshLambertMaterial({ color, side, flatShading: true, polygonOffset: true, polygonOffsetFactor: 1.5, polygonOffsetUnits: 2 });
    const mesh = new THREE.Mesh(surface, material);
    mesh.frustumCulled = false;
    scene.add(mesh);
  }
  const inner = lines(sheet.folds, FOLD), outer = lines(sheet.boundary, 2.4);
  scene.add(inner.object, outer.object);

  // The light is fixed to the sheet, so faces of different directions differ and keep their shade.
  scene.add(new THREE.HemisphereLight(0xffffff, 0xffffff, 1.1));
  for (const [strength, ...from] of [[2.1, -0.55, -0.35, 0.76], [0.75, 0.8, 0.1, -0.6], [0.5, 0.2, 0.9, 0.3]]) {
    const lamp = new THREE.DirectionalLight(0xffffff, strength);
    lamp.position.set(...from);
    scene.add(lamp);
  }

  // The border has the colour of text, so that it is visible on light and on dark ground.
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const colour = () => outer.material.color.set(getComputedStyle(document.body).color);
  dark.addEventListener("change", () => (colour(), want()), { signal });
  signal.addEventListener("abort", () => (controls.dispose(), renderer.dispose(), renderer.forceContextLoss()));
  colour();

  let width = 0, height = 0, wanted = false, drawn = 0, fitted = [flat];

  function resize() {
    const box = canvas.parentElement;
    if (!box.clientWidth || !box.clientHeight) return;
    const touched = width > 0 && (camera.userData.touched ?? false);
    [width, height] = [box.clientWidth, box.clientHeight];
    renderer.setPixelRatio(Math.min(devicePixelRatio || 1, 2));
    renderer.setSize(width, height, false);
    camera.aspect = width / height;
    camera.updateProjectionMatrix();
    for (const { material } of [inner, outer]) material.resolution.set(width, height);
    inner.material.linewidth = Math.min(Math.max(FOLD * room(Math.min(width, height)) / ROOM, FINEST), FOLD);
    if (!touched) home();
    draw();
  }

  // The approximate distance of lines in pixels: each line gets a share of the area of the flat sheet.
  function room(pixels) {
    const area = sheet.triangles.reduce((sum, corners) => sum + Math.hypot(...normalOf(flat, corners)) / 2, 0);
    const length = sheet.folds.reduce((sum, [i, j]) => sum + Math.hypot(flat[3 * i] - flat[3 * j], flat[3 * i + 1] - flat[3 * j + 1]), 0);
    return (area / Math.max(length, 1e-12)) * (pixels / (2 * radius));
  }

  // Place the camera where pictures of folds are usually taken, with all these shapes in the picture.
  function home() {
    const e = ELEVATION * (Math.PI / 180), a = azimuth(e);
    const towards = [Math.cos(e) * Math.cos(a), Math.cos(e) * Math.sin(a), Math.sin(e)];
    const right = [-Math.sin(a), Math.cos(a), 0];
    const up = [-Math.sin(e) * Math.cos(a), -Math.sin(e) * Math.sin(a), Math.cos(e)];
    const seen = fitted.flatMap((shape) => pointsSeen(shape, [right, up, towards]));
    const low = [Infinity, Infinity], high = [-Infinity, -Infinity];
    for (const point of seen) {
      for (const c of [0, 1]) {
        low[c] = Math.min(low[c], point[c]);
        high[c] = Math.max(high[c], point[c]);
      }
    }
    const x = (low[0] + high[0]) / 2, y = (low[1] + high[1]) / 2;
    const tall = Math.tan((VIEW / 2) * (Math.PI / 180)) * FILLED, wide = tall * camera.aspect;
    const far = ([px, py, pz]) => pz + Math.max(Math.abs(px - x) / wide, Math.abs(py - y) / tall);
    const distance = seen.reduce((most, point) => Math.max(most, far(point)), radius);
    controls.target.set(...[0, 1, 2].map((c) => x * right[c] + y * up[c]));
    place(a, Math.PI / 2 - e, distance);
    camera.userData.touched = false;
  }

  // Choose the direction round the sheet from which much of it and of both its sides is visible.
  function azimuth(e) {
    const shape = fitted[Math.min(2, fitted.length - 1)];
    const normals = sheet.triangles.map((corners) => normalOf(shape, corners));
    const scores = TURNS.map((turn) => {
      const a = (AZIMUTH + turn) * (Math.PI / 180);
      const towards = [Math.cos(e) * Math.cos(a), Math.cos(e) * Math.sin(a), Math.sin(e)];
      let upper = 0, lower = 0;
      for (const n of normals) {
        const part = n[0] * towards[0] + n[1] * towards[1] + n[2] * towards[2];
        if (part > 0) upper += part;
        else lower -= part;
      }
      return upper + lower + 0.8 * Math.min(upper, lower);
    });
    const best = scores.reduce((found, score, k) => (score > 1.04 * scores[found] ? k : found), 0);
    return (AZIMUTH + TURNS[best]) * (Math.PI / 180);
  }

  // Place the camera on a sphere round its target.
  function place(azimuth, polar, distance) {
    const p = Math.min(Math.max(polar, 0.01), Math.PI - 0.01);
    const { x, y, z } = controls.target;
    camera.position.set(
      x + distance * Math.sin(p) * Math.cos(azimuth), y + distance * Math.sin(p) * Math.sin(azimuth), z + distance * Math.cos(p));
    controls.update();
    want();
  }

  // Turn the camera by angles, and move it nearer by a factor.
  function move(turn, tilt, factor = 1) {
    const [x, y, z] = camera.position.clone().sub(controls.target).toArray();
    const distance = Math.hypot(x, y, z);
    const next = Math.min(Math.max(distance * factor, radius), radius * 20);
    place(Math.atan2(y, x) + turn, Math.acos(z / distance) + tilt, next);
    camera.userData.touched = true;
  }

  // Set the shapes that fill the picture at first; the camera moves there unless the user has moved it.
  function fit(shapes) {
    fitted = shapes;
    if (width && !camera.userData.touched) home();
  }

  function show(positions) {
    const target = places.array;
    for (let k = 0; k < corners.length; k++) {
      const v = 3 * corners[k];
      target[3 * k] = positions[v];
      target[3 * k + 1] = positions[v + 1];
      target[3 * k + 2] = positions[v + 2];
    }
    places.needsUpdate = true;
    inner.show(positions);
    outer.show(positions);
    want();
  }

  // What is drawn of some positions, as a canvas that is right until the next picture.
  function picture(positions) {
    show(positions);
    renderer.render(scene, camera);
    return canvas;
  }

  function want() {
    if (wanted || signal.aborted) return;
    wanted = true;
    requestAnimationFrame(draw);
  }

  function draw() {
    wanted = false;
    if (signal.aborted) return;
    if (controls.enabled) controls.update();
    renderer.render(scene, camera);
    if (!drawn) performance.mark("first picture");
    drawn += 1;
  }

  controls.addEventListener("change", want);
  controls.addEventListener("start", () => (camera.userData.touched = true));
  canvas.addEventListener("webglcontextrestored", want);
  new ResizeObserver(resize).observe(canvas.parentElement);
  resize();
  return { show, move, home, fit, picture, drawn: () => drawn };
}

// The normal of a triangle; its length is twice the area of the triangle.
function normalOf(shape, [a, b, c]) {
  const side = (v) => [0, 1, 2].map((k) => shape[3 * v + k] - shape[3 * a + k]);
  const [[x, y, z], [u, v, w]] = [side(b), side(c)];
  return [y * w - z * v, z * u - x * w, x * v - y * u];
}

// Right, up and towards the eye, for every vertex.
function pointsSeen(shape, axes) {
  const found = [];
  for (let v = 0; v < shape.length; v += 3) {
    found.push(axes.map((axis) => axis[0] * shape[v] + axis[1] * shape[v + 1] + axis[2] * shape[v + 2]));
  }
  return found;
}

function lines(edges, width) {
  const geometry = new THREE.LineSegmentsGeometry();
  geometry.setPositions(new Float32Array(6 * Math.max(edges.length, 1)));
  const material = new THREE.LineMaterial({ color: EDGE, linewidth: width });
  const object = new THREE.LineSegments2(geometry, material);
  object.frustumCulled = false;
  const buffer = geometry.attributes.instanceStart.data.setUsage(35048);
  const ends = edges.flat();
  return {
    object,
    material,
    show(positions) {
      for (let k = 0; k < ends.length; k++) {
        for (let c = 0; c < 3; c++) buffer.array[3 * k + c] = positions[3 * ends[k] + c];
      }
      buffer.needsUpdate = true;
    },
  };
}
