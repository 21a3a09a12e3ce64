// The live page, step by step, as an operator sees it. The robot and its services are played by the stage (stage.cpp);
// the viewer and the browser are real. carried_test.js has the real ones.
import { existsSync, readdirSync } from "node:fs";
import { join } from "node:path";
import { check, drawn, state, with_page, within } from "./browser.js";
import { Player, shot, shows, URL_OF_PAGE } from "./player.js";

const { XDG_STATE_HOME } = process.env;
const at_screen = (page, point) => page.evaluate((p) => voxlist.camera.project(p), point);

async function drag(page, from, to) {
  const [a, b] = [await at_screen(page, from), await at_screen(page, to)];
  await page.mouse.move(...a);
  await page.mouse.down();
  await page.mouse.move(...b, { steps: 4 });
  await page.mouse.up();
}

/** Whether a colour of the page is drawn near a point of the map, over it. */
const has_colour = (page, name, point) => page.evaluate(([name, point]) => {
  const hex = getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
  const [r, g, b] = [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16));
  const [x, y] = voxlist.camera.project(point);
  const pixels = document.getElementById("overlay").getContext("2d").getImageData(x - 15, y - 15, 30, 30).data;
  let near = 0;
  for (let i = 0; i < pixels.length; i += 4)
    if (pixels[i + 3] > 60 && Math.abs(pixels[i] - r) + Math.abs(pixels[i + 1] - g) + Math.abs(pixels[i + 2] - b) < 40) ++near;
  return near > 5;
}, [name, point]);

async function shows_map_and_robot(page, stage) {
  await shows(page, 3, "WAITING");
  stage.say("map 1");
  stage.say("track 2 2 0");
  await shows(page, 3, "TRACKING");
  await within(page, 3, "the map's pixels appear", () => voxlist.map.is_whole && voxlist.map.levels[0].voxels > 10000);
  await page.waitForTimeout(200);
  const [before, voxels] = [await drawn(page), await page.evaluate(() => voxlist.map.levels[0].voxels)];
  check("they are many", before > 20000, before);
  await shot(page, "one_room");
  stage.say("map 2");
  await within(page, 3, "the map grows", (voxels) => voxlist.map.levels[0].voxels > 1.5 * voxels, voxels);
  stage.say("track 8 2 1");
  await within(page, 2, "the robot moves", () => Math.abs(voxlist.overlay.pose()[0] - 8) < 0.01);
  await page.waitForTimeout(300);
  check("and is drawn there", await has_colour(page, "good", [8, 2, 0.1]));
  stage.say("loop");
  await within(page, 2, "a loop that is closed is told", () => /loop was closed.*0.25 m/.test(document.getElementById("toast").textContent));
}

async function shows_how_sure_it_is(page, stage) {
  stage.say("lost");
  await shows(page, 2, "LOST");
  check("and why, and for how long", /for \d.*nothing in the map fits/.test(await state(page)), await state(page));
  await page.waitForTimeout(300);
  check("the robot is grey then", !(await has_colour(page, "good", [8, 2, 0.1])));
  stage.say("ambiguous");
  await shows(page, 2, "AMBIGUOUS");
  await page.waitForTimeout(300);
  for (const x of [2, 8]) check(`a ghost stands at ${x}`, await has_colour(page, "doubt", [x, 2, 0.1]));
  check("with its probability", /60 % at 2.0, 2.0; 30 % at 8.0/.test(await state(page)), await state(page));
  await shot(page, "ambiguous");
  stage.say("track 3 2 0");
  await shows(page, 2, "TRACKING");
}

