// Free and occupied space between two heights: what is occupied stands there, and where nothing of a column is, the lowest
// free cell lies like a carpet. What is neither is unknown, and left blank.
import { MapLevel } from "./map_store.js";
import { SHADES } from "./palette.js";

/** @typedef {import("./map_store.js").Chunk} Chunk */
/** @typedef {import("./splat.js").Look} Look */

const HALF = SHADES / 2; // colours of free cells, then as many of occupied ones, each from the lowest to the highest
const scratch = new Uint32Array(64 * 64 * 64);

/**
 * Half a layer of a column of blocks: 8 x 4 cells.
 * @param {Chunk | undefined} chunk
 * @param {number} column
 * @param {number} z
 * @param {number} half
 */
const cells_at = (chunk, column, z, half) => chunk?.blocks.get(column | ((z >> 3) << 6))?.bits[2 * (z & 7) + half] ?? 0;

export class Space {
  epoch = -1;
  heights = "";
  told = [new MapLevel(), new MapLevel()]; // free, occupied
  shown = new MapLevel();

  /** @param {number} epoch */
  start_over(epoch) {
    [this.epoch, this.told, this.shown] = [epoch, [new MapLevel(), new MapLevel()], new MapLevel()];
  }

  /**
   * @param {import("./messages.js").Blocks} blocks
   * @param {ArrayBuffer} bytes
   */
  take(blocks, bytes) {
    if (blocks.epoch !== this.epoch) this.start_over(blocks.epoch);
    for (const level of [this.shown, ...this.told]) level.edge_m = blocks.edge_m;
    this.told[blocks.level].take(bytes);
  }

  /**
   * Makes what has changed, or all of it where other heights are looked at.
   * @param {number} until_ms
   * @param {Look} look
   * @returns {boolean} whether any was made
   */
  refresh(until_ms, look) {
    const heights = `${look.low} ${look.high}`;
    if (heights !== this.heights) for (const level of this.told) level.age_all();
    this.heights = heights;
    let made = false;
    for (const [key, { at, stale }] of this.told.flatMap((level) => [...level.chunks])) {
      const both = this.told.map((level) => level.chunks.get(key));
      if (!stale || !both.some((told) => told?.stale)) continue;
      if (made && performance.now() > until_ms) return true;
      const chunk = this.shown.chunk_of(at[0] / 64, at[1] / 64, at[2] / 64);
      chunk.vertices = vertices_of(at[2], this.shown.edge_m, look, both);
      ++chunk.version;
      for (const told of both) if (told) told.stale = false;
      made = true;
    }
    return made;
  }
}

/**
 * @param {number} base the chunk's lowest cell
 * @param {number} edge_m
 * @param {Look} look
 * @param {(Chunk | undefined)[]} told
 */
function vertices_of(base, edge_m, { low, high }, [free, occupied]) {
  const from = Math.max(0, Math.ceil(low / edge_m - base - 0.5));
  const to = Math.min(63, Math.floor(high / edge_m - base - 0.5));
  let count = 0;
  for (let part = 0; part < 128; ++part) {
    const [column, half] = [part >> 1, part & 1];
    const corner = ((column & 7) << 3) | ((column >> 3) << 11) | (half << 10);
    let taken = 0;
    for (const [chunk, first] of /** @type {[Chunk | undefined, number][]} */ ([[occupied, HALF], [free, 0]]))
      for (let z = from; z <= to; ++z) {
        const cells = cells_at(chunk, column, z, half) & (first ? -1 : ~taken);
        const above = first && z < to ? cells_at(chunk, column, z + 1, half) : 0;
        const colour = first + Math.floor(((HALF - 1) * ((base + z + 0.5) * edge_m - low)) / (high - low));
        taken |= cells;
        for (let left = cells; left !== 0; left &= left - 1) {
          const bit = 31 - Math.clz32(left & -left);
          const shade = ((above >>> bit) & 1) | (colour << 2);
          scratch[count++] = corner + ((bit & 7) | ((bit >> 3) << 8) | (z << 16)) + shade * (1 << 24);
        }
      }
  }
  return scratch.slice(0, count);
}
