// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

const byId = id => document.getElementById(id);

function show(message) {
  byId('message').textContent = message;
  byId('message').hidden = !message;
}

/** Draws when something changes, and keeps the order of the Gaussians up to date. */
class Viewer {
  constructor(scene, splat, gl) {
    this.scene = scene;
    this.canvas = gl.canvas;
    this.camera = new Camera(scene);
    this.renderer = new Renderer(gl, scene, splat);
    this.controls = new Controls(this.canvas, this.camera, () => this.change(), (x, y) => this.pick(x, y));
    this.version = 0;      // of the camera
    this.sorted = -1;      // version of the order
    this.isSorting = false;
    const source = new Blob([`(${sortWorker})()`], { type: 'text/javascript' });
    this.worker = new Worker(URL.createObjectURL(source));
    this.worker.onmessage = ({ data }) => this.receive(data);
    this.worker.onerror = () => show('This browser does not let the page sort the scene in a worker.');
    const positions = positionsOf(splat);
    this.worker.postMessage({ positions }, [positions.buffer]);
    new ResizeObserver(() => this.resize()).observe(this.canvas);
    this.resize();
  }
  resize() {
    const ratio = Math.min(devicePixelRatio, 2);
    this.canvas.width = Math.max(1, Math.round(this.canvas.clientWidth * ratio));
    this.canvas.height = Math.max(1, Math.round(this.canvas.clientHeight * ratio));
    this.change();
  }
  get image() { return this.camera.image(this.canvas.width, this.canvas.height); }
  showView(index) {
    this.camera.show(index);
    this.change();
  }
  change() {
    this.version++;
    this.requestFrame();
  }
  requestFrame() {
    this.frame ??= requestAnimationFrame(time => this.nextFrame(time));
  }
  nextFrame(time) {
    this.frame = undefined;
    const seconds = Math.min((time - (this.lastTime ?? time)) / 1000, 0.1);
    this.lastTime = this.controls.fly(seconds) ? time : undefined;
    if (this.lastTime) this.change();
    this.sort();
    if (this.sorted < 0) return;
    this.renderer.draw(this.image);
    // Tests and embedding pages read this.
    document.documentElement.dataset.state = this.sorted === this.version ? 'complete' : 'moving';
  }
  sort() {
    if (this.isSorting || this.sorted === this.version) return;
    const forward = this.camera.axes[2], offset = dot(forward, this.camera.position);
    this.isSorting = true;
    this.worker.postMessage({ forward, offset, near: this.scene.near, version: this.version });
  }
  receive({ order, version }) {
    this.isSorting = false;
    this.sorted = version;
    this.renderer.setOrder(order);
    this.requestFrame();
  }
  pick(x, y) {
    const ratio = this.canvas.width / this.canvas.clientWidth, image = this.image;
    const px = Math.floor(x * ratio), py = Math.floor(y * ratio);
    const depth = this.renderer.depthAt(image, px, py, this.camera.distance);
    if (depth) this.camera.lookAt(px, py, depth, image);
    this.change();
  }
}

/** The buttons, the slider of views, and the hash of the address: #view=3&ui=0. */
function connectPage(viewer, scene, splat) {
  const slider = byId('views').querySelector('input'), output = byId('views').querySelector('output');
  const last = scene.views.length - 1, isMouse = matchMedia('(pointer: fine)').matches;
  const go = index => {
    const view = Math.max(0, Math.min(last, index | 0));
    slider.value = view + 1;
    output.textContent = `${view + 1} of ${last + 1}`;
    viewer.showView(view);
  };
  const readHash = () => {
    const hash = new URLSearchParams(location.hash.slice(1));
    document.body.classList.toggle('plain', hash.get('ui') === '0');
    go(hash.get('view') ?? 0);
  };
  const toggleHelp = () => {
    byId('help').hidden = !byId('help').hidden;
    byId('question').setAttribute('aria-expanded', !byId('help').hidden);
  };
  slider.max = last + 1;
  slider.oninput = () => go(slider.value - 1);
  byId('views').hidden = last === 0;
  byId('reset').onclick = readHash;
  byId('question').onclick = toggleHelp;
  addEventListener('hashchange', readHash);
  addEventListener('keydown', event => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.code === 'KeyR') readHash();
    if (event.code === 'KeyH') document.body.classList.toggle('plain');
    if (event.code === 'Escape') byId('help').hidden = true;
  });
  viewer.canvas.addEventListener('pointerdown', () => { byId('help').hidden = true; });
  const whole = scene.gaussians > splat.count ? ` of ${scene.gaussians}` : '';
  byId('facts').textContent = `${splat.count}${whole} Gaussians.`;
  byId('bar').hidden = false;
  if (isMouse) viewer.canvas.focus({ preventScroll: true });
  readHash();
}

function start() {
  const gl = byId('canvas').getContext('webgl2', { alpha: false, antialias: false, depth: false,
                                                   powerPreference: 'high-performance' });
  if (!gl) {
    show('This browser cannot show the scene, because it has no WebGL 2. ' +
         'Open the page in a current version of Chrome, Edge, Firefox or Safari.');
    return;
  }
  gl.canvas.addEventListener('webglcontextlost',
                             () => show('The graphics device was lost. Reload the page to continue.'));
  const scene = JSON.parse(byId('scene').textContent), splat = parsePly(embeddedBytes());
  globalThis.viewer = new Viewer(scene, splat, gl);  // tests and embedding pages use it
  connectPage(viewer, scene, splat);
  show('');
}

try {
  start();
} catch (problem) {
  show(`The scene cannot be shown: ${problem.message}.`);
  throw problem;
}
