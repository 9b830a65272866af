// A study: the identified axis with and without compensation, simulated.

import { get, open, post, type Channel } from "../api";
import { commandLine } from "../command";
import { attempt, choice, field, h, put, say, warned } from "../dom";
import { editor } from "../editor";
import { begin, failed, isRunning, latest, printed, progress } from "../jobs";
import { length, short } from "../numbers";
import { older, whenceOf } from "../origin";
import { changedAt, entry, exists, files, fits, follow, labelled, nameOf, onChange, refresh, state } from "../state";
import { Lines } from "../lines";
import { Plane, type PlaneData } from "../plane";
import { Trace } from "../trace";
import { Try } from "./try";

interface Metric { name: string; unit: string; mean: number; reduction_percent: number | null }
interface Row { path: string; controller: string; compensator: string; parameters: string; coupled: boolean; metrics: Metric[] }
interface OnContour { unit: string; plane: PlaneData; runs: { name: string; time: number[]; deviation: number[] }[] }
interface Table { from: number | null; to: number | null; channels: Channel[]; runs: string[] }
interface Promised { path: string; controller: string; compensator: string; left90_percent: [number, number]; draws: number; gain: number }
interface StudyFile { inputs: { path: string; sha256: string }[]; promise?: Promised[]; results: Row[]; warnings: { code: string; message: string }[] }

export class StudyView {
  readonly element = h("div", { class: "view study" });
  private readonly command = commandLine();
  private readonly form = h("section", { class: "form", "aria-label": "What is simulated" });
  private readonly work = h("section", { "aria-label": "Work", "aria-live": "polite" });
  private readonly found = h("section", { class: "found", "aria-label": "What came of it" });
  private readonly whence = h("div", {});
  private readonly stop: () => void;
  private readonly tried = new Try();
  private study = "";
  private out = "";
  private trace: Trace | null = null;
  /** What is drawn of it: a file of courses and a run in it. */
  private course = "";
  private deviation: Lines | null = null;
  private shown = "";
  private editing = "";
  /** A result that has no study. */
  private lacks = "";
  private begins = false;
  /** What a study is begun of, while it is chosen. */
  private beginsOf: { model: string | null; second: string | null; name: string } | null = null;

  constructor() {
    put(this.element, h("div", { class: "head" }, h("h2", {}, "Study"), h("span", { class: "muted" }, "the axis with and without compensation, simulated")), h("div", { class: "split" }, this.form, h("div", { class: "center" }, this.whence, this.tried.element, this.work, this.found)), this.command.element);
    this.usual();
    this.stop = onChange((reason) => {
      const moves = reason !== "jobs" && (!this.study || !fits(this.study));
      if (moves) this.usual();
      if (reason === "files" || moves) this.drawForm();
      else if (reason === "chosen") void this.drawOrigin();
      this.drawWork();
      if (reason !== "jobs") void this.drawStudied();
    });
    this.drawForm();
    this.drawWork();
    void this.drawStudied();
  }

  end(): void {
    this.stop();
    this.tried.end();
    this.clear();
  }

  private clear(): void {
    this.trace?.end();
    this.deviation?.end();
    this.trace = null;
    this.deviation = null;
  }

  /** The study of the chosen result, else another one of the chosen log. */
  private usual(): void {
    const { result } = state.chosen;
    const own = `${result}/study.toml`;
    this.lacks = result && !exists(own) && exists(`${result}/model.toml`) ? result : "";
    this.pick(result && exists(own) ? own : this.lacks ? "" : (files("study").find((file) => fits(file.name))?.name ?? ""));
  }

  private pick(study: string): void {
    this.study = study;
    this.out = study.replace(/\.toml$/, "");
    this.course = "";
  }

  /** Shows another study, and moves to the log that it comes from. */
  private choose(study: string): void {
    this.pick(study);
    this.drawForm();
    this.drawWork();
    void this.drawStudied();
    const result = study.replace(/\/?[^/]*$/, "");
    void follow(study, exists(`${result}/result.json`) ? { result } : {});
  }

  private asked() { return { kind: "simulate", study: this.study, out: this.out }; }

  private drawForm(): void {
    const all = labelled("study");
    this.tried.of(this.study);
    void this.drawOrigin();
    const another = all.length ? field("Another study", choice([["", "choose"], ...all], "", (value) => { if (value) this.choose(value); })) : null;
    if (!this.study && this.lacks) {
      put(
        this.form,
        older(`${this.lacks} has no study`, "An identification begins one where it may be relied on and its force is in N or N·m. Of a current or a voltage, say in the log view what one of it is worth, such as 96 N/A, and identify again."),
        another,
      );
      this.command.show("stiction simulate STUDY.toml --out FOLDER");
      return;
    }
    if (!this.study) {
      const { log } = state.chosen;
      put(this.form, h("p", {}, `${log ? `No study of ${log} yet. A` : "A"} study needs a model. An identification that may be used writes one with it.`), another, ...this.beginning(exists("study.toml") ? "circle-study.toml" : "study.toml"));
      return;
    }
    const out = h("input", { type: "text", value: this.out, spellcheck: "false", oninput: () => { this.out = out.value.trim(); this.command.of(this.asked()); } });
    const place = h("div", {});
    put(
      this.form,
      field("Study file", choice(all, this.study, (value) => this.choose(value))),
      place,
      field("Folder for the result", out),
      h("button", { class: "primary wide", onclick: () => void begin(this.asked()) }, "Simulate"),
      this.another(),
    );
    if (this.editing !== this.study) this.editing = this.study;
    void editor(this.study, "Paths, controllers and compensators").then((own) => put(place, own));
    this.command.of(this.asked());
  }

