// The viewer: the model, the path with some of its cameras, the objects' boxes and names.
const still = matchMedia('(prefers-reduced-motion: reduce)');
const colourOf = (name) => {
  const text = getComputedStyle(document.documentElement).getPropertyValue(name).trim().replace('#', '');
  const digits = text.length === 3 ? [...text].map((d) => d + d).join('') : text;
  return [0, 2, 4].map((i) => parseInt(digits.slice(i, i + 2), 16) / 255);
};

class Viewer {
  constructor(canvas, model) {
    this.canvas = canvas;
    this.model = model;
    this.camera = new Camera(model, canvas);
    this.drawing = new Drawing(canvas, model);
    this.shading = 0;
    this.layers = {path: true, truth: false, objects: false};
    this.shown = null;  // the pose whose camera is marked
    this.inside = false;  // looks through a camera: the path would be before its lens
    this.makeNames();
    this.makeLines();
    listen(canvas, this.camera, () => this.moved(), (x, y) => this.centre(x, y));
    // At once: it runs before the browser paints, so no stretched picture is seen.
    new ResizeObserver(() => this.draw()).observe(canvas);
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => {
      this.makeLines();
      this.redraw();
    });
  }

  // By hand: ends a flight.
  moved() {
    this.flight = null;
    this.inside = false;
    this.redraw();
  }
  redraw() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame((now) => {
      this.waiting = false;
      this.step(now);
      this.draw();
    });
  }

  flyTo(target, duration_ms = 450, inside = false) {
    this.inside = inside;
    if (still.matches || duration_ms <= 0) {
      this.flight = null;
      this.camera.set(target);
    } else {
      this.flight = {from: this.camera.state(), to: target, begin: performance.now(), duration_ms};
    }
    this.redraw();
  }
  step(now) {
    if (!this.flight) return;
    const {from, to, begin, duration_ms} = this.flight;
    const s = Math.max(0, Math.min(1, (now - begin) / duration_ms)), eased = s * s * (3 - 2 * s);
    const eye = (state) => add(state.pivot, axesOf(state.q)[2], -state.distance);
    const q = mixRotation(from.q, to.q, eased), distance = from.distance + (to.distance - from.distance) * eased;
    const p = mix(eye(from), eye(to), eased);
    this.camera.set(s < 1 ? {q, distance, pivot: add(p, axesOf(q)[2], distance), half: from.half + (to.half - from.half) * eased} : to);
    if (s < 1) this.redraw();
    else this.flight = null;
  }
  home() {
    const state = this.camera.state();
    this.camera.home();
    const target = this.camera.state();
    this.camera.set(state);
    this.flyTo(target);
  }
  centre(x, y) {
    const {canvas, camera, model} = this;
    const eye = camera.eye(), ray = camera.ray(x, y, canvas.clientWidth, canvas.clientHeight);
    const distance = hit(model, eye, ray);
    if (!(distance < 1e6)) return;
    const pivot = add(eye, ray, distance);
    this.flyTo({...camera.state(), pivot});
  }
  showObject(id) {
    const object = this.model.objects.find((o) => o.id === id);
    if (!object) return;
    this.layers.objects = true;
    this.flyTo({...this.camera.state(), pivot: object.centre, half: kHalfView,
                distance: Math.max(0.3, 2.2 * Math.hypot(...object.size))});
  }

  frustum(pose, size, colour, lines) {
    const [x, y, z] = axesOf(pose.q), [tanX, tanY] = this.model.camera || [1.2, 0.9];
    const corners = [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(
        ([a, b]) => add(add(add(pose.p, z, size), x, a * size * tanX / 2), y, b * size * tanY / 2));
    corners.forEach((corner, i) => lines.push(...pose.p, ...corner, ...colour, ...corner, ...corners[(i + 1) % 4], ...colour));
  }
  makeLines() {
    const {model, drawing} = this;
    const path = [], cameras = [], before = [], truth = [], boxes = [];
    const states = [colourOf('--fused'), colourOf('--tracked'), colourOf('--lost')];
    const {poses} = model;
    statesOfPath(model).forEach((state, i) => path.push(...poses[i].p, ...poses[i + 1].p, ...states[state]));
    this.frustumSize = Math.min(0.3, Math.max(0.02, 0.06 * model.radius));
    // Some cameras, so far apart that they do not hide each other.
    let length = 0, next = 0;
    for (let i = 1; i < poses.length; ++i) length += Math.hypot(...add(poses[i].p, poses[i - 1].p, -1));
    const apart = Math.max(1.5 * this.frustumSize, length / 24);
    for (let i = 0, gone = 0; i < poses.length; ++i) {
      if (i > 0) gone += Math.hypot(...add(poses[i].p, poses[i - 1].p, -1));
      if (gone < next) continue;
      this.frustum(poses[i], this.frustumSize, colourOf('--accent'), cameras);
      next = gone + apart;
    }
    const polyline = (points, colour, lines) => {
      for (let i = 3; i + 3 <= points.length; i += 3)
        lines.push(...points.subarray(i - 3, i), ...points.subarray(i, i + 3), ...colour);
    };
    polyline(model.tracked, colourOf('--c0'), before);
    polyline(model.truth, colourOf('--truth'), truth);
    for (const object of model.objects) this.box(object, boxes);
    this.sets = Object.fromEntries(Object.entries({path, cameras, before, truth, boxes, current: []})
        .map(([name, lines]) => [name, drawing.lines(lines, this.sets && this.sets[name])]));
    this.mark(this.shown);
  }
  box(object, lines) {
    const axes = axesOf(object.q), colour = object.colour.map((c) => c / 255);
    const corner = (bits) => axes.reduce(
        (p, axis, i) => add(p, axis, (bits >> i & 1 ? 0.5 : -0.5) * object.size[i]), object.centre);
    for (let bits = 0; bits < 8; ++bits)
      for (const bit of [1, 2, 4])
        if (!(bits & bit)) lines.push(...corner(bits), ...corner(bits | bit), ...colour);
  }
  mark(pose) {
    this.shown = pose;
    const lines = [];
    if (pose) this.frustum(pose, 1.5 * this.frustumSize, colourOf('--lost'), lines);
    this.drawing.lines(lines, this.sets.current);
    this.redraw();
  }

  makeNames() {
    const names = document.getElementById('names');
    this.names = this.model.objects.map((object) => {
      const span = document.createElement('span');
      span.textContent = object.name;
      span.style.borderColor = `rgb(${object.colour.join(' ')})`;
      names.append(span);
      return span;
    });
  }
  placeNames(clip) {
    const {clientWidth: width, clientHeight: height} = this.canvas, taken = [];
    this.model.objects.forEach((object, i) => {
      const p = add(object.centre, this.model.up, 0.5 * Math.max(...object.size));
      const [x, y, , w] = [0, 1, 2, 3].map((r) => clip[r] * p[0] + clip[4 + r] * p[1] + clip[8 + r] * p[2] + clip[12 + r]);
      const [px, py] = [(x / w + 1) / 2 * width, (1 - y / w) / 2 * height];
      const half = this.names[i].offsetWidth / 2 + 2;
      // A name that would cover another is left out.
      const free = taken.every((t) => Math.abs(t.px - px) > t.half + half || Math.abs(t.py - py) > 22);
      const visible = this.layers.objects && w > 0 && free;
      this.names[i].style.visibility = visible ? 'visible' : 'hidden';
      if (!visible) return;
      taken.push({px, py, half});
      this.names[i].style.transform = `translate(${px}px, ${py}px) translate(-50%, -100%)`;
    });
  }
  // A round length at the pivot's distance, 60 to 150 px.
  placeScale(metresPerPixel) {
    let length = 10 ** Math.floor(Math.log10(150 * metresPerPixel));
    for (const factor of [5, 2]) if (factor * length / metresPerPixel <= 150) { length *= factor; break; }
    document.getElementById('scale-bar').style.width = `${length / metresPerPixel}px`;
    document.getElementById('scale-text').textContent = length >= 1 ? `${length} m` : length >= 0.01 ? `${Math.round(100 * length)} cm` : `${Math.round(1000 * length)} mm`;
  }

  draw() {
    const {canvas, camera, model, layers, sets} = this;
    const pixelRatio = Math.min(3, devicePixelRatio || 1);
    const width = Math.max(1, canvas.clientWidth), height = Math.max(1, canvas.clientHeight);
    const [w, h] = [Math.round(width * pixelRatio), Math.round(height * pixelRatio)];
    if (canvas.width !== w || canvas.height !== h) Object.assign(canvas, {width: w, height: h});
    const [tanX, tanY] = camera.tangents(width, height), eye = camera.eye();
    const reach = Math.hypot(...add(eye, model.middle, -1)) + 3 * model.radius;
    const clip = viewProjection(camera.axes(), eye, tanX, tanY, Math.max(0.01, reach / 5000), reach);
    const shown = [];
    if (layers.path && !this.inside) shown.push({set: sets.before, width: 1.5}, {set: sets.cameras, width: 1}, {set: sets.path, width: 2.5}, {set: sets.current, width: 2});
    if (layers.truth && !this.inside) shown.push({set: sets.truth, width: 2});
    if (layers.objects) shown.push({set: sets.boxes, width: 1.5});
    this.drawing.draw({clip, eye, pixelRatio}, colourOf('--view'), this.shading, shown);
    this.placeNames(clip);
    this.placeScale(2 * tanX * camera.distance / width);
  }
}
