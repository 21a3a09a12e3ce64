// The map's voxels as vertices. Blocks of 8 x 8 x 8 voxels lie in chunks of 8 x 8 x 8 blocks, which renderers draw.

const CHUNK = 64; // voxels along a chunk's edge

/** @typedef {{bits: Uint32Array, changed_s: number}} Block */
/**
 * One vertex is x | y << 8 | z << 16 | shade << 24 (voxels within the chunk). Shade: bit 0 is set where the voxel above
 * is occupied too, the rest is the age, 0 to 127.
 * @typedef {{at: [number, number, number], blocks: Map<number, Block>, vertices: Uint32Array, version: number,
 *   stale: boolean}} Chunk
 */

export class MapLevel {
  /** @type {Map<number, Chunk>} */
  chunks = new Map();
  edge_m = 0.05;
  voxels = 0;

  /**
   * Takes records of blocks (block_records.h).
   * @param {ArrayBuffer} bytes
   */
  take(bytes) {
    const shorts = new Int16Array(bytes, 0, bytes.byteLength >> 1);
    const words = new Uint32Array(bytes, 0, bytes.byteLength >> 2);
    for (let word = 0; word < words.length; ) {
      const bits = new Uint32Array(16);
      const layers = words[word + 1] >>> 16;
      const at = [shorts[2 * word], shorts[2 * word + 1], shorts[2 * word + 2]];
      const changed_s = words[word + 2];
      word += 3;
      for (let z = 0; z < 8; ++z) {
        if (!((layers >> z) & 1)) continue;
        bits[2 * z] = words[word++];
        bits[2 * z + 1] = words[word++];
      }
      this.put(at, { bits, changed_s });
    }
  }

  /**
   * @param {number[]} at
   * @param {Block} block
   */
  put([x, y, z], block) {
    const chunk = this.chunk_of(x >> 3, y >> 3, z >> 3);
    chunk.blocks.set((x & 7) | ((y & 7) << 3) | ((z & 7) << 6), block);
    chunk.stale = true;
  }

  /**
   * @param {number} x
   * @param {number} y
   * @param {number} z
   * @returns {Chunk}
   */
  chunk_of(x, y, z) {
    const key = ((x + 4096) * 8192 + y + 4096) * 8192 + z + 4096;
    let chunk = this.chunks.get(key);
    if (!chunk) {
      chunk = { at: [x * CHUNK, y * CHUNK, z * CHUNK], blocks: new Map(), vertices: new Uint32Array(0), version: 0, stale: true };
      this.chunks.set(key, chunk);
    }
    return chunk;
  }

  /**
   * Makes vertices of chunks that have changed, until the time is over.
   * @param {number} until_ms
   * @param {number} now_s the map's time
   * @returns {boolean} whether any was made
   */
  refresh(until_ms, now_s) {
    let made = false;
    for (const chunk of this.chunks.values()) {
      if (!chunk.stale) continue;
      if (made && performance.now() > until_ms) return true;
      this.voxels -= chunk.vertices.length;
      chunk.vertices = vertices_of(chunk, now_s);
      this.voxels += chunk.vertices.length;
      chunk.stale = false;
      ++chunk.version;
      made = true;
    }
    return made;
  }

  /**
   * The box of its chunks, as two corners (m).
   * @returns {[import("./messages.js").Point, import("./messages.js").Point]}
   */
  box() {
    const corners = [...this.chunks.values()].filter((chunk) => chunk.vertices.length).map((chunk) => chunk.at);
    const along = (/** @type {number} */ axis) => corners.map((at) => at[axis] * this.edge_m);
    const size = CHUNK * this.edge_m;
    const low = [0, 1].map((axis) => Math.min(...along(axis)));
    const high = [0, 1].map((axis) => Math.max(...along(axis)) + size);
    return [[low[0], low[1], 0], [high[0], high[1], 0]];
  }

  age_all() {
    for (const chunk of this.chunks.values()) chunk.stale = true;
  }
}

const scratch = new Uint32Array(CHUNK * CHUNK * CHUNK);

/**
 * @param {Chunk} chunk
 * @param {number} now_s
 */
function vertices_of(chunk, now_s) {
  let count = 0;
  for (const [index, block] of chunk.blocks) {
    const corner = ((index & 7) << 3) | (((index >> 3) & 7) << 11) | ((index >> 6) << 19);
    const age = Math.min(127, Math.round(12 * Math.log2(1 + Math.max(0, now_s - block.changed_s) / 2))) << 25;
    const next = index >> 6 < 7 ? chunk.blocks.get(index + 64) : undefined;
    for (let half = 0; half < 16; ++half) {
      const above = half < 14 ? block.bits[half + 2] : (next?.bits[half - 14] ?? 0);
      for (let left = block.bits[half]; left !== 0; left &= left - 1) {
        const bit = 31 - Math.clz32(left & -left);
        const y = (bit >> 3) + 4 * (half & 1);
        const shade = ((above >>> bit) & 1) << 24;
        scratch[count++] = corner + ((bit & 7) | (y << 8) | ((half >> 1) << 16) | shade | age);
      }
    }
  }
  return scratch.slice(0, count);
}

export class MapStore {
  epoch = 0;
  levels = [new MapLevel(), new MapLevel()];
  is_whole = false;

  /** @param {number} epoch */
  start_over(epoch) {
    [this.epoch, this.levels, this.is_whole] = [epoch, [new MapLevel(), new MapLevel()], false];
  }

  /**
   * @param {import("./messages.js").Blocks} blocks
   * @param {ArrayBuffer} bytes
   */
  take(blocks, bytes) {
    if (blocks.epoch !== this.epoch) this.start_over(blocks.epoch);
    const level = this.levels[blocks.level];
    level.edge_m = blocks.edge_m;
    level.take(bytes);
    if (blocks.left[0] === 0 && blocks.left[1] === 0) this.is_whole = true;
  }

  /**
   * The level to draw: the coarse one until the fine one is whole, and where that has more than `most` voxels.
   * @param {number} most
   */
  shown(most) {
    const [fine, coarse] = this.levels;
    return this.is_whole && (fine.voxels <= most || coarse.voxels === 0) ? fine : coarse;
  }
}