  /** Another study, such as one of two axes. */
  private another(): HTMLElement {
    const details = h("details", { open: this.begins }, h("summary", {}, "Begin another, of one axis or two"));
    details.addEventListener("toggle", () => {
      this.begins = details.open;
      if (details.open) put(details, details.firstElementChild, ...this.beginning("circle-study.toml"));
      else this.command.of(this.asked());
    });
    return details;
  }

  /** What a study is begun of: a model, or two along a circle. */
  private beginning(file: string): HTMLElement[] {
    const models = labelled("model");
    const usual = models.find(([name]) => name === `${state.chosen.result}/model.toml`)?.[0] ?? files("model").find((file) => fits(file.name))?.name ?? null;
    const asked = (this.beginsOf ??= { model: usual, second: null, name: file });
    const show = () => this.command.of(asked, "/api/study/command");
    const name = h("input", { type: "text", value: asked.name, spellcheck: "false", oninput: () => { asked.name = name.value.trim(); show(); } });
    show();
    return [
      field("Axis", choice([...models, ["", "a known one, a linear motor"]], asked.model ?? "", (value) => { asked.model = value || null; if (!value) asked.second = null; show(); })),
      models.length ? field("Second axis, y", choice([["", "none: one axis by itself"], ...models], asked.second ?? "", (value) => { asked.second = value || null; show(); }), "It may be the same model. Both go along a circle; radius and feed are in the text of the study.") : null,
      field("Study file", name),
      h("button", { class: "primary wide", onclick: () => void this.start(asked) }, "Begin"),
    ].filter((own) => own !== null);
  }

  private async start(asked: { name: string }): Promise<void> {
    await attempt(async () => {
      await post("/api/study", asked);
      say(`${asked.name} is begun`);
      [this.begins, this.beginsOf] = [false, null];
      await refresh();
      this.choose(asked.name);
    });
    this.drawForm();
    void this.drawStudied();
  }

  /** What the model of the study is of, where it is that of a result. */
  private async drawOrigin(): Promise<void> {
    const { study } = this;
    const found = await whenceOf(study);
    if (study === this.study) put(this.whence, ...found);
  }

  private drawWork(): void {
    const job = latest("simulate", (own) => own.about === this.study);
    put(this.work, job && isRunning(job) ? progress(job) : job && job.state === "failed" ? failed(job) : null);
  }

  private async drawStudied(): Promise<void> {
    const file = state.workspace.files.find((own) => own.name === `${this.out}/study.json`);
    const model = changedAt(this.study.replace(/[^/]*$/, "model.toml"));
    const now = JSON.stringify([this.out, file?.modified, changedAt(this.study), model, this.course]);
    if (now === this.shown) return;
    this.shown = now;
    this.clear();
    if (!file) {
      put(this.found, !this.study ? null : h("p", { class: "muted" }, "Not simulated as a whole yet. A study of a few paths takes seconds."));
      return;
    }
    const read = await attempt(async () => JSON.parse((await get<{ text: string }>("/api/text", { name: file.name })).text) as StudyFile);
    const job = latest("simulate", (own) => own.folder === this.out && own.state === "done");
    if (!read || this.shown !== now) return;
    const of = entry(this.study)?.of ?? [];
    const models = read.inputs.map((input) => entry(nameOf(input.path))).filter((own) => own?.kind === "model" && own.of.length);
    const other = of.length && models.length && !models.some((model) => model!.of.some((own) => of.some((one) => one.sha256 === own.sha256)));
    put(
      this.found,
      h("div", { class: "row" }, h("button", { onclick: () => void attempt(() => open(`${this.out}/report.html`, "show")) }, "Full report"), h("button", { class: "quiet", onclick: () => void attempt(() => open(this.out, "zip")) }, "Download as zip")),
      other ? older(`Not of ${this.study}`, `What ${this.out} holds was simulated of ${models.map((model) => model!.name).join(", ")}.`) : null,
      [this.study, this.study.replace(/[^/]*$/, "model.toml")].some((name) => changedAt(name) > file.modified) ? older("Older than its study or model", "One of them changed after this was simulated. Simulate again.") : null,
      promised(read.promise ?? []),
      results(read),
      h("div", { class: "runs" }),
      job ? printed(job) : null,
    );
    await attempt(() => this.courses());
  }

