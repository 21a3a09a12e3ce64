// Times from the visit on (s): the coarse picture, the whole map as vertices; bytes; ms a frame of all voxels.
import { with_page } from "./browser.js";

const watch = () => {
  window.times = {};
  const look = () => {
    const { map, bus } = window.voxlist ?? {};
    const now_s = performance.now() / 1000;
    if (bus?.frames) window.times.stream_s ??= now_s;
    if (map?.levels[1].voxels) window.times.coarse_s ??= now_s;
    if (map?.is_whole && [...map.levels[0].chunks.values()].every((chunk) => !chunk.stale)) {
      window.times.whole_s ??= now_s;
      window.times.megabytes ??= bus.bytes / 1e6;
    }
    requestAnimationFrame(look);
  };
  look();
};

const frame_ms = async () => {
  const { camera, renderer, map, look } = window.voxlist;
  const ms = [];
  for (let i = 0; i < 40; ++i) {
    camera.orbit(3, 0);
    const began = performance.now();
    renderer.draw(map.levels[0], camera, { ...look, low: -10, high: 30 });
    ms.push(performance.now() - began);
    await new Promise(requestAnimationFrame);
  }
  return ms.sort((a, b) => a - b)[20];
};

await with_page("about:blank", async (page) => {
  await page.addInitScript(watch);
  for (let visit = 0; visit < 3; ++visit) {
    await page.goto(process.argv[2]);
    await page.waitForFunction(() => window.times?.whole_s, undefined, { timeout: 60_000 });
    const times = await page.evaluate(() => ({ ...window.times, voxels: window.voxlist.map.levels.map((level) => level.voxels) }));
    console.log(JSON.stringify(times), "frame", (await page.evaluate(frame_ms)).toFixed(1), "ms");
  }
});
