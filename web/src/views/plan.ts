// The motion to record, within the limits of the axis, with the intervals to expect.

import { get, open, type Channel } from "../api";
import { commandLine } from "../command";
import { attempt, choice, field, h, put, warned } from "../dom";
import { editor } from "../editor";
import { begin, failed, isRunning, latest, printed, progress, verdict } from "../jobs";
import { short } from "../numbers";
import { older } from "../origin";
import { AXIS, changedAt, choose, exists, files, labelled, nameOf, onChange, state, stem } from "../state";
import { Trace } from "../trace";

interface Expected { name: string; interval_percent: number; interval90_percent: number }

export class PlanView {
  readonly element = h("div", { class: "view plan" });
  private readonly command = commandLine();
  private readonly form = h("section", { class: "form", "aria-label": "What is planned" });
  private readonly work = h("section", { "aria-label": "Work", "aria-live": "polite" });
  private readonly found = h("section", { class: "found", "aria-label": "The plan" });
  private readonly stop: () => void;
  private axis = state.chosen.axis ?? files("axis")[0]?.name ?? "";
  private model = "";
  private time = "9";
  private out = "";
  /** Whether the folder was typed. */
  private named = false;
  private trace: Trace | null = null;
  private shown = "";

  constructor() {
    put(this.element, h("div", { class: "head" }, h("h2", {}, "Plan"), h("span", { class: "muted" }, "the motion to record, and the intervals to expect of it")), h("div", { class: "split" }, this.form, h("div", { class: "center" }, this.work, this.found)), this.command.element);
    this.stop = onChange((reason) => {
      if (state.chosen.axis && state.chosen.axis !== this.axis) this.axis = state.chosen.axis;
      if (reason !== "jobs") this.drawForm();
      this.drawWork();
      if (reason !== "jobs") void this.drawPlan();
    });
    this.drawForm();
    this.drawWork();
    void this.drawPlan();
  }

  end(): void {
    this.stop();
    this.trace?.end();
  }

  private asked() {
    return { kind: "plan", axis: this.axis, time: this.time ? Number(this.time) : null, model: this.model || null, out: this.out };
  }

  private drawForm(): void {
    const axes = files("axis");
    if (!axes.some((file) => file.name === this.axis)) this.axis = axes[0]?.name ?? "";
    // Plans of two machines do not write over each other.
    if (!this.named) this.out = this.axis === AXIS || !this.axis ? "plan" : `plan-${stem(this.axis).replace(/\.axis$/, "").replaceAll("/", "-")}`;
    if (!this.axis) {
      put(this.form, h("p", {}, "A plan needs an axis file with the limits of the machine. Correct a column of a log, and one is begun; then add its limits here:"), h("pre", { tabindex: "0" }, "[limits]\nstroke = [\"-100 mm\", \"100 mm\"]\nspeed = \"0.2 m/s\"\nacceleration = \"6 m/s2\"\nrated_force = \"150 N\"\nmass = \"10 kg\""));
      this.command.show("stiction plan axis.toml --out plan");
      return;
    }
    const again = () => this.command.of(this.asked());
    const time = h("input", { type: "number", min: "2", max: "600", step: "1", value: this.time, oninput: () => { this.time = time.value; again(); } });
    const out = h("input", { type: "text", value: this.out, spellcheck: "false", oninput: () => { this.out = out.value.trim(); this.named = true; again(); void this.drawPlan(); } });
    const place = h("div", {});
    put(
      this.form,
      field("Limits of", choice(axes.map((file): [string, string] => [file.name, file.name]), this.axis, (value) => { this.axis = value; choose({ axis: value }); })),
      place,
      field("For what this model leaves open", choice([["", "none: for the nameplate"], ...labelled("model")], this.model, (value) => { this.model = value; again(); })),
      field("Longest motion [s]", time),
      field("Folder for the plan", out),
      h("button", { class: "primary wide", onclick: () => void begin(this.asked()) }, "Plan"),
    );
    void editor(this.axis, "Limits and all else of the axis file").then((own) => put(place, own));
    again();
  }

