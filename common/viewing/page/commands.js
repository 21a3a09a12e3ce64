// What the operator asks for. A command is posted with the token that the stream told.
import { element, toast } from "./panels.js";

/** @typedef {import("./messages.js").Point} Point */
/** @typedef {import("./connection.js").Connection} Connection */

const AIMS = /** @type {Record<string, string>} */ ({
  hint: "Click where the robot stands and drag to where it looks. The localiser looks there first; it believes its scans.",
  erase: "Drag over what is to be forgotten, within the heights that are shown.",
  free: "Drag over what is to be kept free.",
  blocked: "Drag over what is to be kept blocked.",
});

export class Commands {
  /**
   * @param {Connection} bus
   * @param {import("./overlay.js").Overlay} overlay
   * @param {import("./camera.js").Camera} camera
   * @param {import("./splat.js").Look} look
   */
  constructor(bus, overlay, camera, look) {
    this.bus = bus;
    this.overlay = overlay;
    this.camera = camera;
    this.look = look;
    this.aiming = "";
    element("hint").onclick = () => this.aim_at("hint");
    element("save").onclick = () => this.send("save", {}, "The mapper saves the map.");
    element("only-on").onclick = () => this.send("localise_only", { on: true }, "The map stays as it is.");
    element("only-off").onclick = () => this.send("localise_only", { on: false }, "The map grows again.");
    element("record").onclick = () => {
      const on = !bus.data("time")?.recording;
      this.send("record", { on }, on ? "It records." : "The recording is whole.");
    };
    for (const button of document.querySelectorAll("[data-mark]"))
      /** @type {HTMLElement} */ (button).onclick = () => this.aim_at(/** @type {HTMLElement} */ (button).dataset.mark ?? "");
  }

  /**
   * @param {string} name
   * @param {object} what
   * @param {string} done what is said then
   */
  async send(name, what, done) {
    const headers = { "Content-Type": "application/json", "X-Voxlist-Token": this.bus.data("hello")?.token ?? "" };
    try {
      const answer = await fetch(`/command/${name}`, { method: "POST", headers, body: JSON.stringify(what) });
      const text = answer.ok ? done : `Not done: ${await answer.text()}`;
      if (text) toast(text);
      return answer.ok;
    } catch {
      toast("Not done: the viewer does not answer.");
      return false;
    }
  }

  /** @param {string} what hint, erase, free, blocked; empty: nothing any more */
  aim_at(what) {
    this.aiming = what === this.aiming ? "" : what;
    this.overlay.aim = undefined;
    this.overlay.canvas.classList.toggle("aiming", this.aiming !== "");
    if (this.aiming) toast(AIMS[this.aiming]);
  }

  /**
   * A gesture on the map; true: it is taken.
   * @param {PointerEvent} event
   * @param {"down" | "move" | "up"} phase
   */
  drag(event, phase) {
    if (!this.aiming) return false;
    const z = this.overlay.pose()?.[2] ?? 0;
    const at = this.camera.point_at(event.clientX, event.clientY, z);
    if (phase === "down") this.overlay.aim = { from: at, to: at, kind: this.aiming };
    if (!this.overlay.aim) return true;
    this.overlay.aim.to = at;
    if (phase === "up") this.finish(this.overlay.aim);
    return true;
  }

  /** @param {{from: Point, to: Point, kind: string}} aim */
  finish({ from, to, kind }) {
    this.aim_at("");
    if (kind === "hint") {
      const length = Math.hypot(to[0] - from[0], to[1] - from[1]);
      const yaw_rad = Math.atan2(to[1] - from[1], to[0] - from[0]);
      const sigma_rad = length * this.camera.scale > 8 ? 0.3 : 1.8; // a click without a drag tells no direction
      this.send("hint", { x_m: from[0], y_m: from[1], yaw_rad, sigma_m: 1, sigma_rad }, "Hinted: where it is lost, it looks there first.");
      return;
    }
    const lowest = [Math.min(from[0], to[0]), Math.min(from[1], to[1]), this.look.low];
    const highest = [Math.max(from[0], to[0]), Math.max(from[1], to[1]), this.look.high];
    this.send("edit", { kind, lowest, highest }, "The mapper edits its map.");
  }

  /** Lists the edits, each with a way back. */
  show() {
    const list = element("edits");
    const edits = /** @type {import("./messages.js").Edit[]} */ (this.bus.data("edits")?.boxes ?? []);
    const text = JSON.stringify(edits.map((edit) => edit.id));
    element("record").setAttribute("aria-pressed", String(Boolean(this.bus.data("time")?.recording)));
    if (list.dataset.shows === text) return;
    list.dataset.shows = text;
    list.replaceChildren(...edits.map((edit) => {
      const item = document.createElement("li");
      const button = Object.assign(document.createElement("button"), { textContent: "take back" });
      button.onclick = () => this.send("remove_edit", { id: edit.id }, "The edit is taken back.");
      item.append(`${edit.kind} ${edit.id}`, button);
      return item;
    }));
  }
}
