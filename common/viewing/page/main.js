// The page: what the server tells is drawn, what the operator does is sent.
import { Camera, steer } from "./camera.js";
import { Commands } from "./commands.js";
import { Connection } from "./connection.js";
import { Grids } from "./grids.js";
import { MapStore } from "./map_store.js";
import { Overlay } from "./overlay.js";
import { on_theme } from "./palette.js";
import { element, show_map, show_services, show_state, toast } from "./panels.js";
import { Space } from "./space.js";
import { Timebar } from "./timebar.js";
import { SplatRenderer } from "./splat.js";
import { WebglRenderer } from "./webgl.js";

// More voxels than this are drawn coarsely, so that a frame stays short.
const MOST_VOXELS = { splat: 1_500_000, webgl: 12_000_000 };
const AGE_PERIOD_MS = 5000;

const forced = new URLSearchParams(location.search).get("renderer");
const canvas = /** @type {HTMLCanvasElement} */ (element("voxels"));
const renderer = (forced !== "splat" && WebglRenderer.make(canvas, forced === "webgl")) || new SplatRenderer(canvas);
const look = { low: -0.5, high: 2.2, colour: "height" };
const layers = new Set(["path", "cloud", "obstacles"]);
const camera = new Camera();
const map = new MapStore();
const space = new Space();
const grids = new Grids();
let dirty = true, follows = false, fits = true, aged_ms = 0;

const bus = new Connection((told) => {
  dirty = true;
  if (told.topic === "blocks") map.take(told.data, told.bytes);
  else if (told.topic === "space") space.take(told.data, told.bytes);
  else if (told.topic === "map" && told.data.epoch !== map.epoch) map.start_over(told.data.epoch);
  else if (told.topic === "hello" || told.topic === "rewound") start_session();
  else if (told.topic === "clock") bus.run_at(told.data.speed);
  else if (told.topic === "path") drop_path_before(told.data.first);
  else if (told.topic === "loop") note_loop(told);
  else if (told.topic.startsWith("grid/")) grids.take(told).then(() => (dirty = true));
});
const overlay = new Overlay(/** @type {HTMLCanvasElement} */ (element("overlay")), camera, bus, grids, layers);
const commands = new Commands(bus, overlay, camera, look);
const timebar = new Timebar(bus, commands);

// The server is another one, or was left for a while: it tells all of it again.
function start_session() {
  map.start_over(-1);
  wish_space();
  for (const prefix of ["path/", "slice/", "grid/", "robot", "pose", "sigma", "cloud", "edits", "service/", "other/"]) bus.forget(prefix);
  overlay.loops = [];
}

/** Free and occupied space is sent to who looks at it. */
function wish_space() {
  space.start_over(-1);
  bus.say(look.colour === "space" ? "space on" : "space off");
}

/** @param {number} first the first piece of the path that counts */
function drop_path_before(first) {
  for (const { topic } of bus.with_prefix("path/")) if (Number(topic.slice("path/".length)) < first) bus.topics.delete(topic);
}

/** @param {import("./messages.js").Told} told */
function note_loop(told) {
  overlay.loops.push(told.data.at);
  if (told.age_ms < 2000) toast(`A loop was closed: the newest keyframe moved ${Math.hypot(...told.data.moved.slice(0, 2)).toFixed(2)} m.`);
}

function resize() {
  [camera.width, camera.height] = [innerWidth, innerHeight];
  renderer.resize(innerWidth, innerHeight);
  overlay.resize(innerWidth, innerHeight, devicePixelRatio);
  dirty = true;
}

function fit() {
  const level = map.shown(Infinity);
  if (level.chunks.size === 0) return;
  camera.fit(...level.box(), innerWidth > 760 ? 1 - 300 / innerWidth : 1);
  fits = dirty = true;
}

/** @type {Record<string, () => void>} */
const keys = {
  t: () => ((camera.tilt_rad = Math.PI / 2), camera.change()),
  f: () => follow(!follows),
  0: fit,
  h: () => commands.aim_at("hint"),
  escape: () => commands.aim_at(""),
  q: () => camera.orbit(40, 0),
  e: () => camera.orbit(-40, 0),
  "+": () => ((fits = false), camera.zoom(1.25)),
  "-": () => ((fits = false), camera.zoom(0.8)),
  arrowleft: () => move(60, 0),
  arrowright: () => move(-60, 0),
  arrowup: () => move(0, 60),
  arrowdown: () => move(0, -60),
};

