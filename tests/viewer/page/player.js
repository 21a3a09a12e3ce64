// What the tests of the page share: processes that are started and spoken to, and what the page shows.
import { spawn } from "node:child_process";
import { join } from "node:path";
import { createInterface } from "node:readline";
import { check, within } from "./browser.js";

const { BIN, SHOTS } = process.env;
export const URL_OF_PAGE = "http://127.0.0.1:7668/";

/** A process that is started anew, and what it says. */
export class Player {
  constructor(name, ...args) {
    [this.name, this.args] = [name, args];
    this.said = [];
    this.start();
  }
  start() {
    this.process = spawn(join(BIN, this.name), this.args, { stdio: ["pipe", "pipe", "inherit"] });
    createInterface({ input: this.process.stdout }).on("line", (line) => this.said.push(line));
  }
  say(line) {
    this.process.stdin.write(line + "\n");
  }
  kill(signal) {
    this.process.kill(signal);
  }
  async hears(claim, pattern) {
    const slower = Number(process.env.SLOWER ?? 1);
    for (let i = 0; i < 100 * slower; ++i) {
      if (this.said.some((line) => pattern.test(line))) return check(claim, true);
      await new Promise((done) => setTimeout(done, 50));
    }
    throw new Error(`FAILED: ${claim}: the bus had ${this.said.join("; ")}`);
  }
}

export const shows = (page, seconds, name) =>
  within(page, seconds, `the page says ${name}`, (name) => document.getElementById("state").textContent === name, name);
export const shot = (page, name) => page.screenshot({ path: join(SHOTS, `${name}.png`) });
