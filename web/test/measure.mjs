// How long the page takes, measured in a browser and written into docs/studio.md with the date and the machine.
//
//     node test/measure.mjs STICTION CHROMIUM DOCS/studio.md ["WHAT | FOUND | BAR" ...]
//
// `cargo xtask studio-measure` runs it. STICTION is the release build: what users get. Rows that were measured elsewhere are put
// below those of the browser.

import { spawn } from "node:child_process";
import { createWriteStream, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { cpus, loadavg, tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { once } from "node:events";
import { chromium } from "playwright-core";

const [program, browserPath, page_] = process.argv.slice(2, 5).map((path) => resolve(path));
const more = process.argv.slice(5);
const folder = mkdtempSync(join(tmpdir(), "stiction-measure-"));
const BEGIN = "<!-- measured: cargo xtask studio-measure writes what follows -->";
const END = "<!-- end of what was measured -->";

/** A log that goes to and fro with friction, `rows` long, with so many columns beside the time. */
async function log(file, rows, columns) {
  const out = createWriteStream(file);
  const more = Array.from({ length: Math.max(columns - 3, 0) }, (_, k) => `,aux ${k + 1}`).join("");
  out.write(`time [s],position [mm],velocity [mm/s],force [N]${more}\n`);
  let part = "";
  for (let k = 0; k < rows; k += 1) {
    const t = k * 1e-3;
    const x = 40 * Math.sin(2 * t) + 7 * Math.sin(5.3 * t);
    const v = 80 * Math.cos(2 * t) + 37.1 * Math.cos(5.3 * t);
    const a = -160 * Math.sin(2 * t) - 196.6 * Math.sin(5.3 * t);
    const force = 20 * Math.sign(v) + 0.06 * v + 0.01 * a + 0.3 * Math.sin(1000 * t);
    part += `${t.toFixed(3)},${x.toFixed(5)},${v.toFixed(4)},${force.toFixed(4)}`;
    for (let j = 3; j < columns; j += 1) part += `,${(x * j).toFixed(3)}`;
    part += "\n";
    if (part.length > 1 << 20) {
      if (!out.write(part)) await once(out, "drain");
      part = "";
    }
  }
  out.end(part);
  await once(out, "finish");
}

async function serve() {
  const server = spawn(program, ["studio", folder, "--no-open", "--json"], { stdio: ["ignore", "pipe", "inherit"] });
  let said = "";
  for await (const chunk of server.stdout) {
    said += chunk;
    if (said.trimEnd().endsWith("}")) break;
  }
  return { server, address: JSON.parse(said).address };
}

/** Resident memory of the process that draws the page, MB: what it has for itself, and its share of what it has with others. */
async function memory(browser) {
  const session = await browser.newBrowserCDPSession();
  const { processInfo } = await session.send("SystemInfo.getProcessInfo");
  const renderers = processInfo.filter((own) => own.type === "renderer").map((own) => {
    const rollup = readFileSync(`/proc/${own.id}/smaps_rollup`, "utf8");
    return Number(/^Pss:\s+(\d+)/m.exec(rollup)[1]) / 1024;
  });
  return Math.max(...renderers);
}

const load = loadavg()[0].toFixed(1);
const middle = (values) => [...values].sort((a, b) => a - b)[values.length >> 1];
const high = (values) => [...values].sort((a, b) => a - b)[Math.floor(0.95 * values.length)];

await log(join(folder, "long.csv"), 1_000_000, 6);
const short = mkdtempSync(join(tmpdir(), "stiction-short-"));
for (const k of [0, 1, 2, 3, 4]) await log(join(short, `run${k}.csv`), 25_000, 3);
const { server, address } = await serve();
const browser = await chromium.launch({ executablePath: browserPath, args: ["--no-sandbox", "--disable-gpu"] });
const rows = [];
try {
  const page = await browser.newPage({ viewport: { width: 1280, height: 800 } });
  await page.goto(address);
  await page.locator("aside").waitFor();

  // A log is dropped: until its maps are there.
  const dropped = [];
  for (const k of [0, 1, 2, 3, 4]) {
    const began = Date.now();
    await page.locator("input[type=file]").setInputFiles(join(short, `run${k}.csv`));
    await page.getByRole("heading", { name: `run${k}.csv` }).waitFor();
    await page.locator(".map canvas").nth(1).waitFor();
    dropped.push(Date.now() - began);
  }
  rows.push(["a log of 25 000 rows, from the drop to the maps", `${middle(dropped)} ms`, "1500 ms"]);

  // A million rows of six columns: the first picture after the server has read it, which it does once.
  const read = Date.now();
  const answer = page.waitForResponse(/\/api\/log\?/);
  const tiles = page.waitForResponse(/\/api\/tiles\?/);
  await page.locator("aside .files button", { hasText: "long.csv" }).click();
  await (await answer).finished();
  const known = Date.now();
  await (await tiles).finished();
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  const painted = Date.now();
  rows.push(["6 × 1e6 values: read, with their pyramids", `${known - read} ms`, "-"]);
  rows.push(["6 × 1e6 values: first picture after that", `${painted - known} ms`, "300 ms"]);

  // Zoom and pan: from the event to the picture with the tiles of the new part, and what of it the page itself takes.
  await page.waitForTimeout(500);
  const frames = await page.evaluate(async () => {
    const over = document.querySelector(".trace .u-over");
    const box = over.getBoundingClientRect();
    const whole = [];
    const own = [];
    const observer = new PerformanceObserver((list) => { for (const entry of list.getEntries()) own.push(entry.duration); });
    observer.observe({ entryTypes: ["longtask"] });
    const fetched = window.fetch;
    let arrived = null;
    window.fetch = async (...given) => {
      const response = await fetched(...given);
      if (String(given[0]).includes("/api/tiles")) {
        const buffer = response.arrayBuffer.bind(response);
        response.arrayBuffer = async () => { const bytes = await buffer(); arrived?.(); return bytes; };
      }
      return response;
    };
    for (let k = 0; k < 60; k += 1) {
      const pan = k % 3 === 2;
      const deltaY = pan ? 60 : k < 30 ? -120 : 120;
      const done = new Promise((resolve) => { arrived = resolve; });
      const began = performance.now();
      over.dispatchEvent(new WheelEvent("wheel", { deltaY, shiftKey: pan, clientX: box.x + box.width * 0.4, clientY: box.y + 20, bubbles: true, cancelable: true }));
      await done;
      // The frame that draws the tiles, and what the page does for it.
      await new Promise((next) => requestAnimationFrame(next));
      await new Promise((next) => { const { port1, port2 } = new MessageChannel(); port1.onmessage = next; port2.postMessage(0); });
      whole.push(performance.now() - began);
    }
    observer.disconnect();
    window.fetch = fetched;
    return { whole, own };
  });
  rows.push(["a step of zoom or pan, until its picture: half of them within", `${middle(frames.whole).toFixed(0)} ms`, "50 ms"]);
  rows.push(["the same, 95 % of them within", `${high(frames.whole).toFixed(0)} ms`, "50 ms"]);
  rows.push(["tasks of the page above 50 ms in 60 such steps", `${frames.own.length}`, "0"]);
  rows.push(["memory of the page", `${(await memory(browser)).toFixed(0)} MB`, "300 MB"]);
} finally {
  await browser.close();
  server.kill();
  rmSync(folder, { recursive: true, force: true });
  rmSync(short, { recursive: true, force: true });
}
const built = program.includes("release") ? "release build" : "debug build";
const text = [
  BEGIN,
  "",
  `${new Date().toISOString().slice(0, 10)}, ${cpus().length} cores of ${cpus()[0].model} at a load of ${load}, Chromium ${browser.version()}, ${built}:`,
  "",
  "| what | found | bar |",
  "|---|---|---|",
  ...[...rows.map((row) => row.join(" | ")), ...more].map((row) => `| ${row} |`),
  "",
  END,
].join("\n");
console.log(text);
const before = readFileSync(page_, "utf8");
const [head, rest] = before.split(BEGIN);
if (rest === undefined || !rest.includes(END)) throw new Error(`${page_} has no place for it: ${BEGIN} ... ${END}`);
writeFileSync(page_, head + text + rest.slice(rest.indexOf(END) + END.length));
