// Identification: a few choices, the work as it goes, and what came of it beside another result.

import { binary, get, open, type Channel, type Stretch } from "../api";
import { commandLine } from "../command";
import { attempt, choice, field, h, put, warned } from "../dom";
import { begin, failed, isRunning, latest, progress } from "../jobs";
import { PointMap, type Points } from "../map";
import { length, quantity, short, shownUnit, unit } from "../numbers";
import { readResult, whence, type Origin } from "../origin";
import { choose, entry, files, labelled, nameOf, onChange, state, stem } from "../state";
import { Trace } from "../trace";

const LAWS: [string, string][] = [
  ["auto", "Let the data choose"],
  ["lugre", "With presliding and Stribeck effect (LuGre)"],
  ["gms", "With memory of past reversals (GMS)"],
  ["maxwell-slip", "Memory, no Stribeck effect (Maxwell slip)"],
  ["elasto-plastic", "LuGre that does not creep at rest"],
  ["dahl", "Presliding and Coulomb only (Dahl)"],
  ["stribeck", "Curve over velocity only (Stribeck)"],
  ["coulomb-viscous", "Coulomb and viscous only"],
];
const METHODS: [string, string][] = [
  ["separable", "From motion to force (usual)"],
  ["output-error", "Simulating the axis from its force"],
  ["static", "Steady curve, from constant velocities"],
  ["static-then-dynamic", "Steady curve first, then presliding"],
];
/** Names of the command line, with what they are. */
const SEARCHES: [string, string][] = [
  ["ga", "plain genetic algorithm"],
  ["adaptive-ga", "genetic algorithm with adaptive rates"],
  ["annealing-ga", "Zhang et al. 2025, genetic with annealing"],
  ["niched-ga", "annealing genetic algorithm in niches"],
  ["de", "differential evolution"],
  ["cma-es", "covariance matrix adaptation"],
  ["pso", "particle swarm"],
  ["annealing", "simulated annealing"],
  ["nelder-mead", "simplex method, restarted"],
  ["lm", "least squares from many starts"],
];

interface Parameter { name: string; symbol: string; value: number; unit: string; std: number | null; ci95: [number | null, number | null] | null; identifiable: boolean; origin: string; reason: string; advice: string }
interface Fit { signal: string; unit: string; rmse: number; relative_error_percent: number; r2: number | null; samples: number }
interface Result extends Origin {
  law: string; asymmetric: boolean; method: string; inputs: { path: string; sha256: string; samples: number; part?: string | null }[];
  parameters: Parameter[]; fit: Fit; validation: (Fit & { path: string })[];
  trust: { trustworthy: boolean; reasons: string[]; cause?: Cause | null; constants: string[]; next: string | object; compensation: { friction_left_percent: number; judged_on: string } | null };
  laws?: { law: string; asymmetric: boolean; held_out_percent?: number; relative_error_percent?: number }[];
  warnings: { code: string; message: string }[];
  static_map?: { velocity_unit: string; force_unit: string; points: { velocity: number; force: number; model: number }[] };
}

/** What the law leaves, and what takes it into the fit: a line of the axis file or another law. */
interface Cause { text: string; size: string; cure?: { line?: { table: string; line: string } | string; table?: string; law?: { law: string } | string } | null }

/** What is drawn of a fit: the stretch about its slowest reversal, and what is force over position and over velocity in it. */
interface Drawable { from: number | null; to: number | null; channels: Channel[]; turn: Stretch | null; loop: Pairs | null; curve: Pairs | null }
/** Names of channels, or none where the model is drawn over what was measured. */
interface Pairs { measured: [x: string, y: string]; model: [x: string, y: string] }
interface Left { samples: number; rms: number; percent: number }

/** Work that this page began, whose result is shown once it is there. */
const ran = new Set<number>();

