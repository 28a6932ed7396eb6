// Vectors are arrays of 3, quaternions of 4 (x y z w), matrices Float32Array(16) by columns.
const add = (a, b, s = 1) => [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const scaled = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
const unit = (a) => scaled(a, 1 / (Math.hypot(...a) || 1));
const mix = (a, b, s) => a.map((x, i) => x + (b[i] - x) * s);

// The columns of a quaternion's rotation.
function axesOf([x, y, z, w]) {
  return [[1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)],
          [2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)],
          [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)]];
}
function fromAxes([a, b, c]) {
  const q = [Math.sqrt(Math.max(0, 1 + a[0] - b[1] - c[2])) / 2 * (Math.sign(b[2] - c[1]) || 1),
             Math.sqrt(Math.max(0, 1 - a[0] + b[1] - c[2])) / 2 * (Math.sign(c[0] - a[2]) || 1),
             Math.sqrt(Math.max(0, 1 - a[0] - b[1] + c[2])) / 2 * (Math.sign(a[1] - b[0]) || 1),
             Math.sqrt(Math.max(0, 1 + a[0] + b[1] + c[2])) / 2];
  return scaledQuaternion(q, 1 / (Math.hypot(...q) || 1));
}
const scaledQuaternion = (q, s) => q.map((x) => x * s);
// Between two rotations, the short way; normalised, not at constant speed.
function mixRotation(a, b, s) {
  const same = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3] < 0 ? -1 : 1;
  const q = mix(a, scaledQuaternion(b, same), s);
  return scaledQuaternion(q, 1 / (Math.hypot(...q) || 1));
}
// v turned about a unit axis.
function turned(v, axis, angle) {
  const c = Math.cos(angle), s = Math.sin(angle), along = dot(v, axis) * (1 - c);
  return add(add(scaled(v, c), cross(axis, v), s), axis, along);
}
// Axes as a camera's: x right, y down, z forward.
function lookingAlong(forward, up) {
  const z = unit(forward);
  let x = cross(z, up);
  if (Math.hypot(...x) < 1e-6) x = cross(z, Math.abs(z[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0]);
  x = unit(x);
  return [x, cross(z, x), z];
}
// From the world to clip space, for a camera with these axes; tanX and tanY are half its view.
function viewProjection([x, y, z], eye, tanX, tanY, near, far) {
  const e = [dot(x, eye), dot(y, eye), dot(z, eye)];
  const a = (far + near) / (far - near), b = -2 * far * near / (far - near);
  const m = new Float32Array(16);
  for (let i = 0; i < 3; ++i) {
    m[4 * i] = x[i] / tanX;
    m[4 * i + 1] = -y[i] / tanY;
    m[4 * i + 2] = a * z[i];
    m[4 * i + 3] = z[i];
  }
  m.set([-e[0] / tanX, e[1] / tanY, -a * e[2] + b, -e[2]], 12);
  return m;
}
