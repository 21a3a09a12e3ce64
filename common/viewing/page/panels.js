// What is written beside the map: the robot's state, the services, the map's numbers.
import { age_text } from "./messages.js";
import { STALE_S } from "./overlay.js";

/** @typedef {import("./connection.js").Connection} Connection */
/** @typedef {import("./messages.js").Robot} Robot */

/** @param {string} id */
export const element = (id) => /** @type {HTMLElement} */ (document.getElementById(id));

/**
 * Writes a text where it is another one.
 * @param {HTMLElement} at
 * @param {string} text
 */
function write(at, text) {
  if (at.textContent !== text) at.textContent = text;
}

/** @param {Connection} bus */
export function show_state(bus) {
  const robot = /** @type {Robot | undefined} */ (bus.data("robot"));
  const age = bus.age_s("robot");
  const fresh = bus.is_fresh("robot", STALE_S.robot);
  element("status").dataset.state = robot && fresh ? robot.state : "none";
  if (!bus.alive) return tell("NO CONNECTION", "the viewer does not answer; it is tried again", was(robot, age));
  if (!robot) return tell("WAITING", "no word of a robot yet", "");
  if (!fresh) return tell("NO WORD", `for ${age_text(age)}`, was(robot, age));
  const long = age_text(robot.for_s + age);
  if (robot.state === "LOST") return tell("LOST", `for ${long}`, robot.why);
  const first = robot.modes[0];
  if (robot.state === "AMBIGUOUS" || !first) return tell("AMBIGUOUS", `${robot.modes.length} candidates, for ${long}`, candidates(robot));
  const sigma = bus.data("sigma")?.covariance ?? first.covariance;
  const pose = bus.data("pose");
  const [x, y, yaw] = pose ? [pose.position[0], pose.position[1], pose.yaw] : first.pose;
  tell("TRACKING", `x ${x.toFixed(2)}  y ${y.toFixed(2)} m  ${((yaw * 180) / Math.PI).toFixed(0)}°`,
    `1σ ${Math.sqrt(Math.max(sigma[0], sigma[4])).toFixed(3)} m, ${((Math.sqrt(sigma[8]) * 180) / Math.PI).toFixed(2)}°; ` +
      `sure to ${(100 * robot.confidence).toFixed(1)} %; ${age_text(age)} ago`);
}

/**
 * @param {Robot | undefined} robot
 * @param {number} age
 */
const was = (robot, age) => (robot ? `it was ${robot.state} ${age_text(age)} ago` : "");

/** @param {Robot} robot */
const candidates = (robot) => robot.modes.slice(0, 4).map((mode) =>
  `${(100 * mode.probability).toFixed(0)} % at ${mode.pose[0].toFixed(1)}, ${mode.pose[1].toFixed(1)}`).join("; ");

/**
 * @param {string} state
 * @param {string} line
 * @param {string} more
 */
function tell(state, line, more) {
  write(element("state"), state);
  write(element("state-line"), line);
  write(element("state-more"), more);
}

/** @param {Connection} bus */
export function show_services(bus) {
  const body = /** @type {HTMLTableSectionElement} */ (element("services").firstElementChild);
  for (const row of body.rows) row.toggleAttribute("data-stale", !bus.topics.has(`service/${row.dataset.service}`));
  for (const told of bus.with_prefix("service/")) {
    const service = /** @type {import("./messages.js").Service} */ (told.data);
    const row = row_of(body, service.service);
    const age = bus.age_s(told.topic);
    row.dataset.state = service.state;
    row.toggleAttribute("data-stale", !bus.is_fresh(told.topic, STALE_S.service));
    const [, name, p99, since] = row.cells;
    write(/** @type {HTMLElement} */ (name.lastElementChild), service.message);
    write(p99, service.p99_ms >= 0 ? `${service.p99_ms.toFixed(service.p99_ms < 10 ? 1 : 0)} ms` : "");
    write(since, age_text(age));
  }
}

/**
 * The row of a service; made where there is none.
 * @param {HTMLTableSectionElement} body
 * @param {string} name
 */
function row_of(body, name) {
  const found = [...body.rows].find((row) => row.dataset.service === name);
  if (found) return found;
  const row = body.insertRow([...body.rows].filter((other) => (other.dataset.service ?? "") < name).length);
  row.dataset.service = name;
  row.insertCell().className = "dot";
  const cell = row.insertCell();
  cell.textContent = name;
  cell.append(Object.assign(document.createElement("span"), { className: "why" }));
  for (const title of ["99 % of messages are done within", "since its last word"])
    Object.assign(row.insertCell(), { className: "number", title });
  return row;
}

/**
 * @param {Connection} bus
 * @param {import("./map_store.js").MapStore} map
 * @param {string} renderer
 */
export function show_map(bus, map, renderer) {
  const told = bus.data("map");
  if (!told?.version) return write(element("map-line"), "no map yet");
  const drawn = map.levels[0].voxels || map.levels[1].voxels;
  write(element("map-line"), `map ${told.keyframes} keyframes, ${drawn.toLocaleString("en")} voxels of ${told.edge_m.toFixed(2)} m, ` +
      `${told.moves} loops, ${told.edits} edits; changed ${age_text(bus.age_s("map"))} ago; ` +
      (bus.data("octomap") ? `OctoMap of ${bus.data("octomap").keyframes} keyframes; ` : "") + renderer);
}

let toast_timer = 0;

/**
 * Says something for a moment.
 * @param {string} text
 */
export function toast(text) {
  const box = element("toast");
  box.textContent = text;
  box.hidden = false;
  clearTimeout(toast_timer);
  toast_timer = setTimeout(() => (box.hidden = true), 4000);
}
