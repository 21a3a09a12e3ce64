// A parallel projection, as of a drawing: no perspective, so lengths can be compared and a voxel has one size.

/** @typedef {import("./messages.js").Point} Point */

const STEEPEST = Math.PI / 2;
const FLATTEST = 0.15;

export class Camera {
  /** @type {Point} what is in the middle of the screen */
  target = [0, 0, 0];
  turn_rad = -0.5;
  tilt_rad = 0.95;
  scale = 40; // pixels a metre
  width = 1;
  height = 1;
  /** @type {Point} */ right = [1, 0, 0];
  /** @type {Point} */ up = [0, 1, 0];
  /** @type {Point} */ into = [0, 0, -1];
  ahead = [0, 1];

  constructor() {
    this.change();
  }

  /** Works out the axes; to be called after each change. */
  change() {
    this.tilt_rad = Math.min(STEEPEST, Math.max(FLATTEST, this.tilt_rad));
    this.scale = Math.min(1500, Math.max(0.5, this.scale));
    const [c, s, ct, st] = [Math.cos(this.turn_rad), Math.sin(this.turn_rad), Math.cos(this.tilt_rad), Math.sin(this.tilt_rad)];
    this.right = [c, s, 0];
    this.up = [-s * st, c * st, ct];
    this.into = [-s * ct, c * ct, -st];
    this.ahead = [-s, c];
  }

  /**
   * Pixels of a point of the map.
   * @param {ArrayLike<number>} p
   * @returns {[number, number]}
   */
  project(p) {
    const d = [p[0] - this.target[0], p[1] - this.target[1], p[2] - this.target[2]];
    const [right, up] = [this.right, this.up].map((axis) => d[0] * axis[0] + d[1] * axis[1] + d[2] * axis[2]);
    return [this.width / 2 + this.scale * right, this.height / 2 - this.scale * up];
  }

  /**
   * The point of a height that is seen at a pixel.
   * @param {number} x
   * @param {number} y
   * @param {number} height_m
   * @returns {Point}
   */
  point_at(x, y, height_m) {
    const a = (x - this.width / 2) / this.scale;
    const b = (this.height / 2 - y) / this.scale;
    const c = (b - (height_m - this.target[2]) * this.up[2]) / Math.sin(this.tilt_rad);
    const at = [0, 1].map((axis) => this.target[axis] + a * this.right[axis] + c * this.ahead[axis]);
    return [at[0], at[1], height_m];
  }

  /**
   * Moves what is seen by pixels.
   * @param {number} dx
   * @param {number} dy
   */
  pan(dx, dy) {
    const from = this.point_at(0, 0, this.target[2]);
    const to = this.point_at(-dx, -dy, this.target[2]);
    this.target = [this.target[0] + to[0] - from[0], this.target[1] + to[1] - from[1], this.target[2]];
  }

  /**
   * @param {number} dx
   * @param {number} dy
   */
  orbit(dx, dy) {
    this.turn_rad -= 0.006 * dx;
    this.tilt_rad += 0.006 * dy;
    this.change();
  }

  /**
   * Zooms about a pixel.
   * @param {number} factor
   * @param {number} x
   * @param {number} y
   */
  zoom(factor, x = this.width / 2, y = this.height / 2) {
    const before = this.point_at(x, y, this.target[2]);
    this.scale *= factor;
    this.change();
    const after = this.point_at(x, y, this.target[2]);
    this.target = [this.target[0] + before[0] - after[0], this.target[1] + before[1] - after[1], this.target[2]];
  }

  /**
   * Shows a box of the map as large as it can be shown.
   * @param {Point} low
   * @param {Point} high
   * @param {number} room the share of the width that is free
   */
  fit(low, high, room) {
    this.target = [(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, this.target[2]];
    if (!isFinite(low[0]) || !isFinite(high[0])) return;
    const corners = [low, high, [low[0], high[1], 0], [high[0], low[1], 0]].map((corner) => this.project(corner));
    const size = [0, 1].map((axis) => Math.max(...corners.map((p) => p[axis])) - Math.min(...corners.map((p) => p[axis])));
    this.scale *= 0.9 * Math.min((this.width * room) / size[0], this.height / size[1]);
    this.change();
    this.pan((-this.width * (1 - room)) / 2, 0);
  }
}

/**
 * Turns what a pointer, a wheel and fingers do into the camera's motion.
 * @param {HTMLElement} element
 * @param {Camera} camera
 * @param {{drag: (event: PointerEvent, phase: "down" | "move" | "up") => boolean, moved: (by_hand: boolean) => void}} owner
 *   drag takes a gesture for itself (true) where an operator aims
 */
export function steer(element, camera, owner) {
  /** @type {Map<number, PointerEvent>} */
  const pointers = new Map();
  element.addEventListener("contextmenu", (event) => event.preventDefault());
  element.addEventListener("pointerdown", (event) => {
    element.setPointerCapture(event.pointerId);
    element.focus({ preventScroll: true });
    pointers.set(event.pointerId, event);
    owner.drag(event, "down");
  });
  element.addEventListener("pointermove", (event) => {
    const before = pointers.get(event.pointerId);
    if (!before || owner.drag(event, "move")) return;
    const [dx, dy] = [event.clientX - before.clientX, event.clientY - before.clientY];
    const other = [...pointers.values()].find((p) => p.pointerId !== event.pointerId);
    if (other) pinch(before, event, other);
    else if (event.buttons & 6 || event.shiftKey) camera.pan(dx, dy);
    else camera.orbit(dx, dy);
    pointers.set(event.pointerId, event);
    owner.moved(event.shiftKey || (event.buttons & 6) !== 0 || other !== undefined);
  });
  for (const name of /** @type {const} */ (["pointerup", "pointercancel"]))
    element.addEventListener(name, (event) => {
      pointers.delete(event.pointerId);
      owner.drag(event, "up");
    });
  element.addEventListener("wheel", (event) => {
    event.preventDefault();
    camera.zoom(Math.exp(-0.0015 * event.deltaY), event.clientX, event.clientY);
    owner.moved(false);
  }, { passive: false });

  /**
   * @param {PointerEvent} before
   * @param {PointerEvent} now
   * @param {PointerEvent} other
   */
  function pinch(before, now, other) {
    const gap = (/** @type {PointerEvent} */ p) => Math.hypot(p.clientX - other.clientX, p.clientY - other.clientY);
    camera.pan((now.clientX - before.clientX) / 2, (now.clientY - before.clientY) / 2);
    camera.zoom(gap(now) / Math.max(1, gap(before)), (now.clientX + other.clientX) / 2, (now.clientY + other.clientY) / 2);
  }
}
