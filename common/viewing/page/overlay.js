// What lies over the map: grids, path, cloud, robot, candidates, obstacles, edits, loops. What is old is grey.
import { css } from "./palette.js";

/** @typedef {import("./camera.js").Camera} Camera */
/** @typedef {import("./connection.js").Connection} Connection */
/** @typedef {import("./messages.js").Point} Point */

/** Ages (s) from which on what is shown is old. A scan may take a second. */
export const STALE_S = { robot: 2.5, pose: 2.5, obstacles: 2.5, cloud: 3, service: 2.5 };

const OBSTACLE_COLOURS = ["bad", "doubt", "accent"]; // by type: obstacle, overhang, negative
const EDIT_COLOURS = { erase: "dim", free: "good", blocked: "bad" };

/** @param {number[]} pose x, y, z, yaw @returns {(x: number, y: number, z?: number) => Point} */
const placed = ([px, py, pz, yaw]) => {
  const [c, s] = [Math.cos(yaw), Math.sin(yaw)];
  return (x, y, z = 0) => [px + c * x - s * y, py + s * x + c * y, pz + z];
};

export class Overlay {
  /**
   * @param {HTMLCanvasElement} canvas
   * @param {Camera} camera
   * @param {Connection} bus
   * @param {import("./grids.js").Grids} grids
   * @param {Set<string>} layers those that are shown
   */
  constructor(canvas, camera, bus, grids, layers) {
    this.canvas = canvas;
    this.context = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
    this.camera = camera;
    this.bus = bus;
    this.grids = grids;
    this.layers = layers;
    /** @type {Point[]} where loops were closed */
    this.loops = [];
    /** @type {{from: Point, to: Point, kind: string} | undefined} what the operator aims at */
    this.aim = undefined;
    this.ratio = 1;
  }

  /**
   * @param {number} width
   * @param {number} height
   * @param {number} ratio device pixels for each of these
   */
  resize(width, height, ratio) {
    this.ratio = ratio;
    [this.canvas.width, this.canvas.height] = [width * ratio, height * ratio];
  }

  /** The pose that the robot was told to have last: x, y, z, yaw. @returns {number[] | undefined} */
  pose() {
    const pose = /** @type {import("./messages.js").Pose | undefined} */ (this.bus.data("pose"));
    return pose && [...pose.position, pose.yaw];
  }

  draw() {
    const { context } = this;
    context.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    context.clearRect(0, 0, this.camera.width, this.camera.height);
    context.lineJoin = "round";
    context.font = '12px system-ui, "DejaVu Sans", sans-serif';
    this.draw_grids();
    this.draw_edits();
    if (this.layers.has("path")) this.draw_path();
    if (this.layers.has("cloud")) this.draw_cloud();
    this.draw_others();
    this.draw_robot();
    this.draw_aim();
    this.draw_scale();
  }

  /**
   * Begins a line through points.
   * @param {Point[]} points
   */
  trace(points) {
    this.context.beginPath();
    for (const p of points) this.context.lineTo(...this.camera.project(p));
  }

  draw_grids() {
    const { context, camera, ratio } = this;
    for (const grid of this.grids.shown(this.layers)) {
      const [o, x, y] = [[0, 0], [1, 0], [0, 1]].map(([i, j]) =>
        camera.project([grid.xy0[0] + i * grid.cell_m, grid.xy0[1] + j * grid.cell_m, 0]));
      context.setTransform(ratio * (x[0] - o[0]), ratio * (x[1] - o[1]), ratio * (y[0] - o[0]), ratio * (y[1] - o[1]),
        ratio * o[0], ratio * o[1]);
      context.imageSmoothingEnabled = false;
      context.globalAlpha = 0.55;
      context.drawImage(grid.image, 0, 0);
    }
    context.globalAlpha = 1;
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
  }

  draw_edits() {
    const edits = /** @type {import("./messages.js").Edit[]} */ (this.bus.data("edits")?.boxes ?? []);
    for (const edit of edits) {
      const at = placed([edit.placed[0], edit.placed[1], 0, edit.placed[2]]);
      const [[x0, y0, z0], [x1, y1, z1]] = [edit.lowest, edit.highest];
      this.context.strokeStyle = css(EDIT_COLOURS[/** @type {keyof EDIT_COLOURS} */ (edit.kind)] ?? "dim");
      this.context.lineWidth = 1.5;
      for (const z of [z0, z1]) {
        this.trace([at(x0, y0, z), at(x1, y0, z), at(x1, y1, z), at(x0, y1, z)]);
        this.context.closePath();
        this.context.stroke();
      }
      this.label(`${edit.kind} ${edit.id}`, at(x1, y1, z1));
    }
  }

