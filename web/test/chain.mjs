// The whole chain in a browser, as an engineer goes through it with a mouse: drop a log, correct a unit, brush, identify,
// study, export, and a plan that is stopped. What it leaves is compared byte for byte with what the lines that the page shows leave on the command line,
// every view is looked through by axe, and pictures of all of them are kept.
//
//     node test/chain.mjs STICTION CHROMIUM PICTURES

import { execFileSync, spawn } from "node:child_process";
import { copyFileSync, existsSync, mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync, statSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { chromium } from "playwright-core";

const [program, browserPath, pictures] = process.argv.slice(2).map((path) => resolve(path));
const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const folder = mkdtempSync(join(tmpdir(), "stiction-studio-"));
const [space, twin] = ["page", "typed"].map((name) => join(folder, name));
mkdirSync(space);
mkdirSync(twin);
mkdirSync(pictures, { recursive: true });
const began = Date.now();
const passed = (what) => console.log(`    ${((Date.now() - began) / 1000).toFixed(1)} s: ${what}`);

function equal(found, wanted, what) {
  if (found !== wanted) throw new Error(`${what}: found ${found}, not ${wanted}`);
}

/** A recording with a unit that is wrong in its header: what is called cm are mm. */
function recording() {
  execFileSync(program, ["demo", "--quiet", "--out", join(folder, "demo")]);
  const text = readFileSync(join(folder, "demo", "demo.csv"), "utf8");
  writeFileSync(join(folder, "run.csv"), text.replace("Position [mm]", "Position [cm]"));
}

/** The server, and the address that it prints. */
async function serve(options = ["--no-open"], env = process.env) {
  const server = spawn(program, ["studio", space, "--json", ...options], { stdio: ["ignore", "pipe", "inherit"], env });
  let said = "";
  for await (const part of server.stdout) {
    said += part;
    if (said.trimEnd().endsWith("}")) break;
  }
  return { server, address: JSON.parse(said).address };
}

/** The file with which a server opens the page by itself, which another program is given to show. */
async function openedBy() {
  const [bin, shown] = [join(folder, "bin"), join(folder, "shown")];
  mkdirSync(bin);
  writeFileSync(join(bin, "xdg-open"), `#!/bin/sh\nprintf %s "$*" > "${shown}.part" && mv "${shown}.part" "${shown}"\n`, { mode: 0o755 });
  const { server } = await serve([], { ...process.env, PATH: `${bin}:${process.env.PATH}` });
  for (let tries = 0; !existsSync(shown); tries += 1) {
    if (tries > 100) throw new Error("no browser was started");
    await new Promise((done) => setTimeout(done, 100));
  }
  return { server, file: readFileSync(shown, "utf8") };
}

/** Files of two folders, but for the seconds that work took. */
function compare(a, b, what) {
  const names = readdirSync(a, { recursive: true }).filter((name) => statSync(join(a, name)).isFile()).sort();
  const others = readdirSync(b, { recursive: true }).filter((name) => statSync(join(b, name)).isFile()).sort();
  equal(JSON.stringify(names), JSON.stringify(others), `${what}: files`);
  for (const name of names) {
    const read = (dir) => {
      const text = readFileSync(join(dir, name), "latin1");
      return name.endsWith("result.json") ? text.replace(/"wall_s": [0-9.e-]+/g, '"wall_s": 0') : text;
    };
    if (read(a) !== read(b)) throw new Error(`${what}: ${name} is not what the command line writes`);
  }
  return names.length;
}

const { server, address } = await (recording(), serve());
const browser = await chromium.launch({ executablePath: browserPath, args: ["--no-sandbox", "--disable-gpu", "--force-color-profile=srgb", "--font-render-hinting=none"] });
try {
  const context = await browser.newContext({ viewport: { width: 1280, height: 800 }, colorScheme: "light", permissions: ["clipboard-read", "clipboard-write"] });
  const page = await context.newPage();
  const wrong = [];
  page.on("pageerror", (error) => wrong.push(String(error)));
  page.on("console", (message) => { if (message.type() === "error") wrong.push(message.text()); });
  // Whatever is not of this page is not asked for, as with the network unplugged.
  await page.route((url) => url.origin !== new URL(address).origin && url.protocol.startsWith("http"), (route) => { wrong.push(`asked for ${route.request().url()}`); return route.abort(); });

  // A page that was just built is tried without building the program anew: STICTION_ASSETS=../crates/studio/assets.
  const assets = process.env.STICTION_ASSETS;
  if (assets) await context.route(/\/studio\.(js|css)$/, (route) => route.fulfill({ path: join(assets, new URL(route.request().url()).pathname) }));

  /** Looks through the view with axe and keeps a picture of it. */
  async function look(name) {
    await page.waitForTimeout(250);
    await page.screenshot({ path: join(pictures, `${name}.png`) });
    await page.evaluate(axe);
    const found = await page.evaluate(() => globalThis.axe.run(document, { resultTypes: ["violations"] }));
    const bad = found.violations.filter((one) => ["serious", "critical"].includes(one.impact));
    if (bad.length) throw new Error(`${name}: ${bad.map((one) => `${one.id}: ${one.nodes.map((node) => node.html.slice(0, 160)).join(" | ")}`).join("\n")}`);
    passed(name);
  }
  const shown = () => page.locator(".command code").innerText();
  /** Types the line of the page in the other folder. */
  function typed(line) {
    equal(line.startsWith("stiction "), true, `a command line: ${line}`);
    try {
      execFileSync("sh", ["-c", line.replace(/^stiction/, '"$0"'), program], { cwd: twin, stdio: ["ignore", "ignore", "pipe"] });
    } catch (error) {
      if (error.status > 1) throw new Error(`${line}: ${error.stderr}`);
    }
  }

  await page.goto(address);
  await page.getByText("Begin with a log").waitFor();
  equal(await page.evaluate(() => location.hash.includes("token")), false, "the token is gone from the address");
  await look("begin");
  // The address is good once: the same browser has the session already, another is told so.
  const twice = await context.newPage();
  await twice.goto(address);
  await twice.getByText("Begin with a log").waitFor();
  await twice.close();
  const late = await (await browser.newContext()).newPage();
  await late.goto(address);
  await late.getByText("This browser has no session here.").waitFor();
  await late.close();

  // A log is dropped.
  const dropped = Date.now();
  await page.locator("input[type=file]").setInputFiles(join(folder, "run.csv"));
  await page.locator(".map canvas").nth(1).waitFor();
  passed(`from the drop of 36 001 rows to the maps ${Date.now() - dropped} ms`);
  equal(readFileSync(join(space, "run.csv"), "utf8"), readFileSync(join(folder, "run.csv"), "utf8"), "the log in the folder");

  // Lengths are in mm and angles in degrees, whatever the file or SI has.
  await page.getByRole("img", { name: "position [mm] over time" }).waitFor();
  await page.getByText("velocity* [mm/s]", { exact: true }).waitFor();
  await page.getByRole("img", { name: /Friction over velocity: force \[N\] over velocity \[mm\/s\]/ }).waitFor();

  // Its unit is corrected.
  await page.getByRole("button", { name: "Position" }).click();
  await page.getByLabel("in the unit").fill("mm");
  await page.getByRole("button", { name: "Write", exact: true }).click();
  await page.getByRole("button", { name: /Position.*position · mm/ }).waitFor();
  equal(/position = .*unit = "mm"/.test(readFileSync(join(space, "axis.toml"), "utf8")), true, "the unit in axis.toml");

  // A stretch is brushed with the mouse and cropped to, another typed and held out.
  const box = await page.locator(".trace .u-over").first().boundingBox();
  await page.mouse.move(box.x + box.width * 0.02, box.y + 40);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width * 0.97, box.y + 40, { steps: 5 });
  await page.mouse.up();
  await page.getByRole("button", { name: "Crop" }).click();
  await page.getByText("written to axis.toml", { exact: true }).waitFor();
  await page.getByLabel("Brush from, s").fill("6.5");
  await page.getByLabel("Brush to, s").fill("8");
  await page.getByLabel("Brush to, s").press("Enter");
  await page.getByRole("button", { name: "Validate" }).click();
  for (let tries = 0; !readFileSync(join(space, "axis.toml"), "utf8").includes('validate = [["6.5 s", "8 s"]]'); tries += 1) {
    if (tries > 50) throw new Error(`not marked: ${readFileSync(join(space, "axis.toml"), "utf8")}`);
    await page.waitForTimeout(100);
  }
  await page.locator(".map canvas").nth(1).waitFor();
  await look("log");
  // What it determines stands in a table of the page.
  await page.getByRole("button", { name: "What can it determine?" }).click();
  const can = page.getByRole("region", { name: "What the log can determine" });
  equal(/determined\s+20\.\d+ N/.test(await can.getByRole("row", { name: /coulomb/ }).innerText({ timeout: 120_000 })), true, "the Coulomb level");
  await can.getByText("A law fits this log and may be used").waitFor();
  equal(await can.getByText(/found before/).count(), 0, "a check that is old at once");
  equal(await can.locator("pre").last().innerText(), "stiction identify run.csv --axis axis.toml --out result", "what to do next");
  await can.evaluate((element) => element.scrollIntoView({ block: "end" }));
  const [ends, covered] = await Promise.all([can.boundingBox(), page.locator(".command").boundingBox()]);
  equal(ends.y + ends.height <= covered.y, true, "what is scrolled to is not covered");
  await look("check");
  await page.evaluate(() => document.querySelector("main").scrollTo(0, 0));
  await page.emulateMedia({ colorScheme: "dark" });
  await look("log-dark");
  await page.emulateMedia({ colorScheme: "light" });
  // The keyboard alone moves along it.
  await page.locator(".trace").focus();
  for (const key of ["+", "+", "ArrowRight", "-", "Home"]) await page.keyboard.press(key);

  for (const name of ["run.csv", "axis.toml"]) copyFileSync(join(space, name), join(twin, name));

  // It is identified.
  await page.getByRole("button", { name: /Identify friction/ }).click();
  await page.waitForFunction(() => document.querySelector(".command code")?.textContent?.startsWith("stiction identify"));
  const identify = await shown();
  equal(identify, "stiction identify run.csv --axis axis.toml --out result", "the line");
  await page.getByRole("button", { name: "Identify", exact: true }).last().click();
  // A reload finds the work again, and so does a second tab.
  await page.locator(".progress, .banner").first().waitFor();
  await page.reload();
  await page.getByText(/May be used for compensation|Not to be used/).waitFor({ timeout: 120_000 });
  await page.locator(".residual canvas").first().waitFor();
  equal(/mm\/s/.test(await page.getByRole("row", { name: /stribeck velocity/ }).innerText()), true, "the unit of a speed");
  await look("identify");
  // What is left in a stretch of it, and the loops of force over position, follow a brush.
  const fit = page.locator(".residual");
  await fit.locator(".map canvas").nth(1).waitFor();
  const over = fit.locator(".u-over").first();
  await over.scrollIntoViewIfNeeded();
  const stretch = await over.boundingBox();
  const all = await fit.getByText("In all:").innerText();
  await page.mouse.move(stretch.x + stretch.width * 0.1, stretch.y + 30);
  await page.mouse.down();
  await page.mouse.move(stretch.x + stretch.width * 0.4, stretch.y + 30, { steps: 4 });
  await page.mouse.up();
  const brushed = await fit.getByText("In the brushed").innerText();
  if (brushed === all) throw new Error("a brush changes nothing");
  await fit.locator(".trace").focus();
  await page.keyboard.press("Escape");
  await fit.getByText("In all:").waitFor();
  await fit.evaluate((element) => element.scrollIntoView({ block: "end" }));
  await look("fit");
  await page.evaluate(() => document.querySelector("main").scrollTo(0, 0));
  typed(identify);
  passed(`identified: ${compare(join(space, "result"), join(twin, "result"), "identify")} files as the command line writes them`);

  // A log of another machine, which has no time column, has an axis file of its own.
  const first = readFileSync(join(space, "axis.toml"), "utf8");
  writeFileSync(join(folder, "slide.csv"), `x [mm],F [N]\n${Array.from({ length: 4000 }, (_, k) => `${(20 * Math.sin(0.01 * k)).toFixed(4)},${(30 * Math.sign(Math.cos(0.01 * k)) - 5 * Math.sin(0.01 * k)).toFixed(4)}`).join("\n")}\n`);
  await page.locator("input[type=file]").setInputFiles(join(folder, "slide.csv"));
  await page.getByText("Something has to be said of this log").waitFor();
  await page.getByText(/so the log is read as it is found/).waitFor();
  await page.getByText(/it is written to slide.axis.toml/).waitFor();
  // Its columns are drawn before anything is said of it.
  for (const name of ["x [mm] over row", "F [N] over row"]) await page.getByRole("img", { name }).locator("canvas").waitFor();
  await page.getByLabel("Sample rate").fill("1 kHz");
  await page.getByLabel("Sample rate").press("Enter");
  await page.locator(".map canvas").nth(1).waitFor();
  equal(readFileSync(join(space, "slide.axis.toml"), "utf8").includes('rate = "1 kHz"'), true, "the rate in the axis file of that log");
  equal(readFileSync(join(space, "axis.toml"), "utf8"), first, "the axis file of the first log");
  await look("rate");
  // What is typed into the text of an axis file stays there while something else is looked at.
  await page.getByText("Text of slide.axis.toml", { exact: true }).first().click();
  await page.locator("textarea").fill(`${readFileSync(join(space, "slide.axis.toml"), "utf8")}# a draft\n`);
  await page.getByRole("button", { name: "Identify", exact: true }).first().click();
  // Nothing of the first log is shown with it, and no line is of another log than what stands above it.
  await page.getByText("No result of slide.csv yet").waitFor();
  equal(await page.getByText(/May be used for compensation|Not to be used/).count(), 0, "results of another log");
  equal(await page.getByLabel("Folder for the result").inputValue(), "result-slide", "a folder of its own");
  await page.waitForFunction(() => document.querySelector(".command code")?.textContent?.startsWith("stiction identify slide.csv"));
  await page.getByRole("button", { name: "Study" }).click();
  await page.getByText("No study of slide.csv yet").waitFor();
  equal(await page.locator(".try").isVisible(), false, "the study of another log");
  await page.getByRole("button", { name: "Export" }).first().click();
  await page.getByText("There is no model of slide.csv yet").waitFor();
  equal(await page.getByRole("button", { name: "Export", exact: true }).count(), 1, "code of another log");
  // A result is chosen with its log.
  await page.getByRole("button", { name: "result of run.csv" }).click();
  await page.getByText(/May be used for compensation|Not to be used/).waitFor();
  await page.waitForFunction(() => document.querySelector(".command code")?.textContent?.startsWith("stiction identify run.csv --axis axis.toml"));
  equal(await page.getByText(/^Not of /).count(), 0, "the log of the result");
  await page.getByRole("button", { name: "slide.csv" }).first().click();
  await page.locator("textarea").waitFor();
  equal((await page.locator("textarea").inputValue()).endsWith("# a draft\n"), true, "the draft is kept");
  await page.getByRole("button", { name: "Take back" }).click();
  await page.getByRole("button", { name: "run.csv" }).first().click();
  await page.getByRole("button", { name: /Position.*position · mm/ }).waitFor();
  passed("a log of another machine");

  // It is simulated with and without compensation.
  await page.getByRole("button", { name: "Study" }).click();
  await page.waitForFunction(() => document.querySelector(".command code")?.textContent?.startsWith("stiction simulate"));
  const simulate = await shown();
  // Each move of a slider is a simulation, seen before anything is simulated as a whole.
  const tried = page.locator(".try");
  await tried.locator(".lines canvas").nth(1).waitFor();
  const took = [];
  for (const name of ["sigma0", "coulomb", "mass"]) {
    const slider = tried.getByRole("slider", { name, exact: true });
    const before = await tried.locator("tbody").innerText();
    await slider.focus();
    for (const key of ["End", "Home", "PageUp", "ArrowRight"]) {
      const answer = page.waitForResponse(/\/api\/trial/);
      await page.keyboard.press(key);
      await (await answer).finished();
      await page.waitForTimeout(30);
      took.push(Number(/Simulated in ([0-9]+) ms/.exec(await tried.innerText())[1]));
    }
    if (name === "coulomb" && (await tried.locator("tbody").innerText()) === before) throw new Error("another friction changes nothing");
  }
  took.sort((a, b) => a - b);
  passed(`a slider moves: simulated in ${took[took.length >> 1]} ms, at most ${took.at(-1)} ms`);
  await page.getByRole("button", { name: "Simulate", exact: true }).click();
  await page.locator(".runs canvas").first().waitFor({ timeout: 120_000 });
  await look("study");
  typed(simulate);
  passed(`simulated: ${compare(join(space, "result/study"), join(twin, "result/study"), "simulate")} files`);

  // Two axes of that model go along a circle.
  await page.getByText("Begin another, of one axis or two").click();
  await page.getByLabel("Second axis, y").selectOption("result/model.toml");
  await page.waitForFunction(() => document.querySelector(".command code")?.textContent?.includes("--second-model"));
  const begun = await shown();
  await page.getByRole("button", { name: "Begin", exact: true }).click();
  await page.getByText("circle-study.toml is begun").waitFor();
  typed(begun);
  equal(readFileSync(join(space, "circle-study.toml"), "utf8"), readFileSync(join(twin, "circle-study.toml"), "utf8"), "the study of two axes");
  await tried.locator(".plane svg").waitFor();
  const still = await tried.locator("tbody").innerText();
  const moved = page.waitForResponse(/\/api\/trial/);
  await tried.getByRole("slider", { name: "y coulomb", exact: true }).press("End");
  await (await moved).finished();
  await page.waitForFunction((before) => document.querySelector(".try tbody").innerText !== before, still);
  // The pictures stay beside the slider that moves them, however far down that stands.
  const drawings = [tried.locator(".plane"), tried.locator(".lines canvas").first()];
  for (const slider of [tried.getByRole("slider").first(), tried.getByRole("slider").last()]) {
    await slider.scrollIntoViewIfNeeded();
    for (const own of drawings) {
      const seen = await own.evaluate((element) => { const { top, bottom } = element.getBoundingClientRect(); return top >= 0 && bottom <= innerHeight; });
      equal(seen, true, "the picture beside a slider");
    }
    equal(await tried.locator("table").evaluate((table) => table.getBoundingClientRect().right <= table.closest(".try").getBoundingClientRect().right), true, "the table stays within its sheet");
  }
  await page.waitForFunction(() => document.querySelector(".command code")?.textContent?.startsWith("stiction simulate circle-study.toml"));
  const circle = await shown();
  await page.getByRole("button", { name: "Simulate", exact: true }).click();
  await page.locator(".runs .plane svg").waitFor({ timeout: 120_000 });
  await look("contour-try");
  await page.locator(".runs").evaluate((element) => element.scrollIntoView({ block: "end" }));
  await look("contour");
  await page.evaluate(() => document.querySelector("main").scrollTo(0, 0));
  typed(circle);
  passed(`two axes simulated: ${compare(join(space, "circle-study"), join(twin, "circle-study"), "simulate two axes")} files`);

  // The code is taken.
  await page.getByRole("button", { name: "Export" }).first().click();
  await page.getByLabel("mass", { exact: true }).check();
  await page.waitForFunction(() => document.querySelector(".command code")?.textContent?.includes("--feedforward friction,mass"));
  const line = await shown();
  await page.getByRole("button", { name: "Export", exact: true }).last().click();
  const save = page.getByRole("button", { name: "Download as zip" });
  await save.waitFor();
  await look("export");
  const [download] = await Promise.all([page.waitForEvent("download"), save.click()]);
  equal(download.suggestedFilename(), "c.zip", "the name of the zip");
  equal(readFileSync(await download.path()).subarray(0, 2).toString(), "PK", "a zip");
  typed(line);
  passed(`exported: ${compare(join(space, "result/c"), join(twin, "result/c"), "export")} files`);

  // A motion is planned, once the axis file has limits, which are typed on the page.
  await page.getByRole("button", { name: "Plan" }).first().click();
  await page.getByText("Limits and all else of the axis file").click();
  const area = page.locator("textarea");
  await area.fill(`${await area.inputValue()}\n[limits]\nstroke = ["-100 mm", "100 mm"]\nspeed = "0.2 m/s"\nacceleration = "6 m/s2"\nrated_force = "150 N"\nmass = "10 kg"\n`);
  await page.getByRole("button", { name: /^Write axis.toml/ }).click();
  await page.getByText("axis.toml is written").waitFor();
  await page.getByLabel("Longest motion [s]").fill("3");
  await page.waitForFunction(() => document.querySelector(".command code")?.textContent?.includes("--time 3s"));
  const plan = await shown();
  await page.getByRole("button", { name: "Plan", exact: true }).last().click();
  // A plan takes long on a busy machine: it is stopped where it has not ended, and either way its motion is there.
  const stop = page.getByRole("button", { name: "Stop and keep what was found" });
  const drawn = page.locator(".runs canvas").first();
  const became = await Promise.race([stop.waitFor({ timeout: 120_000 }).then(() => "runs"), drawn.waitFor({ timeout: 120_000 }).then(() => "done")]);
  // Pressed as long as a person presses; it may end by itself meanwhile.
  const fails = async (error) => {
    if (await stop.isVisible()) throw error;
  };
  if (became === "runs") await stop.click({ delay: 150, timeout: 5_000 }).catch(fails);
  // Asked at one instant: a plan that ends between two questions would be seen in one of them alone.
  const beside = await page.evaluate(() => !document.querySelector(".progress") || document.querySelector(".working").innerText.includes("plan axis.toml"));
  equal(beside, true, "the work is seen beside the files");
  await page.getByText("Set points as CSV").or(page.getByText("Stopped: what was found until then")).or(page.getByText("Stopped before anything was found")).first().waitFor({ timeout: 240_000 });
  await look("plan");
  passed(`planned: ${plan}`);

  // What became of a plan stands with its axis file alone.
  await page.getByLabel("Limits of").selectOption("slide.axis.toml");
  await page.getByRole("button", { name: "Plan", exact: true }).last().click();
  await page.getByRole("alert").getByText("Not done").waitFor();
  await page.getByLabel("Limits of").selectOption("axis.toml");
  await page.getByRole("alert").waitFor({ state: "detached" });

  // Static parameters by a search from constant velocities, then presliding from a motion with them held.
  const logs = join(folder, "procedures");
  execFileSync(program, ["demo", "--procedures", "--quiet", "--out", logs]);
  // Least squares follow each search, so that it need not go to the end.
  writeFileSync(join(logs, "motion.axis.toml"), 'kind = "linear"\n\n[search.annealing-ga]\ngenerations = 10\nrounds = 2\n');
  const help = execFileSync(program, ["identify", "--help"], { encoding: "utf8" });
  const taken = ["motion.axis.toml", "motion.csv", "speeds.csv"];
  await page.locator("input[type=file]").setInputFiles(taken.map((name) => join(logs, name)));
  for (const name of taken) copyFileSync(join(logs, name), join(twin, name));
  for (const [log, method, out, words] of [
    ["speeds.csv", "static", "result-speeds", "--method static --search annealing-ga"],
    ["motion.csv", "static-then-dynamic", "result-motion", "--axis motion.axis.toml --method static-then-dynamic --search annealing-ga --static speeds.csv"],
  ]) {
    const line = `stiction identify ${log} ${words} --out ${out}`;
    // The last one that was taken is chosen already.
    if (log !== taken.at(-1)) await page.getByRole("button", { name: log }).first().click();
    await page.waitForFunction((start) => document.querySelector(".command code")?.textContent?.startsWith(start), `stiction check ${log}`);
    await page.getByRole("button", { name: "Identify", exact: true }).first().click();
    await page.getByText("More", { exact: true }).click();
    await page.getByLabel("Method").selectOption(method);
    await page.getByLabel("Searched before least squares by").selectOption("annealing-ga");
    const values = await page.getByLabel("Searched before least squares by").locator("option").evaluateAll((all) => all.map((one) => one.value).filter(Boolean));
    equal(values.join(), /--search <.*?values: (.*?)\]/s.exec(help)[1].replace(/\s/g, ""), "the searches");
    if (method !== "static") await page.getByLabel("speeds.csv", { exact: true }).check();
    await page.waitForFunction((wanted) => document.querySelector(".command code")?.textContent === wanted, line);
    await page.getByRole("button", { name: "Identify", exact: true }).last().click();
    await page.getByRole("heading", { name: out }).waitFor({ timeout: 240_000 });
    await page.locator(".residual canvas").first().waitFor();
    typed(line);
    passed(`${method}: ${compare(join(space, out), join(twin, out), method)} files`);
  }
  await look("two-steps");

  // A log is compared with one of before: here the same motion with 0.4 of the following error.
  const [header, ...rows] = readFileSync(join(folder, "demo", "demo.csv"), "utf8").trimEnd().split("\n");
  writeFileSync(join(folder, "before.csv"), `${[header, ...rows].join("\n")}\n`);
  writeFileSync(join(folder, "after.csv"), `${[header, ...rows.map((row) => {
    const [time, reference, position, force] = row.split(",");
    return [time, reference, (Number(reference) + 0.4 * (Number(position) - Number(reference))).toFixed(6), force].join();
  })].join("\n")}\n`);
  await page.locator("input[type=file]").setInputFiles(["before.csv", "after.csv"].map((name) => join(folder, name)));
  await page.getByRole("heading", { name: "after.csv" }).waitFor();
  await page.getByRole("button", { name: "Before and after" }).click();
  await page.getByLabel("Before", { exact: true }).selectOption("before.csv");
  await page.waitForFunction(() => document.querySelector(".command code")?.textContent === "stiction check before.csv after.csv");
  await page.getByRole("button", { name: "Compare" }).click();
  await page.getByText(/^Worse at none of \d+ reversals/).waitFor({ timeout: 120_000 });
  equal(/(59|60)\.\d+ % less/.test(await page.getByRole("row", { name: /median peak/ }).innerText()), true, "what changed");
  for (const name of [/Largest error at each reversal: before, after/, /Friction over velocity: force \[N\] over velocity \[mm\/s\]/]) await page.getByRole("img", { name }).waitFor();
  await look("change");

  // Friction over time, of a batch whose last logs have more of it.
  mkdirSync(join(folder, "runs"));
  for (let day = 0; day < 45; day += 1) {
    const coulomb = (day < 30 ? 20 : 26) + 0.2 * Math.sin(2.3 * day);
    const rows = Array.from({ length: 2000 }, (_, k) => {
      const t = 2e-3 * k;
      const [x, v] = [50 * Math.sin(6 * t), 0.3 * Math.cos(6 * t)];
      return `${t.toFixed(3)},${x.toFixed(5)},${(coulomb * Math.sign(v) + 60 * v - 9 * 0.036 * x + 0.5 * Math.sin(1e4 * t + day)).toFixed(4)}`;
    });
    writeFileSync(join(folder, "runs", `run-${new Date(Date.UTC(2026, 2, 1 + day)).toISOString().slice(0, 10)}.csv`), `time [s],position [mm],force [N]\n${rows.join("\n")}\n`);
  }
  try {
    execFileSync(program, ["batch", "runs", "--law", "coulomb-viscous", "--quiet", "--out", join(space, "batch")], { cwd: folder });
  } catch (error) {
    if (error.status > 1) throw error;
  }
  await page.reload();
  await page.getByRole("button", { name: "Drift" }).click();
  await page.waitForFunction(() => document.querySelector(".command code")?.textContent === "stiction drift batch/results.parquet");
  equal(await page.getByRole("button", { name: /results.parquet/ }).count(), 0, "a table among the logs");
  await page.getByRole("button", { name: "Follow" }).click();
  await page.getByText("1 of 1 machine changed").waitFor({ timeout: 120_000 });
  equal(/step\tlog 3[01]\t/.test(await page.getByRole("row", { name: /coulomb/ }).first().innerText()), true, "what changed over time");
  await page.getByRole("img", { name: /^coulomb .*coulomb \[N\] over logs, 45 points$/ }).waitFor();
  await page.getByLabel("times are the dates in the names of the logs").check();
  await page.getByRole("button", { name: "Follow" }).click();
  await page.getByRole("row", { name: /step 2026-03-31/ }).waitFor({ timeout: 120_000 });
  await look("drift");

  // Another tab has the same session; a page without it is told so.
  const tab = await context.newPage();
  await tab.goto(`${new URL(address).origin}/#view=export`);
  await tab.getByRole("heading", { name: "Export" }).waitFor();
  const stranger = await (await browser.newContext()).newPage();
  await stranger.goto(new URL(address).origin);
  await stranger.getByText("This browser has no session here.").waitFor();
  // A server that starts the browser hands it a file, which is gone once the page is there.
  const own = await openedBy();
  try {
    equal(/token|127\.0\.0\.1/.test(own.file), false, "the address is in the arguments");
    const forwarded = await (await browser.newContext()).newPage();
    await forwarded.goto(`file://${own.file}`);
    await forwarded.getByRole("button", { name: "run.csv" }).first().waitFor();
    equal(forwarded.url().includes("token"), false, "the token is gone from the address");
    equal(existsSync(own.file), false, "the file is there still");
    await forwarded.reload();
    await forwarded.getByRole("button", { name: "run.csv" }).first().waitFor();
  } finally {
    own.server.kill();
  }
  if (wrong.length) throw new Error(`errors on the page: ${wrong.join("; ")}`);
  passed("done");
} finally {
  await browser.close();
  server.kill();
  rmSync(folder, { recursive: true, force: true });
}