export class IdentifyView {
  readonly element = h("div", { class: "view identify" });
  private readonly command = commandLine();
  private readonly form = h("section", { class: "form", "aria-label": "What is identified" });
  private readonly work = h("section", { "aria-label": "Work", "aria-live": "polite" });
  private readonly found = h("section", { class: "found", "aria-label": "Result" });
  private readonly stop: () => void;
  private law = "auto";
  private method = "separable";
  private search = "";
  /** Logs of constant velocities. */
  private statics: string[] = [];
  private asymmetric = false;
  private validation = "";
  private out = "result";
  /** Whether the folder for the result was typed. */
  private named = false;
  private beside = "";
  private drawn: { end(): void }[] = [];
  private shown = "";
  private readonly whence = h("div", {});
  /** The result that is shown. */
  private origin: { of: Result; folder: string } | null = null;

  constructor() {
    put(this.element, h("div", { class: "head" }, h("h2", {}, "Identify")), h("div", { class: "split" }, this.form, h("div", { class: "center" }, this.work, this.found)), this.command.element);
    this.stop = onChange((reason) => {
      if (reason !== "jobs") this.drawForm();
      this.drawWork();
      if (reason !== "jobs") void this.drawResult();
    });
    this.drawForm();
    this.drawWork();
    void this.drawResult();
  }

  end(): void {
    this.stop();
    this.clear();
  }

  private clear(): void {
    for (const own of this.drawn) own.end();
    this.drawn = [];
  }

  private asked(): Record<string, unknown> {
    const { log, axis } = state.chosen;
    const asked: Record<string, unknown> = { kind: "identify", logs: log ? [log] : [], axis, out: this.out };
    if (this.law !== "auto") asked["law"] = this.law;
    if (this.method !== "separable") asked["method"] = this.method;
    if (this.search && this.method.startsWith("static")) asked["search"] = this.search;
    if (this.method === "static-then-dynamic") asked["statics"] = this.others().filter((name) => this.statics.includes(name));
    if (this.asymmetric) asked["asymmetric"] = true;
    if (this.validation === "half") asked["split"] = 0.5;
    else if (this.validation) asked["validate"] = [this.validation];
    return asked;
  }

  /** The logs beside the chosen one. */
  private others(): string[] {
    return files("log").map((file) => file.name).filter((name) => name !== state.chosen.log);
  }

  private drawForm(): void {
    const { log, axis } = state.chosen;
    const again = () => this.command.of(this.asked());
    // A folder of its own for a log where that of the usual name is of another one, which would be written over.
    const usual = entry("result");
    if (!this.named && log) this.out = !usual?.of.length || usual.of.some((own) => own.name === log) ? "result" : `result-${stem(log.replaceAll("/", "-"))}`;
    const others = this.others();
    const out = h("input", { type: "text", value: this.out, spellcheck: "false", oninput: () => { this.out = out.value.trim(); this.named = true; again(); } });
    const asymmetric = h("input", { type: "checkbox", checked: this.asymmetric, onchange: () => { this.asymmetric = asymmetric.checked; again(); } });
    const part = (name: string) => {
      const own = h("input", { type: "checkbox", checked: this.statics.includes(name), onchange: () => {
        this.statics = own.checked ? [...this.statics, name] : this.statics.filter((each) => each !== name);
        again();
      } });
      return h("label", { class: "check" }, own, ` ${name}`);
    };
    put(
      this.form,
      h("dl", { class: "facts" }, h("dt", {}, "Log"), h("dd", {}, log ?? "none yet"), h("dt", {}, "Axis file"), h("dd", {}, axis ?? "none: as found")),
      field("Friction", choice(LAWS, this.law, (value) => { this.law = value; again(); })),
      h("label", { class: "check" }, asymmetric, " different in each direction"),
      field("Held against", choice([["", "stretches marked on the log, if any"], ["half", "the second half of the log"], ...others.map((name): [string, string] => [name, name])], this.validation, (value) => { this.validation = value; again(); }), "What is held out shows whether the law predicts what it has not seen."),
      h(
        "details",
        { open: this.method !== "separable" },
        h("summary", {}, "More"),
        field("Method", choice(METHODS, this.method, (value) => { this.method = value; this.drawForm(); })),
        this.method.startsWith("static") ? field("Searched before least squares by", choice([["", "nothing"], ...SEARCHES.map(([name, what]): [string, string] => [name, `${name}: ${what}`])], this.search, (value) => { this.search = value; again(); })) : null,
        this.method === "static-then-dynamic" ? h("fieldset", {}, h("legend", {}, "Logs of constant velocities; none: the log itself"), ...others.map(part)) : null,
      ),
      field("Folder for the result", out),
      h("button", { class: "primary wide", disabled: !log, onclick: () => void this.run() }, "Identify"),
    );
    again();
  }

