// Decodes what C++ packed (mesh_packing.h, viewer_data.h).
function bytesOf(id) {
  const element = document.getElementById(id);
  if (!element) return new Uint8Array(0);
  const text = atob(element.textContent);
  element.textContent = '';  // the page keeps no second copy
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
}
const floatsOf = (id) => new Float32Array(bytesOf(id).buffer);

function cornersOf(bytes, count) {
  const corners = new Uint32Array(count);
  let next = 0;
  for (let i = 0, at = 0; i < count; ++i) {
    let behind = 0, shift = 0, byte;
    do {
      byte = bytes[at++];
      behind |= (byte & 127) << shift;
      shift += 7;
    } while (byte & 128);
    corners[i] = behind === 0 ? next++ : next - behind;
  }
  return corners;
}

function readModel() {
  const data = JSON.parse(document.getElementById('data').textContent);
  const floats = floatsOf('poses');
  const poses = [];
  for (let i = 0; i + 8 <= floats.length; i += 8)
    poses.push({t: floats[i], p: [...floats.subarray(i + 1, i + 4)], q: [...floats.subarray(i + 4, i + 8)]});
  const bytes = bytesOf('vertices');
  const model = {
    ...data, poses, bytes, codes: new Uint16Array(bytes.buffer), corners: cornersOf(bytesOf('corners'), 3 * data.triangles),
    tracked: floatsOf('tracked'), truth: floatsOf('truth'),
  };
  model.vertex = (v) => [0, 1, 2].map((i) => data.low[i] + data.step[i] * model.codes[6 * v + i]);
  setExtent(model);
  return model;
}

// Of each line of the path, from a pose to the next one: the worst state of the frames after the
// first pose, up to the second. A lost frame has no pose.
function statesOfPath({poses, frames}) {
  let frame = 0;
  return poses.map(({t}) => {
    let state = -1;
    while (frame + 1 < frames.length && frames[frame][1] < t - 1e-3) state = Math.max(state, frames[++frame][2]);
    return state < 0 && frames.length ? frames[frame][2] : Math.max(0, state);
  }).slice(1);
}

// The middle and size of what there is to see: 96 % of the vertices per axis, so that single
// distant ones do not count, or the path.
function setExtent(model) {
  const low = [0, 0, 0], high = [0, 0, 0];
  for (let axis = 0; axis < 3; ++axis) {
    const values = [];
    const step = Math.max(1, Math.floor(model.vertices / 20000));
    for (let v = 0; v < model.vertices; v += step) values.push(model.low[axis] + model.step[axis] * model.codes[6 * v + axis]);
    if (!values.length) for (const pose of model.poses) values.push(pose.p[axis]);
    values.sort((a, b) => a - b);
    low[axis] = values[Math.floor(0.02 * (values.length - 1))];
    high[axis] = values[Math.ceil(0.98 * (values.length - 1))];
  }
  // The sum of some normals, unfolded as in viewer_draw.js.
  model.facing = [0, 0, 0];
  for (let v = 0; v < model.vertices; v += Math.max(1, Math.floor(model.vertices / 20000))) {
    const [x, y] = [6, 7].map((i) => (model.bytes[12 * v + i] << 24 >> 24) / 127), z = 1 - Math.abs(x) - Math.abs(y);
    const fold = (a, b) => (z < 0 ? (1 - Math.abs(b)) * (a < 0 ? -1 : 1) : a);
    model.facing = add(model.facing, unit([fold(x, y), fold(y, x), z]));
  }
  model.box = [low, high];
  model.middle = mix(low, high, 0.5);
  model.radius = Math.max(0.05, Math.hypot(...add(high, low, -1)) / 2);
}

// Distance along the ray to the nearest triangle, or to the nearest point if there are none.
function hit(model, eye, ray) {
  let nearest = Infinity;
  const {corners, codes, low, step} = model;
  const at = (v, i) => low[i] + step[i] * codes[6 * v + i] - eye[i];
  if (!corners.length) {
    let best = 0.02;  // of its distance, to the side
    for (let v = 0; v < model.vertices; ++v) {
      const p = [at(v, 0), at(v, 1), at(v, 2)], along = dot(p, ray);
      const aside = along > 0.05 ? Math.hypot(...add(p, ray, -along)) / along : Infinity;
      if (aside < best) [best, nearest] = [aside, along];
    }
    return nearest;
  }
  for (let i = 0; i < corners.length; i += 3) {
    const a = corners[i], b = corners[i + 1], c = corners[i + 2];
    const ax = at(a, 0), ay = at(a, 1), az = at(a, 2);
    const ux = at(b, 0) - ax, uy = at(b, 1) - ay, uz = at(b, 2) - az;
    const vx = at(c, 0) - ax, vy = at(c, 1) - ay, vz = at(c, 2) - az;
    const px = ray[1] * vz - ray[2] * vy, py = ray[2] * vx - ray[0] * vz, pz = ray[0] * vy - ray[1] * vx;
    const det = ux * px + uy * py + uz * pz;
    if (det <= 1e-14) continue;  // seen from behind, or along its plane
    const s = -(ax * px + ay * py + az * pz);
    if (s < 0 || s > det) continue;
    const qx = -(ay * uz - az * uy), qy = -(az * ux - ax * uz), qz = -(ax * uy - ay * ux);
    const t = ray[0] * qx + ray[1] * qy + ray[2] * qz;
    if (t < 0 || s + t > det) continue;
    const distance = (vx * qx + vy * qy + vz * qz) / det;
    if (distance > 0.02 && distance < nearest) nearest = distance;
  }
  return nearest;
}
