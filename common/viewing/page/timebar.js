// A recording's time: play, speed, and where something happened in it.
import { css } from "./palette.js";
import { element, toast } from "./panels.js";

/**
 * Times (us) of a recording, and what happened in it.
 * @typedef {{name: string, begin_us: number, end_us: number, lost: [number, number][], loop: number[], warning: number[]}}
 *   Recording
 */

export class Timebar {
  /**
   * @param {import("./connection.js").Connection} bus
   * @param {import("./commands.js").Commands} commands
   */
  constructor(bus, commands) {
    this.bus = bus;
    this.commands = commands;
    this.track = /** @type {HTMLCanvasElement} */ (element("track"));
    this.track.onclick = (event) => this.seek(this.time_at(event.offsetX));
    const speed = /** @type {HTMLSelectElement} */ (element("speed"));
    const play = (/** @type {boolean} */ on) => commands.send("play", { speed: on ? Number(speed.value) : 0 }, "");
    element("play").onclick = () => play(!this.clock?.speed);
    speed.onchange = () => this.clock?.speed && play(true);
    for (const button of document.querySelectorAll("[data-jump]"))
      /** @type {HTMLElement} */ (button).onclick = () => this.jump(/** @type {HTMLElement} */ (button).dataset.jump ?? "");
  }

  /** @returns {Recording | undefined} */
  get recording() {
    return this.bus.data("hello")?.recording;
  }

  /** @returns {{utime_us: number, speed: number} | undefined} */
  get clock() {
    return this.bus.data("clock");
  }

  /** @param {number} utime_us */
  seek(utime_us) {
    this.commands.send("seek", { utime_us: Math.round(utime_us) }, "");
  }

  /**
   * Goes to a second before the next such event; after the last one to the first.
   * @param {string} what
   */
  jump(what) {
    const { recording, clock } = this;
    if (!recording || !clock) return;
    const times = what === "lost" ? recording.lost.map(([from]) => from) : recording[/** @type {"loop" | "warning"} */ (what)];
    const next = times.find((time) => time > clock.utime_us + 1.5e6) ?? times[0];
    if (next === undefined) return toast(`This recording has no ${what === "lost" ? "LOST" : what}.`);
    this.seek(next - 1e6);
  }

  /** @param {number} x pixels */
  time_at(x) {
    const { begin_us, end_us } = this.recording ?? { begin_us: 0, end_us: 0 };
    return begin_us + (x / this.track.clientWidth) * (end_us - begin_us);
  }

  show() {
    const { recording, clock } = this;
    element("timebar").hidden = !recording;
    element("orders").hidden = Boolean(recording);
    if (!recording || !clock) return;
    element("play").textContent = clock.speed ? "\u275a\u275a" : "\u25b6";
    const seconds = (/** @type {number} */ us) => `${(us / 1e6).toFixed(0)} s`;
    element("clock").textContent = `${seconds(clock.utime_us - recording.begin_us)} of ${seconds(recording.end_us - recording.begin_us)}`;
    this.draw(recording, clock.utime_us);
  }

  /**
   * @param {Recording} recording
   * @param {number} now_us
   */
  draw(recording, now_us) {
    const [width, height] = [this.track.clientWidth, this.track.clientHeight];
    [this.track.width, this.track.height] = [width, height];
    const context = /** @type {CanvasRenderingContext2D} */ (this.track.getContext("2d"));
    const x = (/** @type {number} */ us) => ((us - recording.begin_us) / Math.max(1, recording.end_us - recording.begin_us)) * width;
    const mark = (/** @type {string} */ colour, /** @type {number} */ from, /** @type {number} */ to, top = 8, size = 14) => {
      context.fillStyle = css(colour);
      context.fillRect(x(from), top, Math.max(2, x(to) - x(from)), size);
    };
    mark("line", recording.begin_us, recording.end_us, 13, 4);
    mark("accent", recording.begin_us, now_us, 13, 4);
    for (const [from, to] of recording.lost) mark("bad", from, to);
    for (const time of recording.loop) mark("good", time, time);
    for (const time of recording.warning) mark("doubt", time, time, 20, 8);
    mark("ink", now_us, now_us, 4, 22);
  }
}
