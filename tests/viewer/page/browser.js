// Debian's Chromium, driven by playwright-core, on the page that argument 1 names.
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { chromium } from "playwright-core";

/** Fails with the claim unless it holds. */
export function check(claim, holds, what = "") {
  if (!holds) throw new Error(`FAILED: ${claim} ${what}`);
  console.log(`ok: ${claim}`);
}

/** Waits until a function in the page is true; the claim is told either way. */
export async function within(page, seconds, claim, holds, argument) {
  const slower = Number(process.env.SLOWER ?? 1);
  const began = performance.now();
  try {
    await page.waitForFunction(holds, argument, { timeout: 1000 * seconds * slower, polling: 50 });
  } catch {
    await page.screenshot({ path: join(process.env.SHOTS ?? tmpdir(), "failed.png") });
    throw new Error(`FAILED: ${claim} (within ${seconds} s); the page says ${await state(page)}`);
  }
  const took_s = (performance.now() - began) / 1000;
  console.log(`ok: ${claim} (${took_s.toFixed(1)} s)`);
  return took_s;
}

export const state = (page) => page.evaluate(() => document.getElementById("status").innerText.replaceAll("\n", " "));

/** Opens the page, hands it to `work`, and closes all again. */
export async function with_page(url, work, { width = 1280, height = 720, dark = true } = {}) {
  const folder = mkdtempSync(join(tmpdir(), "voxlist_chromium."));
  const args = ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
    "--disable-component-update", "--disable-sync", "--disable-dev-shm-usage"];
  const context = await chromium.launchPersistentContext(folder, {
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", headless: true, args,
    viewport: { width, height }, colorScheme: dark ? "dark" : "light",
  });
  const errors = [];
  try {
    const page = context.pages()[0] ?? (await context.newPage());
    page.on("pageerror", (error) => errors.push(String(error)));
    page.on("console", (message) => message.type() === "error" && errors.push(message.text()));
    await page.goto(url);
    await work(page, errors);
  } finally {
    await context.close();
    rmSync(folder, { recursive: true, force: true });
  }
}

/** Pixels of the map's canvas that are not background. */
export const drawn = (page) => page.evaluate(() => {
  const canvas = document.getElementById("voxels");
  const copy = Object.assign(document.createElement("canvas"), { width: canvas.width, height: canvas.height });
  const context = copy.getContext("2d");
  context.drawImage(canvas, 0, 0);
  const pixels = new Uint32Array(context.getImageData(0, 0, copy.width, copy.height).data.buffer);
  const back = pixels[0];
  return pixels.reduce((count, pixel) => count + (pixel !== back ? 1 : 0), 0);
});
