// Usage: node rerun.js FILE.mcap SHOT.png TIME_S: Rerun's web viewer in Chromium opens the file and shows it at that time.
// Fails unless enough of the picture is coloured, as points are. Without a GPU, the viewer takes seconds for a picture.
import { readFileSync, mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { tmpdir } from "node:os";
import { extname, join } from "node:path";
import { chromium } from "playwright-core";

const [mcap, shot, time_s] = process.argv.slice(2);
const slower = Number(process.env.SLOWER ?? 1);
const size = { width: 800, height: 500 };
const types = { ".js": "text/javascript", ".wasm": "application/wasm" };
const page_text = `<!doctype html><body style="margin:0"><script type="module">
import { WebViewer } from "/index.js";
window.viewer = new WebViewer();
viewer.on("recording_open", () => { window.is_open = true; });
await viewer.start(location.origin + "/run.mcap", document.body, { width: "100vw", height: "100vh", hide_welcome_screen: true });
for (const panel of ["top", "blueprint", "selection"]) viewer.override_panel_state(panel, "hidden");
</script>`;

function check(claim, holds, what = "") {
  if (!holds) throw new Error(`FAILED: ${claim} ${what}`);
  console.log(`ok: ${claim}`);
}

// The viewer's own files, which import each other without their ending.
function file_of(url) {
  if (url === "/") return [page_text, "text/html"];
  if (url === "/run.mcap") return [readFileSync(mcap), "application/octet-stream"];
  const name = extname(url) ? url : `${url}.js`;
  try {
    return [readFileSync(join("node_modules/@rerun-io/web-viewer", name)), types[extname(name)] ?? "text/plain"];
  } catch {
    return null;
  }
}

const server = createServer((request, response) => {
  const file = file_of(request.url);
  if (!file) return response.writeHead(404).end();
  response.writeHead(200, { "content-type": file[1], "content-length": Buffer.byteLength(file[0]) }).end(file[0]);
});
await new Promise((listens) => server.listen(0, "127.0.0.1", listens));

/** A picture of the page, and how many of its pixels are coloured, by hue (12 hues). */
async function picture(devtools, page) {
  const { data } = await devtools.send("Page.captureScreenshot", { format: "png" });
  const hues = await page.evaluate(async (png) => {
    const image = await createImageBitmap(await (await fetch(`data:image/png;base64,${png}`)).blob());
    const canvas = new OffscreenCanvas(image.width, image.height).getContext("2d");
    canvas.drawImage(image, 0, 0);
    const pixels = canvas.getImageData(0, 0, image.width, image.height * 0.85).data; // without the time bar
    const counts = new Array(12).fill(0);
    for (let i = 0; i < pixels.length; i += 4) {
      const [r, g, b] = pixels.slice(i, i + 3);
      const most = Math.max(r, g, b), range = most - Math.min(r, g, b);
      if (range < 80) continue;
      const sector = most === r ? ((g - b) / range + 6) % 6 : most === g ? (b - r) / range + 2 : (r - g) / range + 4;
      ++counts[Math.floor(2 * sector) % 12];
    }
    return counts;
  }, data);
  return { png: Buffer.from(data, "base64"), hues };
}

const folder = mkdtempSync(join(tmpdir(), "voxlist_chromium."));
const context = await chromium.launchPersistentContext(folder, {
  executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", headless: true, viewport: size, colorScheme: "dark",
  args: ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
    "--disable-component-update", "--disable-sync", "--disable-dev-shm-usage"],
});
try {
  const page = context.pages()[0];
  page.setDefaultTimeout(120_000 * slower);
  await page.goto(`http://127.0.0.1:${server.address().port}/`);
  await page.waitForFunction(() => window.is_open && window.viewer.get_active_recording_id());
  check("Rerun opens the file", true);
  const range = await (await page.waitForFunction((end_ns) => {
    const recording = viewer.get_active_recording_id();
    const range = viewer.get_time_range(recording, "message_log_time");
    return range && range.max >= end_ns && range;
  }, 1e9 * time_s, { polling: 200 })).jsonValue();
  check("it has the times of the log", range.max - range.min === 19e9, JSON.stringify(range));
  await page.evaluate((time_ns) => {
    const recording = viewer.get_active_recording_id();
    viewer.set_active_timeline(recording, "message_log_time");
    viewer.set_playing(recording, false);
    viewer.set_current_time(recording, "message_log_time", time_ns);
  }, 1e9 * time_s);
  const devtools = await context.newCDPSession(page);
  let last;
  for (let i = 0; i < 20 * slower; ++i) {
    await new Promise((done) => setTimeout(done, 1000));
    last = await picture(devtools, page);
    writeFileSync(shot, last.png);
    if (last.hues.filter((count) => count > 100).length >= 2 && Math.max(...last.hues) > 2000) break;
  }
  check("it shows the map, and more in other colours", last.hues.filter((count) => count > 100).length >= 2 &&
    Math.max(...last.hues) > 2000, last.hues);
} finally {
  await context.close();
  rmSync(folder, { recursive: true, force: true });
  server.close();
}
