// Each version of the map: when it was whole on the screen (ms of the wall clock), and the bytes of its blocks.
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { with_page } from "./browser.js";

const { BUS, SHOTS, VIEWER } = process.env;
const seconds = Number(process.env.SECONDS ?? 75);

const watch = () => {
  window.shown = [];
  let blocks = 0, version = 0, begun = false;
  const look = () => {
    const { map, bus, stats } = window.voxlist ?? {};
    if (bus && !begun) {
      begun = true;
      const hear = bus.hear;
      bus.hear = (told) => {
        if (told.topic === "blocks") blocks += told.bytes.byteLength;
        hear(told);
      };
    }
    const told = bus?.data("map");
    const whole = map?.is_whole && map.levels.every((level) => [...level.chunks.values()].every((chunk) => !chunk.stale));
    if (told && whole && told.version > version) {
      version = told.version;
      window.shown.push({ version, at_ms: performance.timeOrigin + performance.now(), bytes: blocks, draw_ms: stats.draw_ms });
      blocks = 0;
    }
    setTimeout(() => requestAnimationFrame(look), 0); // after the page has drawn
  };
  look();
};

const cpu_s = () => {
  const fields = readFileSync(`/proc/${VIEWER}/stat`, "utf8").split(") ")[1].split(" ");
  return (Number(fields[11]) + Number(fields[12])) / 100;
};
const peak_mb = () => Number(/VmHWM:\s*(\d+)/.exec(readFileSync(`/proc/${VIEWER}/status`, "utf8"))[1]) / 1024;
const percentile = (values, share) => values.sort((a, b) => a - b)[Math.ceil(share * values.length) - 1];

// When the last message of each version came by (ms).
function versions() {
  const times = new Map();
  for (const line of readFileSync(BUS, "utf8").split("\n")) {
    const [at, channel, version, , answers] = line.split(" ");
    if (channel === "MAP_UPDATE" && answers === "0") times.set(Number(version), Number(at));
  }
  return times;
}

await with_page("about:blank", async (page) => {
  await page.addInitScript(watch);
  await page.goto(process.argv[2]);
  await page.waitForFunction(() => window.voxlist?.bus.data("map")?.version > 0, undefined, { timeout: 60_000 });
  const began_s = performance.now() / 1000, spent_s = cpu_s();
  for (let shot = 0; performance.now() / 1000 - began_s < seconds; ++shot) {
    await page.waitForTimeout(5000);
    if (shot % 4 === 3) await page.screenshot({ path: join(SHOTS, `live_${shot}.png`) });
  }
  const share = (cpu_s() - spent_s) / (performance.now() / 1000 - began_s);
  const shown = await page.evaluate(() => window.shown);
  const said = versions();
  const lags = [], bytes = [];
  for (const { version, at_ms, bytes: size } of shown.slice(1)) {
    if (!said.has(version)) continue;
    lags.push(at_ms - said.get(version));
    bytes.push(size);
  }
  console.log(`${lags.length} versions: to the screen, ms: median ${percentile(lags, 0.5).toFixed(0)}, ` +
    `p95 ${percentile(lags, 0.95).toFixed(0)}, most ${percentile(lags, 1).toFixed(0)}; kB: median ` +
    `${(percentile(bytes, 0.5) / 1000).toFixed(1)}, p95 ${(percentile(bytes, 0.95) / 1000).toFixed(1)}, most ${(percentile(bytes, 1) / 1000).toFixed(1)}`);
  console.log(`viewer: ${(100 * share).toFixed(2)} % of a core, ${peak_mb().toFixed(1)} MB at most`);
});
