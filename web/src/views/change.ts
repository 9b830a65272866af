// Two logs of one machine, such as before a compensation was put into operation and after: what changed in how it follows its
// reference, and friction of both.

import { binary, type Found } from "../api";
import { commandLine } from "../command";
import { attempt, choice, field, h, put } from "../dom";
import { begin, failed, isRunning, latest, progress } from "../jobs";
import { Lines } from "../lines";
import { PointMap, type Points } from "../map";
import { length, short, unit } from "../numbers";
import { aboutLog, files, onChange, state } from "../state";

interface Log { refused: string | null; not_tracked: string | null; findings: Found[] }
interface Row { name: string; before: number; after: number; change_percent: number | null }
interface Peak { time: number; error: number }
interface Change { verdict: string; good: boolean | null; unit: string; rows: Row[]; notes: string[]; peaks: [Peak[], Peak[]] }
interface Compared { logs: [Log, Log]; change: Change | null }

export class ChangeView {
  readonly element = h("div", { class: "view change" });
  private readonly command = commandLine();
  private readonly form = h("section", { class: "form", "aria-label": "What is compared" });
  private readonly work = h("section", { "aria-label": "Work", "aria-live": "polite" });
  private readonly found = h("section", { class: "found", "aria-label": "What changed" });
  private readonly stop: () => void;
  private before = "";
  private after = "";
  private shown = "";
  private drawn: { end(): void }[] = [];

  constructor() {
    put(this.element, h("div", { class: "head" }, h("h2", {}, "Before and after"), h("span", { class: "muted" }, "what changed in how an axis follows its reference")), h("div", { class: "split" }, this.form, h("div", { class: "center" }, this.work, this.found)), this.command.element);
    this.stop = onChange((reason) => {
      if (reason !== "jobs") this.drawForm();
      void this.drawFound();
    });
    this.drawForm();
    void this.drawFound();
  }

  end(): void {
    this.stop();
    this.clear();
  }

  private clear(): void {
    for (const own of this.drawn) own.end();
    this.drawn = [];
  }

  private asked() {
    return { kind: "check", log: this.before, after: this.after, axis: state.chosen.axis };
  }

  private drawForm(): void {
    const logs = files("log").map((own) => own.name);
    const { log, axis } = state.chosen;
    // The chosen log is the later one; another one is chosen beside.
    if (!logs.includes(this.after) || (this.after !== log && this.before !== log)) this.after = log ?? "";
    if (!logs.includes(this.before) || this.before === this.after) this.before = logs.find((own) => own !== this.after) ?? "";
    if (!this.before) {
      put(this.form, h("p", {}, "This needs two logs of the same motion, with the reference beside the position: one before a change of the machine or its controller, one after."));
      this.command.show("stiction check BEFORE AFTER");
      return;
    }
    const pick = (which: "before" | "after") => choice(logs.map((own): [string, string] => [own, own]), this[which], (value) => {
      const other = which === "before" ? "after" : "before";
      if (this[other] === value) this[other] = this[which];
      this[which] = value;
      this.drawForm();
      void this.drawFound();
    });
    put(
      this.form,
      field("Before", pick("before")),
      field("After", pick("after")),
      h("p", { class: "muted small" }, axis ? `Both are read as ${axis} says.` : "Both are read as found."),
      h("button", { class: "primary wide", onclick: () => void begin(this.asked()) }, "Compare"),
    );
    this.command.of(this.asked());
  }

  private async drawFound(): Promise<void> {
    const { before, after } = this;
    const job = latest("check", (own) => own.about === `${before}, ${after}`);
    put(this.work, job && isRunning(job) ? progress(job) : job?.state === "failed" ? failed(job) : null);
    const done = job?.state === "done" ? job : null;
    const now = JSON.stringify([before, after, done?.id]);
    if (now === this.shown) return;
    this.shown = now;
    this.clear();
    if (!done) {
      put(this.found, before ? h("p", { class: "muted" }, "Not compared yet.") : null);
      return;
    }
    const { logs, change } = done.json as Compared;
    const silent = logs.map((log, k) => (log.not_tracked ? h("p", {}, `${[before, after][k]} is not compared: ${log.not_tracked}.`) : null));
    const refused = logs.map((log, k) => (log.refused ? h("p", { class: "small" }, `${[before, after][k]}: ${log.refused}`) : null));
    const maps = h("div", { class: "maps" });
    put(
      this.found,
      change ? h("div", { class: `banner ${change.good ? "good" : "warn"}` }, h("strong", {}, change.verdict), ...change.notes.map((note) => h("p", {}, note))) : h("div", { class: "banner warn" }, h("strong", {}, "The following error cannot be compared"), ...silent),
      change ? this.peaks(change) : null,
      change ? table(change, [before, after]) : null,
      maps,
      refused.some(Boolean) ? h("details", {}, h("summary", {}, "What a fit to each log would not be relied on for"), ...refused) : null,
    );
    await attempt(() => this.maps(maps, now));
  }

  private peaks(change: Change): HTMLElement {
    const lines = new Lines("Largest error at each reversal", 190, "No reversals.");
    this.drawn.push(lines);
    lines.draw(change.peaks.map((all, k) => ({ name: ["before", "after"][k]!, x: all.map((own) => own.time), y: all.map((own) => own.error) })), change.unit);
    return lines.element;
  }

  /** Force of both logs over velocity and position. */
  private async maps(place: HTMLElement, now: string): Promise<void> {
    const { axis } = state.chosen;
    const names = [this.before, this.after];
    const abouts = await Promise.all(names.map((name) => aboutLog(name, axis)));
    const both = await Promise.all(names.map(async (name, k) => {
      const [from, to] = abouts[k]?.span ?? [0, 0];
      const buffer = await binary("/api/map", { name, axis, from, to });
      const [count = 0] = new Uint32Array(buffer, 0, 2);
      return [0, 1, 2].map((at) => new Float64Array(buffer, 8 + 8 * count * at, count)) as [Float64Array, Float64Array, Float64Array];
    }));
    if (this.shown !== now) return;
    const label = (name: string) => `${name} [${unit(abouts[0]?.channels.find((own) => own.name === name)?.unit ?? "")}]`;
    const maps = ([["Friction over velocity", "velocity", 0], ["Force over position", "position", 2]] as const).map(([title, over, at]) => {
      const map = new PointMap(title, [label(over), label("force")], 206, ["before", "after"], true);
      const points = (k: number): Points => ({ x: both[k]![at], y: both[k]![1] });
      this.drawn.push(map);
      return { map, draw: () => map.draw(points(0), undefined, points(1)) };
    });
    put(place, ...maps.map((own) => own.map.element));
    for (const own of maps) own.draw();
  }
}

function table(change: Change, names: string[]): HTMLElement {
  const less = (percent: number | null) => (percent === null ? "" : percent < 0 ? `${short(-percent)} % less` : `${short(percent)} % more`);
  const row = (own: Row) => h("tr", {}, h("th", { scope: "row" }, own.name), h("td", { class: "number" }, length(own.before, change.unit)), h("td", { class: "number" }, length(own.after, change.unit)), h("td", { class: "number strong" }, less(own.change_percent)));
  return h("table", {}, h("caption", {}, "Following error"), h("thead", {}, h("tr", {}, ...["", ...names, "change"].map((text) => h("th", { scope: "col" }, text)))), h("tbody", {}, ...change.rows.map(row)));
}
