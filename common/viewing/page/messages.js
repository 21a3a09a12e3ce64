// What the server sends, as the types that tsc checks. A frame is the length of a JSON text (uint32), the text
// {"topic", "age_ms", "data"}, and bytes whose form the topic says.

/** @typedef {{topic: string, age_ms: number, data: any, bytes: ArrayBuffer, heard_ms: number}} Told */
/** @typedef {{pose: [number, number, number], covariance: number[], probability: number, overlap: number}} Mode */
/**
 * @typedef {{utime_us: number, state: "TRACKING" | "AMBIGUOUS" | "LOST", for_s: number, why: string, confidence: number,
 *   elapsed_ms: number, modes: Mode[]}} Robot
 */
/** @typedef {{utime_us: number, position: [number, number, number], yaw: number}} Pose */
/** @typedef {{utime_us: number, covariance: number[]}} Sigma */
/** @typedef {{utime_us: number, state: string, pose: [number, number, number, number] | null}} Other */
/** @typedef {{service: string, state: "OK" | "WARNING" | "ERROR", message: string, p99_ms: number, pid: number}} Service */
/** @typedef {{epoch: number, level: number, edge_m: number, left: [number, number]}} Blocks */
/** @typedef {{id: number, kind: string, lowest: number[], highest: number[], placed: number[]}} Edit */
/**
 * @typedef {{utime_us: number, blind: string, rad0: number, radstep: number, nearest_cm: number[][], ground_cm: number[],
 *   moving: number[][]}} Obstacles
 */
/** @typedef {{utime_us: number, pose: [number, number, number, number]}} Placed */
/** @typedef {[number, number, number]} Point */

/**
 * Reads one frame.
 * @param {ArrayBuffer} buffer
 * @returns {Told}
 */
export function read_frame(buffer) {
  const length = new DataView(buffer).getUint32(0, true);
  const told = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
  return { ...told, bytes: buffer.slice(4 + length), heard_ms: 0 };
}

/**
 * An age for people.
 * @param {number} s
 */
export function age_text(s) {
  if (!isFinite(s)) return "never";
  if (s < 10) return `${s.toFixed(1)} s`;
  if (s < 120) return `${s.toFixed(0)} s`;
  return s < 7200 ? `${(s / 60).toFixed(0)} min` : `${(s / 3600).toFixed(0)} h`;
}
