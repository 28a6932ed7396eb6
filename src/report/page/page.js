// Joins the viewer with its buttons, the time slider, the charts and the table of objects.
const page = document.documentElement;
const report = (error) => {
  page.dataset.errors = `${page.dataset.errors || ''}${error}\n`;
};
addEventListener('error', (event) => report(event.message));
document.addEventListener('securitypolicyviolation', (event) => report(`blocked: ${event.violatedDirective}`));

const byId = (id) => document.getElementById(id);
const press = (button, on) => button.setAttribute('aria-pressed', on);
const kStates = ['fused', 'tracked, not fused', 'lost'];

function nearest(list, time, timeOf) {
  let low = 0, high = list.length - 1;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (timeOf(list[middle]) < time) low = middle + 1;
    else high = middle;
  }
  return low > 0 && time - timeOf(list[low - 1]) < timeOf(list[low]) - time ? low - 1 : low;
}

function textAt(model, time) {
  const parts = [`${time.toFixed(2)} s`];
  if (model.frames.length) {
    const [index, , state, ms] = model.frames[nearest(model.frames, time, (f) => f[1])];
    parts.push(`frame ${index}`, kStates[state], `${ms.toFixed(0)} ms`);
  }
  return parts.join(' · ');
}

function markCharts(time) {
  for (const chart of document.querySelectorAll('.chart')) {
    const {left, right, low, high} = chart.dataset;
    const x = +left + (right - left) * Math.max(0, Math.min(1, (time - low) / (high - low)));
    chart.classList.add('marked');
    chart.querySelector('.cursor').setAttribute('x1', x);
    chart.querySelector('.cursor').setAttribute('x2', x);
  }
}

function timeOfClick(chart, event) {
  const box = chart.getBoundingClientRect();
  const x = (event.clientX - box.left) / box.width * chart.viewBox.baseVal.width;
  const {left, right, low, high} = chart.dataset;
  return +low + (high - low) * Math.max(0, Math.min(1, (x - left) / (right - left)));
}

// Shows a time everywhere. `through`: fly into the camera of then.
function timeControl(model, viewer) {
  const slider = byId('time');
  let playing = null;
  const show = (time, through, duration_ms) => {
    markCharts(time);
    byId('time-text').textContent = textAt(model, time);
    if (!model.poses.length) return;
    const i = nearest(model.poses, time, (pose) => pose.t);
    slider.value = i;
    if (!viewer) return;
    viewer.mark(model.poses[i]);
    if (through) viewer.flyTo(viewer.camera.frameView(model.poses[i]), duration_ms, true);
  };
  const stop = () => {
    playing = null;
    byId('play').classList.remove('on');
  };
  const play = (now) => {
    if (!playing) return;
    const time = playing.from + (now - playing.begin) / 1000;
    const last = model.poses[model.poses.length - 1].t;
    show(Math.min(time, last), true, 0);
    if (time < last) requestAnimationFrame(play);
    else stop();
  };
  slider.max = Math.max(0, model.poses.length - 1);
  slider.addEventListener('input', () => {
    stop();
    show(model.poses[slider.value].t, true, 0);
  });
  byId('play').addEventListener('click', () => {
    if (playing) return stop();
    const at = +slider.value >= +slider.max ? 0 : +slider.value;
    playing = {from: model.poses[at].t, begin: performance.now()};
    byId('play').classList.add('on');
    requestAnimationFrame(play);
  });
  for (const chart of document.querySelectorAll('.chart'))
    chart.addEventListener('click', (event) => {
      stop();
      show(timeOfClick(chart, event), true);
      const box = byId('model').getBoundingClientRect();
      if (box.bottom < 200 || box.top > innerHeight - 200)
        byId('model').scrollIntoView({behavior: still.matches ? 'auto' : 'smooth'});
    });
  byId('view').addEventListener('pointerdown', stop);
  byId('time-row').hidden = model.poses.length < 2;
  if (model.poses.length) byId('time-text').textContent = textAt(model, model.poses[0].t);
  // FILE.html#t=12.5 opens in the camera of that time.
  const asked = location.hash.match(/^#t=(\d+(\.\d+)?)$/);
  if (asked) show(+asked[1], true, 0);
}

function buttons(model, viewer) {
  for (const button of document.querySelectorAll('[data-shading]')) {
    button.hidden = button.dataset.shading === '2' && !model.palette.length;
    button.addEventListener('click', () => {
      viewer.shading = +button.dataset.shading;
      for (const other of document.querySelectorAll('[data-shading]')) press(other, other === button);
      viewer.redraw();
    });
  }
  const has = {path: model.poses.length > 1, truth: model.truth.length > 3, objects: model.objects.length > 0};
  viewer.layers.objects = has.objects;
  for (const button of document.querySelectorAll('[data-layer]')) {
    const layer = button.dataset.layer;
    button.hidden = !has[layer];
    press(button, viewer.layers[layer]);
    button.addEventListener('click', () => {
      viewer.layers[layer] = !viewer.layers[layer];
      press(button, viewer.layers[layer]);
      viewer.redraw();
    });
  }
  byId('shading').hidden = model.vertices === 0;
  byId('layers').hidden = !Object.values(has).includes(true);
  byId('whole').addEventListener('click', () => viewer.home());
  for (const row of document.querySelectorAll('[data-object]')) {
    const show = () => {
      viewer.showObject(+row.dataset.object);
      press(document.querySelector('[data-layer="objects"]'), true);
      byId('model').scrollIntoView({behavior: still.matches ? 'auto' : 'smooth'});
    };
    row.addEventListener('click', show);
    row.addEventListener('keydown', (event) => { if (event.key === 'Enter') show(); });
  }
}

const model = readModel();
let viewer = null;
try {
  viewer = new Viewer(byId('view'), model);
  buttons(model, viewer);
  viewer.draw();
} catch (error) {
  byId('message').textContent = `The model cannot be shown: ${error.message}.`;
  for (const bar of document.querySelectorAll('.bar, .scale, .whole')) bar.hidden = true;
  report(error.message);
}
timeControl(model, viewer);
page.dataset.state = 'ready';
