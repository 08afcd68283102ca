// SPDX-FileCopyrightText: 2026 The warpagg authors
// SPDX-License-Identifier: MIT

// Vectors are arrays of three numbers.
const add = (a, b) => a.map((x, i) => x + b[i]);
const subtract = (a, b) => a.map((x, i) => x - b[i]);
const times = (s, a) => a.map(x => s * x);
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = a => times(1 / (Math.hypot(...a) || 1), a);
/** Rotates `a` about the unit vector `axis`. */
function rotated(a, axis, angle) {
  const c = Math.cos(angle), s = Math.sin(angle);
  return add(add(times(c, a), times(s, cross(axis, a))), times(dot(axis, a) * (1 - c), axis));
}

/** Returns the point nearest to a camera's axis that `view` shows in its middle: the pivot. */
function pivotDistance(view, scene) {
  const ahead = dot(view.axes[2], subtract(scene.pivot, view.position));
  return ahead > 2 * scene.near ? ahead : scene.radius;
}

/**
 * A camera that moves. `axes` are the directions right, down and ahead in the world. The pivot lies
 * ahead, at `distance`.
 */
class Camera {
  constructor(scene) {
    this.scene = scene;
    this.show(0);
  }
  /** Takes the place of a training view. */
  show(index) {
    const view = this.scene.views[index];
    this.view = view;
    this.position = view.position;
    this.axes = view.axes;
    this.distance = pivotDistance(view, this.scene);
  }
  get pivot() { return add(this.position, times(this.distance, this.axes[2])); }
  turn(axis, angle) {
    this.axes = this.axes.map(a => unit(rotated(a, axis, angle)));
  }
  /** Turns around the pivot, by angles about the up direction and about the right axis. */
  orbit(aside, upward) {
    const { pivot } = this, { up } = this.scene, steepest = 0.995, before = this.axes;
    const steep = () => Math.abs(dot(this.axes[2], up)), was = steep();
    this.turn(before[0], upward);
    if (steep() > steepest && steep() > was) this.axes = before;
    this.turn(up, aside);
    this.position = subtract(pivot, times(this.distance, this.axes[2]));
  }
  /** Moves along the axes, in units of the distance of the pivot. */
  move(right, down, ahead) {
    [right, down, ahead].forEach((step, k) => {
      this.position = add(this.position, times(step * this.distance, this.axes[k]));
    });
  }
  zoom(factor) {
    const { pivot } = this;
    this.distance = Math.max(this.distance * factor, 2 * this.scene.near);
    this.position = subtract(pivot, times(this.distance, this.axes[2]));
  }
  /** Looks at a point that a pixel shows at this depth, and makes it the pivot. */
  lookAt(x, y, depth, camera) {
    const ray = [(x + 0.5 - camera.center[0]) / camera.focal[0], (y + 0.5 - camera.center[1]) / camera.focal[1], 1];
    const point = add(this.position, ray.map((r, k) => times(r * depth, this.axes[k])).reduce(add));
    const ahead = unit(subtract(point, this.position));
    const axis = cross(this.axes[2], ahead), sine = Math.hypot(...axis);
    if (sine > 1e-6) this.turn(unit(axis), Math.asin(Math.min(sine, 1)));
    this.distance = Math.hypot(...subtract(point, this.position));
  }
  /**
   * Returns the camera of an image of this size. An image of the view's shape shows the view
   * exactly. Other shapes show a part of it on one side, and more on the other.
   */
  image(width, height) {
    const { view } = this, across = width / view.width, along = height / view.height;
    const scale = Math.sqrt(across * along);
    return { axes: this.axes, position: this.position, size: [width, height],
             focal: times(scale, view.focal),
             center: [width / 2 + scale * (view.center[0] - view.width / 2),
                      height / 2 + scale * (view.center[1] - view.height / 2)] };
  }
}