async function shows_other_robots(page, stage) {
  const row = (name) => document.querySelector(`tr[data-service="robot ${name}"]`)?.innerText.replace(/\s+/g, " ").trim();
  stage.say("others on");
  await within(page, 3, "other robots are listed", () => document.querySelectorAll('tr[data-service^="robot "]').length === 2);
  const [b, c] = [await page.evaluate(row, "robot_b"), await page.evaluate(row, "robot_c")];
  check("by name, with state, place and date", /^robot robot_b ?TRACKING at 5.0, 1.0 m 0.\d s$/.test(b), b);
  check("and whether that is in this map", /^robot robot_c ?TRACKING at 1.0, 1.0 m in a map of its own 0/.test(c), c);
  await page.waitForTimeout(300);
  check("one is drawn in the map", await has_colour(page, "accent", [5, 1, 0.1]));
  check("one that has no place in it is not", !(await has_colour(page, "accent", [1, 1, 0.1])));
  await shot(page, "others");
  stage.say("others off");
  await within(page, 5, "those that fall silent are grey", () => document.querySelectorAll('tr[data-service^="robot "][data-stale]').length === 2);
  await page.waitForTimeout(300);
  check("in the map, too", (await has_colour(page, "stale", [5, 1, 0.1])) && !(await has_colour(page, "accent", [5, 1, 0.1])));
  await shot(page, "others_silent");
}

async function shows_free_space(page) {
  await page.selectOption("#colour", "space");
  await within(page, 3, "free and occupied space comes to who looks at it", () => {
    const { told, shown } = voxlist.space;
    return told.every((level) => level.chunks.size > 0) && [...shown.chunks.values()].some((chunk) => chunk.vertices.length > 4000);
  });
  check("the floor is out of the slice then", (await page.inputValue("#low")) === "0.2");
  await page.waitForTimeout(300);
  await shot(page, "space");
  check("and is drawn", (await drawn(page)) > 20000);
  const free = () => voxlist.space.told[0].chunks.size;
  await page.selectOption("#colour", "height");
  await within(page, 2, "and no longer to who does not", () => voxlist.space.told[0].chunks.size === 0);
  await page.waitForTimeout(700);
  check("it stays away", (await page.evaluate(free)) === 0);
  await page.fill("#low", "-0.5");
}

async function obeys(page, stage) {
  await page.click("#save");
  await stage.hears("save is asked", /^want 2$/);
  await page.click("#only-on");
  await stage.hears("localise-only is asked", /^want 6$/);
  await page.click("#only-off");
  await stage.hears("and its end", /^want 7$/);
  await page.click("#hint");
  await drag(page, [4, 1, 0], [4, 3, 0]);
  await stage.hears("a hint is given, with its direction", /^hint (3.9|4.0)\d (0.9|1.0)\d 1\.5\d 0\.30$/);
  await page.keyboard.press("h");
  await drag(page, [5, 1, 0], [5, 1, 0]);
  await stage.hears("a click alone tells no direction", /^hint (4.9|5.0)\d (0.9|1.0)\d .* 1\.80$/);
  for (const [action, mark] of ["erase", "free", "blocked"].entries()) {
    await page.click(`[data-mark=${mark}]`);
    await drag(page, [1, 1, 0], [2, 3, 0]);
    await stage.hears(`an area is marked: ${mark}`, new RegExp(`^edit ${action} 0 (0.9|1.0)\\d (0.9|1.0)\\d -0.50 (1.9|2.0)\\d (2.9|3.0)\\d 2.20$`));
  }
  await within(page, 2, "edits are listed", () => document.querySelectorAll("#edits li").length === 3);
  await page.click("#edits button");
  await stage.hears("and taken back", /^edit 3 1 /);
}

async function records(page) {
  const folder = join(XDG_STATE_HOME, "voxlist", "recordings");
  const on = () => document.getElementById("record").getAttribute("aria-pressed");
  await page.click("#record");
  await within(page, 3, "it records", () => document.getElementById("record").getAttribute("aria-pressed") === "true");
  await page.waitForTimeout(3000);
  await page.click("#record");
  await within(page, 3, "and stops", () => document.getElementById("record").getAttribute("aria-pressed") === "false");
  check("there is a recording", existsSync(folder) && readdirSync(folder).some((name) => name.endsWith(".lcm.00")), on);
}