  private async run(): Promise<void> {
    const id = await begin(this.asked());
    if (id !== undefined) ran.add(id);
  }

  private drawWork(): void {
    const { log } = state.chosen;
    const job = latest("identify", (own) => own.about === log);
    if (!job) {
      put(this.work);
      return;
    }
    if (isRunning(job)) {
      put(this.work, progress(job));
      return;
    }
    put(this.work, job.state === "failed" ? failed(job) : null);
    if (job.state === "done" && ran.delete(job.id) && job.folder) {
      const folder = job.folder;
      // The list of files may not have it yet.
      if (state.workspace.files.some((file) => file.name === folder)) choose({ result: folder });
      else {
        const stop = onChange((reason) => {
          if (reason !== "files") return;
          stop();
          if (log === state.chosen.log) choose({ result: folder });
        });
      }
    }
  }

  private async drawResult(): Promise<void> {
    const { log, result } = state.chosen;
    const file = state.workspace.files.find((own) => own.name === `${result}/result.json`);
    const now = JSON.stringify([result ?? [log], file?.modified, this.beside]);
    if (now === this.shown) {
      this.drawOrigin();
      return;
    }
    this.shown = now;
    this.origin = null;
    this.clear();
    if (!result) {
      put(this.found, h("p", { class: "muted" }, `${log ? `No result of ${log} yet. Press` : "No result yet. Choose a log and press"} Identify; the defaults are meant to be right.`));
      return;
    }
    const own = await attempt(() => readResult<Result>(result));
    const other = this.beside && this.beside !== result ? await attempt(() => readResult<Result>(this.beside)) : undefined;
    if (!own || this.shown !== now) return;
    const others = labelled("result").filter(([name]) => name !== result);
    const compare = choice([["", "nothing"], ...others], this.beside, (value) => { this.beside = value; void this.drawResult(); });
    put(
      this.found,
      h("div", { class: "row spread" }, h("h3", {}, result), others.length ? h("label", { class: "row" }, "beside ", compare) : null),
      this.whence,
      banner(own),
      h("div", { class: "row" }, ...next(own, result), h("button", { onclick: () => void attempt(() => open(`${result}/report.html`, "show")) }, "Full report"), h("button", { class: "quiet", onclick: () => void attempt(() => open(result, "zip")) }, "Download as zip")),
      parameters(own, other, this.beside),
      quality(own, other),
      h("div", { class: "residual" }),
      other ? h("div", { class: "residual" }) : null,
      warnings(own),
    );
    this.origin = { of: own, folder: result };
    this.drawOrigin();
    const places = [...this.found.querySelectorAll(".residual")];
    const both = [[result, own], [this.beside, other]] as const;
    for (const [k, [name, one]] of both.entries()) {
      const place = places[k];
      if (one && place) await attempt(() => this.residual(place, name, one, Boolean(other)));
    }
  }

  /** What the result is of, which may change after it. */
  private drawOrigin(): void {
    if (this.origin) put(this.whence, ...whence(this.origin.of, this.origin.folder));
  }

