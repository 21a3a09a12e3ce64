// Floor plans for planners, one for each kind of robot, as images.
import { css } from "./palette.js";

/** @typedef {{xy0: [number, number], cell_m: number, size: [number, number], compressed: boolean}} GridInfo */
/** @typedef {{xy0: [number, number], cell_m: number, image: HTMLCanvasElement}} Grid */

const COLOURS = ["", "good", "bad", "doubt", "accent"]; // by cell: unknown, free, obstacle, overhang, negative

export class Grids {
  constructor() {
    /** @type {Map<string, Grid>} by topic, "grid/" and the robot's name */
    this.grids = new Map();
  }

  /** @param {import("./messages.js").Told} told */
  async take(told) {
    const info = /** @type {GridInfo} */ (told.data);
    let bytes = told.bytes;
    if (info.compressed) {
      const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
      bytes = await new Response(stream).arrayBuffer();
    }
    const image = document.createElement("canvas");
    [image.width, image.height] = info.size;
    const context = /** @type {CanvasRenderingContext2D} */ (image.getContext("2d"));
    const pixels = context.createImageData(...info.size);
    const colours = COLOURS.map((name) => (name ? parseInt(css(name).slice(1), 16) : -1));
    new Uint8Array(bytes).forEach((cell, i) => {
      const colour = colours[cell] ?? -1;
      if (colour >= 0 && 4 * i < pixels.data.length) pixels.data.set([colour >> 16, (colour >> 8) & 255, colour & 255, cell === 1 ? 90 : 220], 4 * i);
    });
    context.putImageData(pixels, 0, 0);
    this.grids.set(told.topic, { xy0: info.xy0, cell_m: info.cell_m, image });
  }

  /** @param {Set<string>} layers */
  shown(layers) {
    return [...this.grids].filter(([topic]) => layers.has(topic)).map(([, grid]) => grid);
  }
}
