// The renderer for machines without a GPU: squares into an image, nearest first by a depth buffer. The projection is
// parallel, so a vertex costs three look-ups an axis and no multiplication.
import { background, is_by_vertex, palette, SHADES } from "./palette.js";

/** @typedef {import("./map_store.js").MapLevel} MapLevel */
/** @typedef {import("./camera.js").Camera} Camera */
/** @typedef {{low: number, high: number, colour: string}} Look heights (m) that are drawn, and by what they are coloured */

const FRACTION = 8; // bits of a pixel behind the point

export class SplatRenderer {
  name = "splat";
  image = new ImageData(1, 1);
  /** @type {Uint32Array<ArrayBufferLike>} */ pixels = new Uint32Array(1);
  depths = new Int32Array(1);
  /** @type {Uint32Array<ArrayBufferLike>} */ colours = new Uint32Array(0);
  background = 0;
  axes = [0, 1, 2].map(() => ({ x: new Int32Array(64), y: new Int32Array(64), depth: new Int32Array(64) }));
  shade_of_height = new Int32Array(64);

  /** @param {HTMLCanvasElement} canvas */
  constructor(canvas) {
    this.canvas = canvas;
    this.context = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d", { alpha: false }));
    this.set_theme("height");
  }

  /** @param {string} colour */
  set_theme(colour) {
    this.colours = palette(colour);
    this.background = background();
  }

  /**
   * @param {number} width
   * @param {number} height
   */
  resize(width, height) {
    [this.canvas.width, this.canvas.height] = [width, height];
    this.image = this.context.createImageData(width, height);
    this.pixels = new Uint32Array(this.image.data.buffer);
    this.depths = new Int32Array(width * height);
  }

  /**
   * @param {MapLevel} level
   * @param {Camera} camera
   * @param {Look} look
   */
  draw(level, camera, look) {
    this.pixels.fill(this.background);
    this.depths.fill(0x7fffffff);
    const size = Math.max(1, Math.ceil(level.edge_m * camera.scale * 1.2));
    for (const chunk of level.chunks.values()) if (this.prepare(chunk.at, level.edge_m, camera, look, size)) this.splat(chunk.vertices, size, look);
    this.context.putImageData(this.image, 0, 0);
  }

  /**
   * Fills the tables for a chunk. False: none of it is seen.
   * @param {[number, number, number]} at
   * @param {number} edge_m
   * @param {Camera} camera
   * @param {Look} look
   * @param {number} size
   */
  prepare(at, edge_m, camera, look, size) {
    const low_m = at[2] * edge_m;
    if (low_m > look.high || low_m + 64 * edge_m < look.low) return false;
    const corner = at.map((v) => v * edge_m);
    const radius = 64 * edge_m * camera.scale * 0.9;
    const [sx, sy] = camera.project(corner.map((v) => v + 32 * edge_m));
    if (sx < -radius || sy < -radius || sx > camera.width + radius || sy > camera.height + radius) return false;
    const [x0, y0] = camera.project(corner.map((v) => v + edge_m / 2));
    const unit = camera.scale * (1 << FRACTION);
    const depth0 = corner.reduce((sum, v, axis) => sum + (v - camera.target[axis]) * camera.into[axis], 0);
    this.axes.forEach((table, axis) => {
      for (let i = 0; i < 64; ++i) {
        table.x[i] = Math.round(i * edge_m * camera.right[axis] * unit + (axis ? 0 : (x0 - size / 2) * (1 << FRACTION)));
        table.y[i] = Math.round(-i * edge_m * camera.up[axis] * unit + (axis ? 0 : (y0 - size / 2) * (1 << FRACTION)));
        table.depth[i] = Math.round(1000 * (i * edge_m * camera.into[axis] + (axis ? 0 : depth0)));
      }
    });
    for (let z = 0; z < 64; ++z) {
      const share = (low_m + (z + 0.5) * edge_m - look.low) / (look.high - look.low);
      this.shade_of_height[z] = share < 0 || share > 1 ? -1 : Math.min(SHADES - 1, Math.floor(SHADES * share));
    }
    return true;
  }

  /**
   * @param {Uint32Array} vertices
   * @param {number} size
   * @param {Look} look
   */
  splat(vertices, size, look) {
    const [ax, ay, az] = this.axes;
    const [xx, xy, xz, yx, yy, yz, dx, dy, dz] = [ax.x, ay.x, az.x, ax.y, ay.y, az.y, ax.depth, ay.depth, az.depth];
    const { pixels, depths, shade_of_height, colours } = this;
    const width = this.canvas.width;
    const most_left = width - size;
    const most_top = this.canvas.height - size;
    const by_vertex = is_by_vertex(look);
    for (let i = 0; i < vertices.length; ++i) {
      const v = vertices[i];
      const x = v & 63;
      const y = (v >> 8) & 63;
      const z = (v >> 16) & 63;
      const height_shade = shade_of_height[z];
      if (height_shade < 0) continue;
      const left = (xx[x] + xy[y] + xz[z]) >> FRACTION;
      const top = (yx[x] + yy[y] + yz[z]) >> FRACTION;
      if (left < 0 || top < 0 || left > most_left || top > most_top) continue;
      const depth = dx[x] + dy[y] + dz[z];
      const colour = colours[(by_vertex ? v >>> 26 : height_shade) + ((v >> 24) & 1) * SHADES];
      for (let row = top * width + left, end = row + size * width; row < end; row += width)
        for (let at = row; at < row + size; ++at)
          if (depth < depths[at]) {
            depths[at] = depth;
            pixels[at] = colour;
          }
    }
  }
}