  private drawWork(): void {
    const job = latest("plan", (own) => own.about === this.axis);
    if (!job || isRunning(job)) put(this.work, job ? progress(job) : null);
    else if (job.state === "failed") put(this.work, failed(job));
    else if (!job.written.length) put(this.work, older("Stopped before anything was found", "Nothing was written."));
    else put(this.work, job.folder === this.out ? verdict(job) : null);
  }

  private async drawPlan(): Promise<void> {
    const name = `${this.out}/setpoints.csv`;
    const file = state.workspace.files.find((own) => own.name === name);
    const now = JSON.stringify([name, file?.modified, this.axis, changedAt(this.axis)]);
    this.drawWork();
    if (now === this.shown) return;
    this.shown = now;
    this.trace?.end();
    this.trace = null;
    if (!file) {
      put(this.found, h("p", { class: "muted" }, "Not planned yet. A plan takes some seconds and says what to expect of every parameter before the machine moves."));
      return;
    }
    const text = await attempt(() => get<{ text: string }>("/api/text", { name: `${this.out}/plan.toml` }));
    if (this.shown !== now) return;
    const of = about(text?.text ?? "");
    const job = latest("plan", (own) => own.folder === this.out && own.state === "done");
    const planned = job?.json as { parameter?: Expected[]; warning?: { code: string; message: string }[] } | undefined;
    put(
      this.found,
      h("p", { class: "muted" }, `${this.out}: for ${of.axis}, ${short(of.seconds)} s.`),
      of.axis !== this.axis ? older(`Not for ${this.axis}`, `This motion keeps the limits of ${of.axis}. Plan again before the machine of ${this.axis} runs it.`) : changedAt(this.axis) > file.modified ? older("Older than its axis file", `${this.axis} changed after this was planned. Plan again before the machine runs it.`) : null,
      h("div", { class: "row" }, h("button", { onclick: () => void attempt(() => open(`${this.out}/report.html`, "show")) }, "Full report"), h("button", { onclick: () => void attempt(() => open(name, "save")) }, "Set points as CSV"), h("button", { class: "quiet", onclick: () => void attempt(() => open(this.out, "zip")) }, "Download as zip")),
      h("div", { class: "runs" }),
      planned?.warning?.length ? warned(planned.warning) : null,
      planned?.parameter ? expected(planned.parameter) : null,
      job ? printed(job) : null,
    );
    await attempt(async () => {
      if (!exists(name)) return;
      const table = await get<{ from: number | null; to: number | null; channels: Channel[] }>("/api/table", { name });
      const place = this.found.querySelector(".runs");
      if (!place || table.from === null || table.to === null) return;
      this.trace = new Trace({ source: { name, table: true }, panels: table.channels.slice(0, 3).map((channel) => ({ title: channel.name, channels: [channel] })), from: table.from, to: table.to, height: 110, label: "Set points" });
      put(place, this.trace.element);
    });
  }
}

/** The axis file of a plan and its length, s, as plan.toml has them. */
function about(text: string): { axis: string; seconds: number } {
  const path = /^\[\[inputs\]\]\npath = "(.*)"$/m.exec(text)?.[1];
  return { axis: path ? nameOf(JSON.parse(`"${path}"`) as string) : "another axis file", seconds: Number(/^duration = (.*)$/m.exec(text)?.[1]) };
}

function expected(all: Expected[]): HTMLElement {
  const rows = all.map((own) => h("tr", {}, h("th", { scope: "row" }, own.name.replaceAll("_", " ")), h("td", { class: "number" }, `± ${short(own.interval_percent)} %`), h("td", { class: "number" }, `± ${short(own.interval90_percent)} %`)));
  return h("table", {}, h("caption", {}, "95 % intervals to expect"), h("thead", {}, h("tr", {}, ...["parameter", "on half of such axes within", "on nine of ten within"].map((text) => h("th", { scope: "col" }, text)))), h("tbody", {}, ...rows));
}