  /** Measured, model and what is left over the time, and what is left in a stretch that is brushed. */
  private async residual(place: Element, result: string, own: Result, several: boolean): Promise<void> {
    const title = (text: string) => h("h3", {}, several ? `${text}: ${result}` : text);
    const steady = own.static_map;
    if (steady && own.method === "static") {
      // Means over stretches, which no trace goes through.
      const [speed, by] = shownUnit(steady.velocity_unit);
      const map = new PointMap("Friction over velocity", [`velocity [${speed}]`, `friction [${unit(steady.force_unit)}]`], 220);
      const over = (name: "force" | "model"): Points => ({ x: Float64Array.from(steady.points, (one) => by * one.velocity), y: Float64Array.from(steady.points, (one) => one[name]) });
      this.drawn.push(map);
      put(place, title("Measured and model"), map.element);
      map.draw(over("force"), undefined, over("model"));
      return;
    }
    const shown = this.shown;
    const fit = await get<Drawable>("/api/fit", { result });
    if (this.shown !== shown || fit.from === null || fit.to === null) return;
    const name = `${result}/fit.csv`;
    const channels = (...names: string[]) => names.map((one) => fit.channels.find((channel) => channel.name === one)).filter((channel) => channel !== undefined);
    const axis = (names: [string, string] | undefined): [string, string] => {
      const [x, y] = [0, 1].map((k) => fit.channels.find((channel) => channel.name === names?.[k]));
      return [`${x?.name === "measured" ? "position" : x?.name ?? ""} [${unit(x?.unit ?? "")}]`, `${y?.name ?? ""} [${unit(y?.unit ?? "")}]`];
    };
    const maps: [PointMap, Pairs][] = [];
    for (const [title, pairs] of [["Force over position", fit.loop], ["Friction over velocity", fit.curve]] as const) {
      if (pairs) maps.push([new PointMap(title, axis(pairs.measured), 220), pairs]);
    }
    const said = h("p", { class: "muted small", "aria-live": "polite" });
    let asked = 0;
    const brushed = async (stretch: Stretch | null) => {
      asked += 1;
      const mine = asked;
      const [from, to] = stretch ?? [fit.from!, fit.to!];
      const left = await get<Left>("/api/left", { result, from, to });
      if (mine !== asked) return;
      const where = stretch ? `In the brushed ${short(to - from)} s` : "In all";
      put(said, `${where}: ${length(left.rms, own.fit.unit)} rms are left, ${short(left.percent)} % of what was measured, over ${left.samples} samples. Drag over the traces to look at a stretch; without one the map of positions shows the slowest reversal.`);
      for (const [map, pairs] of maps) {
        const [start, end] = stretch ?? (pairs === fit.loop ? fit.turn : null) ?? [from, to];
        const names = [...pairs.measured, ...pairs.model];
        const buffer = await binary("/api/map", { name, table: true, channels: names.join(","), from: start, to: end });
        if (mine !== asked) return;
        const [count = 0] = new Uint32Array(buffer, 0, 2);
        const column = (at: number) => new Float64Array(buffer, 8 + 8 * count * at, count);
        const points = (at: number): Points => ({ x: column(at), y: column(at + 1) });
        map.draw(points(0), undefined, points(2));
      }
    };
    let due = 0;
    const trace = new Trace({
      source: { name, table: true },
      panels: [{ title: own.fit.signal || "force", channels: channels("measured", "model") }, { title: "residual", channels: channels("residual") }],
      from: fit.from,
      to: fit.to,
      height: 110,
      label: `Measured, model and residual of ${result}`,
      brushed: (stretch) => {
        clearTimeout(due);
        due = window.setTimeout(() => void attempt(() => brushed(stretch)), 60);
      },
    });
    this.drawn.push(trace, ...maps.map(([map]) => map));
    put(place, title("Measured, model and what is left"), trace.element, said, h("div", { class: "maps" }, ...maps.map(([map]) => map.element)));
    await brushed(null);
  }
}

function banner(own: Result): HTMLElement {
  const { trustworthy, reasons, cause, constants, compensation } = own.trust;
  if (!trustworthy) {
    return h("div", { class: "banner warn" }, h("strong", {}, "Not to be used for compensation as it is"), ...reasons.map((reason) => h("p", {}, reason)));
  }
  const cure = cause?.cure;
  const on = JUDGED_ON[compensation?.judged_on ?? ""] ?? "the log";
  return h(
    "div",
    { class: `banner ${cause ? "warn" : "good"}` },
    h("strong", {}, "May be used for compensation", cause ? `, though ${cause.text}` : ""),
    cause ? h("p", {}, `That is ${cause.size}.`, cured(cure)) : null,
    compensation ? h("p", {}, `It leaves ${short(compensation.friction_left_percent)} % of the friction on ${on}.`) : null,
    constants.length ? null : h("p", {}, "The log leaves every parameter open: none is a constant of the machine."),
  );
}

