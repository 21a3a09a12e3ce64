// The stream from the server: everything that was told last, by topic. It comes back by itself.
import { read_frame } from "./messages.js";

/** @typedef {import("./messages.js").Told} Told */

// Nothing for so long (s): the server is gone, whatever the socket says. It tells the time twice a second.
const SILENCE_S = 1.6;
const RETRY_MS = 400;

export class Connection {
  /** @param {(told: Told) => void} hear */
  constructor(hear) {
    this.hear = hear;
    /** @type {Map<string, Told>} */
    this.topics = new Map();
    // The bus's time goes on with this one's, or as a recording is played; ms since any moment.
    this.speed = 1;
    this.clock = { real_ms: performance.now(), bus_ms: 0 };
    this.bytes = 0;
    this.frames = 0;
    /** @type {WebSocket | undefined} */
    this.socket = undefined;
    this.last_ms = -Infinity;
    this.open();
    setInterval(() => this.watch(), 250);
  }

  open() {
    const socket = new WebSocket(`ws://${location.host}/live`, "voxlist.live.v1");
    socket.binaryType = "arraybuffer";
    socket.onmessage = (event) => this.take(socket, event.data);
    socket.onclose = () => socket === this.socket && setTimeout(() => socket === this.socket && this.open(), RETRY_MS);
    this.socket = socket;
    this.opened_ms = performance.now();
  }

  /**
   * @param {WebSocket} socket
   * @param {ArrayBuffer} buffer
   */
  take(socket, buffer) {
    if (socket !== this.socket) return;
    this.bytes += buffer.byteLength;
    ++this.frames;
    this.last_ms = performance.now();
    const told = { ...read_frame(buffer), heard_ms: this.bus_ms };
    if (told.topic !== "blocks" && told.topic !== "space") this.topics.set(told.topic, told);
    this.hear(told);
  }

  /** What the server is to know of this page; it forgets that when the line breaks. @param {string} text */
  say = (text) => this.socket?.readyState === WebSocket.OPEN && this.socket.send(text);

  // A server that is stopped keeps its socket: another one is tried.
  watch() {
    const since_ms = performance.now() - Math.max(this.last_ms, this.opened_ms ?? 0);
    if (since_ms < 1000 * 2 * SILENCE_S || this.socket?.readyState === WebSocket.CLOSED) return;
    const silent = this.socket;
    this.open();
    silent?.close();
  }

  get bus_ms() {
    return this.clock.bus_ms + this.speed * (performance.now() - this.clock.real_ms);
  }

  /** @param {number} speed of a recording, as times of real time; 0: it stands still */
  run_at(speed) {
    this.clock = { real_ms: performance.now(), bus_ms: this.bus_ms };
    this.speed = speed;
  }

  get alive() {
    return performance.now() - this.last_ms < 1000 * SILENCE_S;
  }

  /** @param {string} topic */
  data(topic) {
    return this.topics.get(topic)?.data;
  }

  /** @param {string} topic */
  age_s(topic) {
    const told = this.topics.get(topic);
    return told ? (told.age_ms + this.bus_ms - told.heard_ms) / 1000 : Infinity;
  }

  /**
   * Whether what a topic says may count as now.
   * @param {string} topic
   * @param {number} most_s
   */
  is_fresh(topic, most_s) {
    return this.alive && this.age_s(topic) < most_s;
  }

  /** @param {string} prefix */
  with_prefix(prefix) {
    return [...this.topics.values()].filter((told) => told.topic.startsWith(prefix));
  }

  /** @param {string} prefix */
  forget(prefix) {
    for (const topic of [...this.topics.keys()]) if (topic.startsWith(prefix)) this.topics.delete(topic);
  }
}