  /** The course of one run after another, along paths and contours. */
  private async courses(): Promise<void> {
    const shown = this.shown;
    const kinds = (["trajectories", "contours"] as const).filter((kind) => exists(`${this.out}/${kind}.csv`));
    const place = this.found.querySelector(".runs");
    if (!place || !kinds[0]) return;
    const read = (own: string, at: number) => get<Table>("/api/table", { name: `${this.out}/${own}.csv`, run: at });
    const tables = await Promise.all(kinds.map((own) => read(own, 0)));
    // On a contour the last run, which has the best compensation, is drawn beside that without.
    const usual = kinds[0] === "contours" ? `contours ${(tables[0]?.runs.length ?? 1) - 1}` : `${kinds[0]} 0`;
    const [kind = "", run = ""] = (this.course || usual).split(" ");
    const table = await read(kind, Number(run));
    if (this.shown !== shown || table.from === null || table.to === null) return;
    const channel = (...names: string[]) => names.flatMap((own) => [own, `${own} x`, `${own} y`]).map((own) => table.channels.find((one) => one.name === own)).filter((one) => one !== undefined);
    this.trace = new Trace({
      source: { name: `${this.out}/${kind}.csv`, table: true, run: Number(run) },
      panels: [
        { title: "position", channels: channel("reference", "position") },
        { title: "tracking error", channels: channel("error") },
        { title: "force", channels: channel("force", "compensation") },
      ].filter((panel) => panel.channels.length),
      from: table.from,
      to: table.to,
      height: 110,
      label: "Course of a run",
    });
    const names = tables.flatMap((one, k) => one.runs.map((own, at): [string, string] => [`${kinds[k]} ${at}`, kinds[k] === "contours" ? own.replace(/ · 0$/, "").replace(/ · 1$/, " · coupled") : own]));
    const select = choice(names, `${kind} ${run}`, (value) => { this.course = value; void this.drawStudied(); });
    put(place, field("Course of", select), kind === "contours" ? await this.onContour(Number(run)) : null, this.trace.element);
  }

  /** A run in the plane of both axes, and how far it is from the contour. */
  private async onContour(run: number): Promise<HTMLElement | null> {
    const drawn = await attempt(() => get<OnContour>("/api/contour", { folder: this.out, run }));
    if (!drawn) return null;
    const plane = new Plane();
    const names = drawn.runs.map((own) => own.name);
    plane.draw(drawn.plane, names, drawn.unit);
    this.deviation = new Lines("Deviation from the contour", 300, "");
    this.deviation.draw(drawn.runs.map((own) => ({ name: own.name, x: own.time, y: own.deviation })), drawn.unit);
    return h("div", { class: "maps" }, plane.element, this.deviation.element);
  }
}

/** What of the largest error may be left on the machine. */
function promised(all: Promised[]): HTMLElement | null {
  if (!all.length) return null;
  const row = (own: Promised) => h("tr", {}, h("th", { scope: "row" }, own.path), h("td", {}, own.controller), h("td", {}, own.compensator), h("td", { class: "number strong" }, `${short(own.left90_percent[0])} … ${short(own.left90_percent[1])} %`));
  return h(
    "table",
    {},
    h("caption", {}, `What may be promised: how much of the largest error is left, 90 % interval of ${all[0]!.draws} draws of what the identification leaves open`),
    h("thead", {}, h("tr", {}, ...["path", "controller", "compensation", "left"].map((text) => h("th", { scope: "col" }, text)))),
    h("tbody", {}, ...all.map(row)),
  );
}

function results(file: StudyFile): HTMLElement {
  const shown = file.results.filter((row) => row.parameters !== "promised");
  const onContour = (row: Row) => row.metrics.some((own) => own.name === "contour_peak");
  const groups = [
    { caption: "Tracking error", heads: ["at reversals"], metrics: ["rms_error", "peak_error", "reversal_peak"], rows: shown.filter((row) => !onContour(row)) },
    { caption: "Distance to the contour, and the tracking error of each axis at reversals, where its quadrants meet", heads: ["x at reversals", "y at reversals"], metrics: ["contour_rms", "contour_peak", "reversal_peak_x", "reversal_peak_y"], rows: shown.filter(onContour) },
  ];
  return h(
    "div",
    {},
    ...groups.map(({ caption, heads, metrics, rows }) => rows.length ? h(
      "table",
      {},
      h("caption", {}, caption),
      h("thead", {}, h("tr", {}, ...["path", "compensation", "parameters", "rms", "largest", ...heads, "less by"].map((text) => h("th", { scope: "col" }, text)))),
      h("tbody", {}, ...rows.map((row) => tableRow(row, metrics))),
    ) : null),
    file.warnings.length ? warned(file.warnings) : null,
  );
}

function tableRow(row: Row, metrics: string[]): HTMLElement {
  const metric = (name: string) => row.metrics.find((own) => own.name === name);
  const cell = (own: Metric | undefined) => h("td", { class: "number" }, own ? length(own.mean, own.unit) : "–");
  const less = metric(metrics[1] ?? "")?.reduction_percent;
  return h("tr", {}, h("th", { scope: "row" }, row.path), h("td", {}, row.coupled ? `${row.compensator}, coupled` : row.compensator), h("td", {}, row.parameters === "exact" ? "as modelled" : row.parameters), ...metrics.map((name) => cell(metric(name))), h("td", { class: "number strong" }, less === null || less === undefined ? "–" : `${short(less)} %`));
}