/// What a cure asks for, also as results of earlier versions state it.
function cured(cure: Cause["cure"]): string {
  const line = typeof cure?.line === "string" ? { table: cure.table, line: cure.line } : cure?.line;
  if (line) return ` Write ${line.line} under [${line.table}] in the axis file and identify again.`;
  const law = typeof cure?.law === "string" ? cure.law : cure?.law?.law;
  return law ? ` Try the law ${law}.` : "";
}

const JUDGED_ON: Record<string, string> = {
  "held-out": "samples it was not fitted to",
  validation: "the validation data",
  fitted: "the samples it was fitted to",
};

function next(own: Result, result: string): HTMLElement[] {
  const go = (view: "study" | "export" | "plan" | "log", label: string, primary = true) => h("button", { class: primary ? "primary" : "", onclick: () => choose({ view, result }) }, label);
  const action = own.trust.next;
  switch (typeof action === "string" ? action : Object.keys(action ?? {})[0]) {
    case "export":
      return [go("study", "Try compensation →"), go("export", "Take the code →", false)];
    case "check":
      return [go("log", "Look at the log →"), go("plan", "Plan a better motion →", false)];
    default:
      return [go("study", "Try compensation →", false), go("plan", "Plan a better motion →", false)];
  }
}

function interval(p: Parameter): string {
  if (p.origin === "given") return "given";
  if (!p.ci95) return "not bounded";
  const [, by] = shownUnit(p.unit);
  const [low, high] = p.ci95.map((end) => (end === null ? null : by * end));
  if (low == null) return `at most ${short(high)}`;
  if (high == null) return `at least ${short(low)}`;
  return `${short(low)} … ${short(high)}`;
}

function parameters(own: Result, other: Result | undefined, beside: string): HTMLElement {
  const row = (p: Parameter) => {
    const q = other?.parameters.find((one) => one.name === p.name);
    const open = !p.identifiable;
    const [shown, by] = shownUnit(p.unit);
    return h(
      "tr",
      { class: open ? "open" : "" },
      h("th", { scope: "row" }, p.name.replaceAll("_", " "), " ", h("span", { class: "symbol" }, p.symbol)),
      h("td", { class: "number" }, short(by * p.value)),
      h("td", {}, shown),
      h("td", { class: "number" }, interval(p)),
      h("td", {}, open ? h("span", { class: "tag warn", title: `${p.reason} ${p.advice}`.trim() }, "open") : p.origin === "given" ? "" : own.trust.constants.includes(p.name) ? h("span", { class: "tag good" }, "constant") : ""),
      other ? h("td", { class: "number" }, q ? (q.unit === p.unit ? short(by * q.value) : quantity(q.value, q.unit)) : "–") : null,
      other ? h("td", { class: "number" }, q ? interval(q) : "–") : null,
    );
  };
  return h(
    "table",
    { class: other ? "beside" : null },
    h("caption", {}, `${own.law}${own.asymmetric ? ", asymmetric" : ""}: parameters with 95 % intervals`),
    h("thead", {}, h("tr", {}, ...["parameter", "value", "unit", "interval", "of the machine"].map((text) => h("th", { scope: "col" }, text)), other ? h("th", { scope: "col", colspan: "2" }, `${beside}: ${other.law}${other.inputs.some((input) => own.inputs.some((one) => one.sha256 === input.sha256)) ? "" : `, of ${nameOf(other.inputs[0]?.path ?? "")}`}`) : null)),
    h("tbody", {}, ...own.parameters.map(row)),
  );
}

function quality(own: Result, other: Result | undefined): HTMLElement {
  const fit = (label: string, f: Fit, g?: Fit) => h("tr", {}, h("th", { scope: "row" }, label), h("td", { class: "number" }, `${short(f.relative_error_percent)} %`), h("td", { class: "number" }, `${length(f.rmse, f.unit)} rms`), other ? h("td", { class: "number" }, g ? `${short(g.relative_error_percent)} %` : "–") : null);
  return h("table", {}, h("caption", {}, "How well it fits"), h("tbody", {}, fit("fitted", own.fit, other?.fit), ...own.validation.map((one, k) => fit(`held out: ${one.path}`, one, other?.validation[k]))));
}

function warnings(own: Result): HTMLElement | null {
  if (!own.warnings.length) return null;
  return h("div", {}, h("h3", {}, "Warnings"), warned(own.warnings));
}