/** @param {number} dx @param {number} dy */
const move = (dx, dy) => (moved(true), camera.pan(dx, dy));

/** The operator looks elsewhere. @param {boolean} pans */
function moved(pans) {
  fits = false;
  if (pans) follow(false);
  dirty = true;
}

/** @param {boolean} on */
function follow(on) {
  follows = on;
  fits &&= !on;
  element("follow").setAttribute("aria-pressed", String(on));
}

/** @param {string} key */
function press(key) {
  const act = keys[key.toLowerCase()];
  if (!act) return false;
  act();
  return (dirty = true);
}

function wire() {
  addEventListener("resize", resize);
  addEventListener("keydown", (event) => {
    if (event.target instanceof HTMLInputElement || event.target instanceof HTMLSelectElement || event.ctrlKey || event.metaKey) return;
    if (press(event.key)) event.preventDefault();
  });
  for (const button of document.querySelectorAll("[data-key]"))
    button.addEventListener("click", () => press(/** @type {HTMLElement} */ (button).dataset.key ?? ""));
  element("menu").onclick = () => element("menu").setAttribute("aria-expanded", String(element("side").classList.toggle("open")));
  const colour = /** @type {HTMLSelectElement} */ (element("colour"));
  const restyle = () => (renderer.set_theme((look.colour = colour.value)), (dirty = true));
  colour.onchange = () => (restyle(), wish_space(), raise_low());
  on_theme(restyle);
  for (const name of /** @type {const} */ (["low", "high"])) {
    const slider = /** @type {HTMLInputElement} */ (element(name));
    slider.oninput = () => {
      look[name] = Number(slider.value);
      element(`${name}-out`).textContent = `${look[name].toFixed(1)} m`;
      dirty = true;
    };
    slider.dispatchEvent(new Event("input"));
  }
  steer(overlay.canvas, camera, {
    drag: (event, phase) => (dirty = true) && commands.drag(event, phase),
    moved,
  });
}

/** With the floor in the slice nothing would be free. */
function raise_low() {
  if (look.colour !== "space") return;
  const slider = /** @type {HTMLInputElement} */ (element("low"));
  slider.value = String(Math.max(Number(slider.value), (overlay.pose()?.[2] ?? 0) + 0.2));
  slider.dispatchEvent(new Event("input"));
}

/** A button for each layer that there is. */
function show_layers() {
  const names = ["path", "cloud", "obstacles", ...grids.grids.keys()];
  const box = element("layers");
  for (const name of names.slice(box.childElementCount)) {
    const button = Object.assign(document.createElement("button"), { textContent: name.replace("grid/", "grid ") });
    button.setAttribute("aria-pressed", String(layers.has(name)));
    button.onclick = () => {
      if (!layers.delete(name)) layers.add(name);
      button.setAttribute("aria-pressed", String(layers.has(name)));
      dirty = true;
    };
    box.append(button);
  }
}

function show_panels() {
  show_state(bus);
  show_services(bus);
  show_map(bus, map, renderer.name);
  show_layers();
  commands.show();
  timebar.show();
  document.body.classList.toggle("stale", !bus.alive);
  dirty = true; // ages have grown
}

const stats = { frames: 0, draw_ms: 0, renderer: renderer.name };

function draw() {
  requestAnimationFrame(draw);
  const now_s = Math.max(0, (bus.data("map")?.utime_us ?? 0) / 1e6);
  const until_ms = performance.now() + 8;
  for (const level of map.levels) if (level.refresh(until_ms, now_s)) dirty = true;
  if (look.colour === "space" && space.refresh(until_ms, look)) dirty = true;
  if (look.colour === "age" && performance.now() - aged_ms > AGE_PERIOD_MS) {
    aged_ms = performance.now();
    map.levels[0].age_all();
  }
  if (fits && dirty) fit(); // the map grows; until an operator looks elsewhere
  const pose = overlay.pose();
  if (follows && pose) camera.target = [pose[0], pose[1], camera.target[2]];
  if (!dirty) return;
  dirty = false;
  const began_ms = performance.now();
  const fine_enough = map.shown(MOST_VOXELS[/** @type {"splat" | "webgl"} */ (renderer.name)]);
  renderer.draw(look.colour === "space" ? space.shown : fine_enough, camera, look);
  stats.draw_ms = performance.now() - began_ms;
  overlay.draw();
  ++stats.frames;
}

wire();
resize();
setInterval(show_panels, 200);
draw();

// For tests and for the curious.
Object.assign(window, { voxlist: { bus, map, space, camera, overlay, renderer, stats, look } });