  draw_path() {
    const { context, camera } = this;
    context.strokeStyle = css("ink");
    context.globalAlpha = 0.75;
    context.lineWidth = 1.5;
    context.beginPath();
    for (const told of this.bus.with_prefix("path/")) {
      const points = new Float32Array(told.bytes);
      for (let i = 0; i < points.length; i += 4) {
        const at = camera.project([points[i], points[i + 1], points[i + 2]]);
        if (points[i + 3] || i === 0) context.moveTo(...at);
        else context.lineTo(...at);
      }
    }
    context.stroke();
    context.globalAlpha = 1;
    for (const loop of this.loops) this.ring(loop, 7, css("accent"));
  }

  draw_cloud() {
    this.context.fillStyle = css("doubt");
    for (const { topic, data, bytes } of [...this.bus.with_prefix("cloud"), ...this.bus.with_prefix("slice/")]) {
      if (!this.bus.is_fresh(topic, topic === "cloud" ? STALE_S.cloud : 1)) continue;
      const at = placed(/** @type {import("./messages.js").Placed} */ (data).pose);
      const points = new Int16Array(bytes);
      this.context.globalAlpha = Math.max(0.25, 1 - this.bus.age_s(topic) / STALE_S.cloud);
      for (let i = 0; i < points.length; i += 3) {
        const [x, y] = this.camera.project(at(points[i] / 100, points[i + 1] / 100, points[i + 2] / 100));
        this.context.fillRect(x - 0.75, y - 0.75, 1.5, 1.5);
      }
    }
    this.context.globalAlpha = 1;
  }

  draw_robot() {
    const robot = /** @type {import("./messages.js").Robot | undefined} */ (this.bus.data("robot"));
    const pose = this.pose();
    const fresh = this.bus.is_fresh("robot", STALE_S.robot);
    const tracks = fresh && robot?.state === "TRACKING";
    const z = pose ? pose[2] : 0;
    if (robot?.state === "AMBIGUOUS")
      for (const mode of robot.modes) {
        const colour = css(fresh ? "doubt" : "stale");
        const ghost = [mode.pose[0], mode.pose[1], z, mode.pose[2]];
        this.body(ghost, colour, 0.35 + 0.6 * mode.probability);
        this.ellipse(ghost, mode.covariance, colour);
        this.label(`${(100 * mode.probability).toFixed(0)} %`, placed(ghost)(0, 0, 0.8));
      }
    if (!pose) return;
    if (tracks && this.layers.has("obstacles")) this.draw_obstacles(pose);
    const covariance = this.bus.data("sigma")?.covariance;
    if (tracks && covariance) this.ellipse(pose, covariance, css("good"));
    this.body(pose, css(tracks ? "good" : "stale"), tracks ? 0.9 : 0.2);
  }

  /** Robots of the fleet that have a place in this map. */
  draw_others() {
    for (const { topic, data } of this.bus.with_prefix("other/").filter((told) => told.data.pose)) {
      const tracks = this.bus.is_fresh(topic, STALE_S.pose) && data.state === "TRACKING";
      this.body(data.pose, css(tracks ? "accent" : "stale"), tracks ? 0.9 : 0.4);
      this.label(topic.slice("other/".length), placed(data.pose)(0, 0, 0.8));
    }
  }

  /**
   * @param {number[]} pose
   * @param {string} colour
   * @param {number} alpha
   */
  body(pose, colour, alpha) {
    const { context } = this;
    const at = placed(pose);
    const m = Math.max(1, 14 / this.camera.scale / 0.4); // at least 14 pixels long
    this.trace([at(0.42 * m, 0, 0.1), at(-0.28 * m, 0.27 * m, 0.1), at(-0.16 * m, 0, 0.1), at(-0.28 * m, -0.27 * m, 0.1)]);
    context.closePath();
    context.globalAlpha = alpha;
    context.fillStyle = colour;
    context.fill();
    context.globalAlpha = 1;
    context.lineWidth = 1.5;
    context.strokeStyle = css("back");
    context.stroke();
  }

