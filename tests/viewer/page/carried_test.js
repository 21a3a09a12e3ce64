// The live page of a robot that is carried off, with the real services (carried_test starts them): LOST, then ghosts, then
// TRACKING; kill -9 of the mapper and the viewer; a bus that falls silent.
import { execFileSync } from "node:child_process";
import { join } from "node:path";
import { check, state, with_page, within } from "./browser.js";
import { Player, shot, shows, URL_OF_PAGE } from "./player.js";

const { SCRIPTS } = process.env;
const run = (command, ...args) => execFileSync(command, args, { encoding: "utf8" });

/** The process of a service; services status fails while one of them is ill. */
function pid_of(service) {
  let said;
  try {
    said = run(join(SCRIPTS, "services"), "status", service);
  } catch (error) {
    said = error.stdout;
  }
  return Number(/RUNNING *pid (\d+)/.exec(said)[1]);
}

async function maps(page) {
  await shows(page, 30, "TRACKING");
  await within(page, 30, "the map grows", () => voxlist.bus.data("map").keyframes > 5 && voxlist.map.levels[0].voxels > 20_000);
  await within(page, 30, "the robot moves", () => Math.hypot(...voxlist.overlay.pose().slice(0, 2)) > 2);
  await within(page, 90, "it comes back from its tour", () =>
    voxlist.bus.data("map").keyframes > 15 && Math.hypot(...voxlist.overlay.pose().slice(0, 2)) < 0.3);
  await page.click("#only-on");
  await within(page, 5, "the mapper only localises then", () =>
    /localis/.test(document.querySelector("tr[data-service=mapper] .why").textContent));
}

async function is_carried_off(page) {
  await shows(page, 60, "LOST");
  check("it says why", /nothing in the map fits|may not know/.test(await state(page)), await state(page));
  await page.waitForTimeout(300);
  await shot(page, "carried_lost");
  await shows(page, 30, "AMBIGUOUS");
  const modes = await page.evaluate(() => voxlist.bus.data("robot").modes.length);
  check("there are ghosts", modes > 1, modes);
  await page.waitForTimeout(300);
  await shot(page, "carried_ghosts");
  await shows(page, 30, "TRACKING");
  const [x, y] = await page.evaluate(() => voxlist.overlay.pose());
  check("where it truly is", Math.hypot(x - 6.3, y + 3) < 0.1, `${x}, ${y}`);
}

async function survives_the_mappers_end(page) {
  const pid = pid_of("mapper");
  run("kill", "-KILL", String(pid));
  await within(page, 3, "3 s after kill -9 of the mapper another one is there, and the page has all again", (pid) => {
    const { bus, map } = voxlist;
    const mapper = bus.data("service/mapper");
    return mapper.pid !== pid && bus.is_fresh("service/mapper", 3) && map.is_whole && map.levels[0].voxels > 20_000 &&
      document.getElementById("state").textContent === "TRACKING";
  }, pid);
}

async function survives_the_viewers_end(page) {
  const session = await page.evaluate(() => voxlist.bus.data("hello").session);
  run("kill", "-KILL", String(pid_of("viewer")));
  await within(page, 3, "3 s after kill -9 of the viewer the page has all again", (session) => {
    const { bus, map } = voxlist;
    return bus.data("hello").session !== session && map.is_whole && map.levels[0].voxels > 20_000 &&
      document.getElementById("state").textContent === "TRACKING";
  }, session);
}

async function is_grey_when_the_bus_is_gone(page) {
  run("ip", "route", "del", "224.0.0.0/4", "dev", "lo");
  await within(page, 3, "3 s after the bus stopped, state and services are grey", () =>
    document.getElementById("state").textContent === "NO WORD" &&
    ["localiser", "mapper"].every((name) => document.querySelector(`tr[data-service=${name}]`).hasAttribute("data-stale")));
  await shot(page, "carried_no_bus");
  run("ip", "route", "add", "224.0.0.0/4", "dev", "lo");
  await shows(page, 5, "TRACKING");
}

process.env.PATH += ":/usr/sbin:/sbin";
let simulator;
try {
  await with_page(URL_OF_PAGE, async (page, errors) => {
    simulator = new Player("simulator", "--config", "robot.toml");
    await maps(page);
    await is_carried_off(page);
    await survives_the_mappers_end(page);
    check("without faults so far", errors.length === 0, errors.join("; "));
    await survives_the_viewers_end(page);
    await is_grey_when_the_bus_is_gone(page);
  });
} finally {
  simulator?.kill("SIGTERM");
}
