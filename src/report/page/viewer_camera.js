// The viewer's camera: its rotation q, the pivot in its middle, and the distance to it.
const kHalfView = Math.tan(0.4);  // of the shorter side, unless a frame's camera is shown

class Camera {
  constructor(model, canvas) {
    this.model = model;
    this.canvas = canvas;
    this.home();
  }

  home() {
    const {model} = this;
    // From where the cameras were, or else from where the surface faces, and from above.
    let seen = [0, 0, 0];
    for (const pose of model.poses) seen = add(seen, axesOf(pose.q)[2]);
    if (!model.poses.length) seen = scaled(model.facing, -1);
    seen = add(seen, model.up, -dot(seen, model.up));
    if (Math.hypot(...seen) < 1e-3) seen = lookingAlong(model.up, [0.3, 0.5, 0.8])[0];
    const forward = add(scaled(unit(turned(seen, model.up, 0.35)), Math.cos(0.55)), model.up, -Math.sin(0.55));
    const axes = lookingAlong(forward, model.up);
    this.set({q: fromAxes(axes), pivot: model.middle, distance: 0.05, half: kHalfView});
    // As near as about all corners of the box are in sight.
    const [tanX, tanY] = this.tangents(Math.max(1, this.canvas.clientWidth), Math.max(1, this.canvas.clientHeight));
    for (let bits = 0; bits < 8; ++bits) {
      const corner = add([0, 1, 2].map((i) => model.box[bits >> i & 1][i]), model.middle, -1);
      const [x, y, z] = axes.map((axis) => dot(axis, corner));
      this.distance = Math.max(this.distance, 0.92 * Math.max(Math.abs(x) / tanX, Math.abs(y) / tanY) - z);
    }
  }

  set(state) { Object.assign(this, state); }
  state() { return {q: this.q, pivot: this.pivot, distance: this.distance, half: this.half}; }
  axes() { return axesOf(this.q); }
  eye() { return add(this.pivot, this.axes()[2], -this.distance); }
  tangents(width, height) {
    const half = this.half / Math.min(width, height);
    return [half * width, half * height];
  }

  turn(right, down) {
    const up = this.model.up;
    let axes = this.axes().map((axis) => turned(axis, up, -right));
    // Not over the poles, where right and left change places.
    const slope = Math.asin(Math.max(-1, Math.min(1, dot(axes[2], up))));
    const tilt = Math.max(-1.5 - slope, Math.min(1.5 - slope, -down));
    axes = axes.map((axis) => turned(axis, axes[0], tilt));
    this.q = fromAxes(axes);
  }
  // By a share of the shorter side.
  move(right, down) {
    const [x, y] = this.axes(), size = 2 * this.half * this.distance;
    this.pivot = add(add(this.pivot, x, -right * size), y, -down * size);
  }
  zoom(factor) { this.distance = Math.max(0.03, Math.min(40 * this.model.radius, this.distance * factor)); }
  // Through the lens of a frame.
  frameView(pose) {
    const forward = axesOf(pose.q)[2];
    let distance = hit(this.model, pose.p, forward);
    if (!(distance < 1e6)) distance = 1;
    const half = this.model.camera ? Math.min(...this.model.camera) / 2 : 0.5;
    return {q: pose.q, pivot: add(pose.p, forward, distance), distance, half};
  }
  ray(x, y, width, height) {
    const [tanX, tanY] = this.tangents(width, height), [ax, ay, az] = this.axes();
    return unit(add(add(az, ax, (2 * x / width - 1) * tanX), ay, (2 * y / height - 1) * tanY));
  }
}

// Mouse, pen and fingers. Calls changed() after each motion, and centre(x, y) on a double click.
function listen(canvas, camera, changed, centre) {
  const pointers = new Map();
  let lastTap = 0;
  const span = () => {
    const [a, b] = [...pointers.values()];
    return {x: (a.x + b.x) / 2, y: (a.y + b.y) / 2, size: Math.hypot(a.x - b.x, a.y - b.y)};
  };
  const short = () => Math.min(canvas.clientWidth, canvas.clientHeight);
  canvas.addEventListener('pointerdown', (event) => {
    canvas.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, {x: event.clientX, y: event.clientY, moves: event.button > 0 || event.shiftKey});
    const tap = event.timeStamp - lastTap < 300 && pointers.size === 1 && event.pointerType === 'touch';
    lastTap = event.timeStamp;
    if (tap) centre(event.offsetX, event.offsetY);
  });
  canvas.addEventListener('pointermove', (event) => {
    const pointer = pointers.get(event.pointerId);
    if (!pointer) return;
    const before = pointers.size > 1 ? span() : null;
    const dx = event.clientX - pointer.x, dy = event.clientY - pointer.y;
    pointer.x = event.clientX;
    pointer.y = event.clientY;
    if (before) {
      const after = span();
      camera.zoom(before.size / Math.max(1, after.size));
      camera.move((after.x - before.x) / short(), (after.y - before.y) / short());
    } else if (pointer.moves) {
      camera.move(dx / short(), dy / short());
    } else {
      camera.turn(4 * dx / short(), 4 * dy / short());
    }
    changed();
  });
  for (const end of ['pointerup', 'pointercancel'])
    canvas.addEventListener(end, (event) => pointers.delete(event.pointerId));
  canvas.addEventListener('contextmenu', (event) => event.preventDefault());
  canvas.addEventListener('dblclick', (event) => centre(event.offsetX, event.offsetY));
  canvas.addEventListener('wheel', (event) => {
    event.preventDefault();
    camera.zoom(Math.exp(Math.max(-0.5, Math.min(0.5, event.deltaY * (event.deltaMode ? 0.05 : 0.0015)))));
    changed();
  }, {passive: false});
  canvas.addEventListener('keydown', (event) => {
    const turns = {ArrowLeft: [0.1, 0], ArrowRight: [-0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1]};
    if (turns[event.key]) camera.turn(...turns[event.key]);
    else if (event.key === '+' || event.key === '=') camera.zoom(0.85);
    else if (event.key === '-') camera.zoom(1 / 0.85);
    else return;
    event.preventDefault();
    changed();
  });
}