  /**
   * Two standard deviations of the position.
   * @param {number[]} pose
   * @param {number[]} covariance of x, y, yaw in map
   * @param {string} colour
   */
  ellipse(pose, covariance, colour) {
    const [xx, xy, yy] = [covariance[0], covariance[1], covariance[4]];
    const middle = (xx + yy) / 2;
    const spread = Math.hypot((xx - yy) / 2, xy);
    const turn = Math.atan2(2 * xy, xx - yy) / 2;
    const [a, b] = [2 * Math.sqrt(Math.max(0, middle + spread)), 2 * Math.sqrt(Math.max(0, middle - spread))];
    const at = placed([pose[0], pose[1], pose[2], turn]);
    this.trace(Array.from({ length: 33 }, (_, i) => at(a * Math.cos((i * Math.PI) / 16), b * Math.sin((i * Math.PI) / 16))));
    this.context.strokeStyle = colour;
    this.context.lineWidth = 1.5;
    this.context.stroke();
  }

  /** @param {number[]} pose */
  draw_obstacles(pose) {
    const seen = /** @type {import("./messages.js").Obstacles | undefined} */ (this.bus.data("obstacles"));
    if (!seen || !this.bus.is_fresh("obstacles", STALE_S.obstacles)) return;
    const at = placed(pose);
    seen.nearest_cm.forEach((row, type) => {
      this.context.beginPath();
      row.forEach((cm, i) => {
        if (cm < 0) return;
        const edge = (/** @type {number} */ share) => {
          const bearing = seen.rad0 + (i + share) * seen.radstep;
          return this.camera.project(at((cm / 100) * Math.cos(bearing), (cm / 100) * Math.sin(bearing), 0.1));
        };
        this.context.moveTo(...edge(-0.5));
        this.context.lineTo(...edge(0.5));
      });
      this.context.strokeStyle = css(OBSTACLE_COLOURS[type] ?? "bad");
      this.context.lineWidth = 2.5;
      this.context.stroke();
    });
    for (const [x, y, vx, vy] of seen.moving) {
      this.ring(at(x, y), 9, css("bad"));
      this.trace([at(x, y), at(x + vx, y + vy)]);
      this.context.stroke();
    }
  }

  draw_aim() {
    if (!this.aim) return;
    const { from, to, kind } = this.aim;
    this.context.strokeStyle = css("accent");
    this.context.lineWidth = 2;
    const corners = /** @type {Point[]} */ ([from, [to[0], from[1], from[2]], to, [from[0], to[1], from[2]], from]);
    this.trace(kind === "hint" ? [from, to] : corners);
    this.context.stroke();
    if (kind === "hint") this.body([...from, Math.atan2(to[1] - from[1], to[0] - from[0])], css("accent"), 0.8);
  }

  draw_scale() {
    const { context, camera } = this;
    const most_m = 130 / camera.scale;
    const unit = 10 ** Math.floor(Math.log10(most_m));
    const length_m = unit * ([5, 2].find((times) => times * unit <= most_m) ?? 1);
    const [x, y] = [16, camera.height - (innerWidth > 760 ? 20 : 66)];
    if (!document.getElementById("timebar")?.hidden) return;
    context.fillStyle = css("dim");
    context.fillRect(x, y, length_m * camera.scale, 2);
    context.fillText(`${length_m} m`, x, y - 5);
  }

  /**
   * @param {Point} at
   * @param {number} radius pixels
   * @param {string} colour
   */
  ring(at, radius, colour) {
    this.context.beginPath();
    this.context.arc(...this.camera.project(at), radius, 0, 7);
    this.context.strokeStyle = colour;
    this.context.lineWidth = 2;
    this.context.stroke();
  }

  /**
   * @param {string} text
   * @param {Point} at
   */
  label(text, at) {
    const [x, y] = this.camera.project(at);
    this.context.lineWidth = 3;
    this.context.strokeStyle = css("back");
    this.context.strokeText(text, x + 6, y - 6);
    this.context.fillStyle = css("ink");
    this.context.fillText(text, x + 6, y - 6);
  }
}
