// A study: the identified axis with and without compensation, simulated.

import { get, open, post, type Channel } from "../api";
import { commandLine } from "../command";
import { attempt, choice, field, h, put, say } from "../dom";
import { editor } from "../editor";
import { begin, isRunning, latest, printed, progress } from "../jobs";
import { length, short } from "../numbers";
import { exists, files, onChange, refresh, state } from "../state";
import { Trace } from "../trace";
import { Try } from "./try";

interface Metric { name: string; unit: string; mean: number; reduction_percent: number | null }
interface Row { path: string; controller: string; compensator: string; parameters: string; metrics: Metric[] }
interface StudyFile { results: Row[]; warnings: { code: string; message: string }[] }

export class StudyView {
  readonly element = h("div", { class: "view study" });
  private readonly command = commandLine();
  private readonly form = h("section", { class: "form", "aria-label": "What is simulated" });
  private readonly work = h("section", { "aria-label": "Work", "aria-live": "polite" });
  private readonly found = h("section", { class: "found", "aria-label": "What came of it" });
  private readonly stop: () => void;
  private readonly tried = new Try();
  private study = "";
  private out = "";
  private trace: Trace | null = null;
  private run = 0;
  private shown = "";
  private editing = "";

  constructor() {
    put(this.element, h("div", { class: "head" }, h("h2", {}, "Study"), h("span", { class: "muted" }, "the axis with and without compensation, simulated")), h("div", { class: "split" }, this.form, h("div", { class: "center" }, this.tried.element, this.work, this.found)), this.command.element);
    const { result } = state.chosen;
    const own = `${result}/study.toml`;
    this.pick(result && exists(own) ? own : (files("study")[0]?.name ?? ""));
    this.stop = onChange((reason) => {
      if (reason === "files") this.drawForm();
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
    this.trace?.end();
  }

  private pick(study: string): void {
    this.study = study;
    const folder = study.includes("/") ? study.slice(0, study.lastIndexOf("/") + 1) : "";
    this.out = study ? `${folder}study` : "";
    this.run = 0;
  }

  private asked() { return { kind: "simulate", study: this.study, out: this.out }; }

  private drawForm(): void {
    const all = files("study");
    this.tried.of(this.study || (all[0]?.name ?? ""));
    if (!this.study && all[0]) this.pick(all[0].name);
    const models = files("model");
    if (!all.length) {
      put(
        this.form,
        h("p", {}, "A study needs a model. An identification that may be used writes one with it."),
        h("button", { class: "primary wide", onclick: () => void this.start(models[0]?.name ?? null) }, models[0] ? `Begin one of ${models[0].name}` : "Begin one of a known axis"),
      );
      this.command.show(`stiction simulate --init study.toml${models[0] ? ` --model ${models[0].name}` : ""}`);
      return;
    }
    const out = h("input", { type: "text", value: this.out, spellcheck: "false", oninput: () => { this.out = out.value.trim(); this.command.of(this.asked()); } });
    const place = h("div", {});
    put(
      this.form,
      field("Study file", choice(all.map((file): [string, string] => [file.name, file.name]), this.study, (value) => { this.pick(value); this.drawForm(); void this.drawStudied(); })),
      place,
      field("Folder for the result", out),
      h("button", { class: "primary wide", onclick: () => void begin(this.asked()) }, "Simulate"),
    );
    if (this.editing !== this.study) this.editing = this.study;
    void editor(this.study, "Paths, controllers and compensators").then((own) => put(place, own));
    this.command.of(this.asked());
  }

  private async start(model: string | null): Promise<void> {
    await attempt(async () => {
      await post("/api/study", { model, name: "study.toml" });
      say("study.toml is begun");
      await refresh();
    });
    this.drawForm();
  }

  private drawWork(): void {
    const job = latest("simulate", (own) => own.about === this.study);
    put(this.work, job && isRunning(job) ? progress(job) : job && job.state === "failed" ? printed(job) : null);
  }

  private async drawStudied(): Promise<void> {
    const file = state.workspace.files.find((own) => own.name === `${this.out}/study.json`);
    const now = JSON.stringify([this.out, file?.modified, this.run]);
    if (now === this.shown) return;
    this.shown = now;
    this.trace?.end();
    this.trace = null;
    if (!file) {
      put(this.found, h("p", { class: "muted" }, "Not simulated as a whole yet. A study of a few paths takes seconds."));
      return;
    }
    const read = await attempt(async () => JSON.parse((await get<{ text: string }>("/api/text", { name: file.name })).text) as StudyFile);
    const job = latest("simulate", (own) => own.folder === this.out && own.state === "done");
    if (!read || this.shown !== now) return;
    put(
      this.found,
      h("div", { class: "row" }, h("button", { onclick: () => void attempt(() => open(`${this.out}/report.html`, "show")) }, "Full report"), h("button", { class: "quiet", onclick: () => void attempt(() => open(this.out, "zip")) }, "Download as zip")),
      results(read),
      h("div", { class: "runs" }),
      job ? printed(job) : null,
    );
    await attempt(() => this.courses());
  }

  /** The course of one run after another. */
  private async courses(): Promise<void> {
    const name = `${this.out}/trajectories.csv`;
    if (!exists(name)) return;
    const table = await get<{ from: number | null; to: number | null; channels: Channel[]; runs: string[] }>("/api/table", { name, run: this.run });
    const place = this.found.querySelector(".runs");
    if (!place || table.from === null || table.to === null) return;
    const channel = (...names: string[]) => names.map((own) => table.channels.find((one) => one.name === own)).filter((one) => one !== undefined);
    this.trace = new Trace({
      source: { name, table: true, run: this.run },
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
    const select = choice(table.runs.map((own, k): [string, string] => [String(k), own]), String(this.run), (value) => { this.run = Number(value); void this.drawStudied(); });
    put(place, field("Course of", select), this.trace.element);
  }
}

function results(file: StudyFile): HTMLElement {
  const shown = file.results.filter((row) => row.parameters !== "promised");
  const rows = shown.map((row) => {
    const metric = (...names: string[]) => names.map((name) => row.metrics.find((own) => own.name === name)).find((own) => own !== undefined);
    const cell = (own: Metric | undefined) => h("td", { class: "number" }, own ? length(own.mean, own.unit) : "–");
    const judged = metric("contour_peak", "peak_error");
    const less = judged?.reduction_percent;
    return h("tr", {}, h("th", { scope: "row" }, row.path), h("td", {}, row.compensator), h("td", {}, row.parameters === "exact" ? "as modelled" : row.parameters), cell(metric("contour_rms", "rms_error")), cell(judged), cell(metric("reversal_peak")), h("td", { class: "number strong" }, less === null || less === undefined ? "–" : `${short(less)} %`));
  });
  return h(
    "div",
    {},
    h(
      "table",
      {},
      h("caption", {}, "Tracking error, on a contour the distance to it"),
      h("thead", {}, h("tr", {}, ...["path", "compensation", "the axis", "rms", "largest", "at reversals", "less by"].map((text) => h("th", { scope: "col" }, text)))),
      h("tbody", {}, ...rows),
    ),
    file.warnings.length ? h("ul", { class: "findings" }, ...file.warnings.map((one) => h("li", { class: "warning" }, h("code", {}, one.code), h("span", {}, one.message)))) : null,
  );
}