/** The recording that was made, as a page with a time bar. */
async function replays() {
  const folder = join(XDG_STATE_HOME, "voxlist", "recordings");
  const name = readdirSync(folder).find((name) => name.endsWith(".lcm.00"));
  desk = new Player("voxlist", "view", join(folder, name), "--port", "7669");
  await desk.hears("voxlist view says where its page is", /7669/);
  await with_page("http://127.0.0.1:7669/", async (page, errors) => {
    await within(page, 5, "the time bar is there, the orders are not",
      () => !document.getElementById("timebar").hidden && document.getElementById("orders").hidden);
    await shows(page, 5, "TRACKING");
    const track = await page.locator("#track").boundingBox();
    await page.mouse.click(track.x + track.width - 3, track.y + 15);
    await within(page, 3, "a click goes there", () => {
      const { begin_us, end_us } = voxlist.bus.data("hello").recording;
      return voxlist.bus.data("clock").utime_us > begin_us + 0.9 * (end_us - begin_us);
    });
    await within(page, 3, "it stops at the end", () => voxlist.bus.data("clock").speed === 0);
    await page.waitForTimeout(2600);
    await shows(page, 1, "TRACKING");
    await page.click("#play");
    await within(page, 3, "and plays again", () => voxlist.bus.data("clock").speed === 1);
    check("without faults", errors.length === 0, errors.join("; "));
    await shot(page, "time_bar");
  });
}

async function is_never_stale(page, stage, viewer) {
  stage.kill("SIGSTOP");
  await shows(page, 3, "NO WORD");
  check("it says since when, and what was", /was TRACKING/.test(await state(page)), await state(page));
  await within(page, 3, "services that say nothing are grey", () => document.querySelector("tr[data-service=mapper]").hasAttribute("data-stale"));
  await shot(page, "no_word");
  stage.kill("SIGCONT");
  await shows(page, 3, "TRACKING");
  viewer.kill("SIGKILL");
  await shows(page, 3, "NO CONNECTION");
  viewer.start();
  await shows(page, 3, "TRACKING");
  await within(page, 3, "and the map is back", () => voxlist.map.is_whole && voxlist.map.levels[0].voxels > 20000);
}

async function follows_another_mapper(page, stage) {
  stage.kill("SIGKILL");
  const next = new Player("stage", "2");
  next.say("map 3");
  next.say("track 14 2 0");
  await within(page, 6, "another mapper's map is shown", () => voxlist.bus.data("map").map_id === "2" && voxlist.map.is_whole);
  await shows(page, 3, "TRACKING");
  return next;
}

const viewer = new Player("viewer");
let stage = new Player("stage", "1");
let desk;
try {
  await with_page(URL_OF_PAGE, async (page, errors) => {
    const elsewhere = [];
    page.on("request", (request) => request.url().startsWith(URL_OF_PAGE) || elsewhere.push(request.url()));
    await shows_map_and_robot(page, stage);
    await shows_how_sure_it_is(page, stage);
    await shows_other_robots(page, stage);
    await shows_free_space(page);
    await obeys(page, stage);
    await records(page);
    check("it has no faults so far", errors.length === 0, errors.join("; "));
    await is_never_stale(page, stage, viewer);
    stage = await follows_another_mapper(page, stage);
    await shot(page, "dark");
    check("nobody else was asked", elsewhere.length === 0, elsewhere.join("; "));
  });
  await replays();
  await with_page(URL_OF_PAGE, async (page) => {
    await shows(page, 5, "TRACKING");
    await within(page, 5, "a phone has the map", () => voxlist.map.is_whole && voxlist.stats.frames > 3);
    check("and not the panels", !(await page.isVisible("#side")));
    await page.waitForTimeout(500);
    await shot(page, "phone");
    await page.click("#menu");
    check("until they are asked for", await page.isVisible("#services"));
    check("nothing is wider than the screen", await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth));
    await shot(page, "phone_panels");
  }, { width: 390, height: 844, dark: false });
  await with_page(`${URL_OF_PAGE}?renderer=webgl`, async (page, errors) => {
    await within(page, 10, "WebGL draws the map, too", () => voxlist.map.is_whole && voxlist.renderer.name === "webgl" && voxlist.stats.frames > 3);
    await page.waitForTimeout(500);
    await shot(page, "webgl");
    check("without faults", errors.length === 0, errors.join("; "));
  }, { dark: false });
} finally {
  stage.kill("SIGKILL");
  viewer.kill("SIGKILL");
  desk?.kill("SIGKILL");
}
