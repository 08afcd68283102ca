// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

/** Moves the camera by mouse, touch and keys. Calls `changed` after each move. */
class Controls {
  constructor(canvas, camera, changed, pick) {
    Object.assign(this, { canvas, camera, changed, pick });
    this.pointers = new Map();
    this.keys = new Set();
    this.lastTap = { time: 0, x: 0, y: 0 };
    const listen = (type, handler) => canvas.addEventListener(type, handler, { passive: false });
    listen('pointerdown', event => this.down(event));
    listen('pointermove', event => this.drag(event));
    for (const type of ['pointerup', 'pointercancel']) listen(type, event => this.up(event));
    listen('contextmenu', event => event.preventDefault());
    listen('wheel', event => this.wheel(event));
    addEventListener('keydown', event => this.key(event, true));
    addEventListener('keyup', event => this.key(event, false));
    addEventListener('blur', () => this.keys.clear());
  }
  down(event) {
    this.canvas.setPointerCapture(event.pointerId);
    this.pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    this.tapStart = { time: event.timeStamp, x: event.clientX, y: event.clientY };
  }
  up(event) {
    this.pointers.delete(event.pointerId);
    const { clientX: x, clientY: y, timeStamp: time } = event, near = 24, quick = 350;
    const isAt = place => Math.hypot(x - place.x, y - place.y) < near && time - place.time < quick;
    if (event.type !== 'pointerup' || !this.tapStart || !isAt(this.tapStart)) return;
    const isDouble = isAt(this.lastTap);
    this.lastTap = isDouble ? { time: 0, x, y } : { time, x, y };
    if (isDouble) this.pick(x, y);
  }
  drag(event) {
    const last = this.pointers.get(event.pointerId);
    if (!last) return;
    const before = this.gesture(), dx = event.clientX - last.x, dy = event.clientY - last.y;
    Object.assign(last, { x: event.clientX, y: event.clientY });
    if (this.pointers.size > 1) {
      const now = this.gesture();
      this.camera.zoom(before.spread / Math.max(now.spread, 1));
      this.pan(now.x - before.x, now.y - before.y);
    } else if (event.buttons & 6 || event.shiftKey) {
      this.pan(dx, dy);
    } else {
      const angle = Math.PI / Math.min(innerWidth, innerHeight);
      this.camera.orbit(-dx * angle, -dy * angle);
    }
    this.changed();
  }
  /** Returns the middle of the first two pointers and their distance. */
  gesture() {
    const [a, b = a] = [...this.pointers.values()];
    return { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2, spread: Math.max(Math.hypot(a.x - b.x, a.y - b.y), 1) };
  }
  pan(dx, dy) {
    const { focal } = this.camera.image(innerWidth, innerHeight);
    this.camera.move(-dx / focal[0], -dy / focal[1], 0);
  }
  wheel(event) {
    event.preventDefault();
    const lines = event.deltaMode === 1 ? 30 : 1;
    this.camera.zoom(Math.exp(0.0015 * lines * Math.max(-300, Math.min(300, event.deltaY))));
    this.changed();
  }
  key(event, isDown) {
    const isForSlider = event.code.startsWith('Arrow') && event.target.matches?.('input');
    if (event.ctrlKey || event.metaKey || event.altKey || isForSlider) return;
    this.isFast = event.shiftKey;
    if (!(event.code in Controls.directions)) return;
    event.preventDefault();
    this.keys[isDown ? 'add' : 'delete'](event.code);
    this.changed();
  }
  /** Flies for the time since the last frame. Returns whether a key is held. */
  fly(seconds) {
    const step = seconds * (this.isFast ? 2.4 : 0.8);
    for (const code of this.keys) this.camera.move(...times(step, Controls.directions[code]));
    return this.keys.size > 0;
  }
}
Controls.directions = {
  KeyW: [0, 0, 1], ArrowUp: [0, 0, 1], KeyS: [0, 0, -1], ArrowDown: [0, 0, -1], KeyA: [-1, 0, 0],
  ArrowLeft: [-1, 0, 0], KeyD: [1, 0, 0], ArrowRight: [1, 0, 0], KeyE: [0, -1, 0], KeyQ: [0, 1, 0]
};
