// Friction of machines over time, from the table of a batch: what changed, since when, and the course of each parameter.

import { commandLine } from "../command";
import { choice, field, h, put } from "../dom";
import { begin, failed, isRunning, latest, progress } from "../jobs";
import { PointMap } from "../map";
import { quantity, short, unit } from "../numbers";
import { older } from "../origin";
import { changedAt, files, onChange } from "../state";

interface Alarm { machine: string; parameter: string; kind: string; limit: string | null; unit: string; before: number; after: number; size: number; ci95: [number, number] | null; relative: boolean }
interface Course { machine: string; parameter: string; law: string; unit: string; x: number[]; y: number[]; low: number[]; high: number[]; levels: { x: number[]; y: number[] } }
interface Followed { verdict: string; good: boolean; timed: boolean; logs: number; machines: number; notes: string[]; alarms: Alarm[]; times: [since: string, found: string][]; courses: Course[] }

/** When a table was changed last as it was followed, by the number of the work. */
const followedAs = new Map<number, number>();

export class DriftView {
  readonly element = h("div", { class: "view drift" });
  private readonly command = commandLine();
  private readonly form = h("section", { class: "form", "aria-label": "What is followed" });
  private readonly work = h("section", { "aria-label": "Work", "aria-live": "polite" });
  private readonly found = h("section", { class: "found", "aria-label": "What changed" });
  private readonly stop: () => void;
  private table = "";
  private limit = "";
  private names = false;
  private shown = "";
  private maps: PointMap[] = [];

  constructor() {
    put(this.element, h("div", { class: "head" }, h("h2", {}, "Drift"), h("span", { class: "muted" }, "friction of machines over time")), h("div", { class: "split" }, this.form, h("div", { class: "center" }, this.work, this.found)), this.command.element);
    this.stop = onChange((reason) => {
      if (reason !== "jobs") this.drawForm();
      this.drawFound();
    });
    this.drawForm();
    this.drawFound();
  }

  end(): void {
    this.stop();
    this.clear();
  }

  private clear(): void {
    for (const map of this.maps) map.end();
    this.maps = [];
  }

  private asked() {
    const limits = this.limit.split(",").map((text) => text.trim()).filter(Boolean);
    return { kind: "drift", table: this.table, limits, names: this.names };
  }

  private async run(): Promise<void> {
    const as = changedAt(this.table);
    const id = await begin(this.asked());
    if (id !== undefined) followedAs.set(id, as);
  }

  private drawForm(): void {
    const tables = files("table").map((own) => own.name);
    if (!tables.includes(this.table)) this.table = tables[0] ?? "";
    if (!this.table) {
      put(this.form, h("p", {}, "This follows the table of a batch: many logs of one or more machines, each identified by itself. No table is in this folder yet; the command below writes one of its logs."));
      this.command.show("stiction batch . --law lugre --out batch");
      return;
    }
    const again = () => this.command.of(this.asked());
    const limit = h("input", { type: "text", value: this.limit, placeholder: "coulomb > 1.3", spellcheck: "false", oninput: () => { this.limit = limit.value; again(); } });
    const names = h("input", { type: "checkbox", checked: this.names, onchange: () => { this.names = names.checked; again(); } });
    put(
      this.form,
      field("Table", choice(tables.map((own): [string, string] => [own, own]), this.table, (value) => { this.table = value; again(); this.drawFound(); })),
      field("Levels that are an alarm too", limit, "1.3 times the first logs, or a level such as coulomb > 25 N; separated by commas"),
      h("label", { class: "check" }, names, " times are the dates in the names of the logs"),
      h("button", { class: "primary wide", onclick: () => void this.run() }, "Follow"),
    );
    again();
  }

  private drawFound(): void {
    const job = latest("drift", (own) => own.about === this.table);
    put(this.work, job && isRunning(job) ? progress(job) : job?.state === "failed" ? failed(job) : null);
    const done = job?.state === "done" ? job : null;
    const stale = done && followedAs.has(done.id) && followedAs.get(done.id) !== changedAt(this.table);
    const now = JSON.stringify([this.table, done?.id, stale]);
    if (now === this.shown) return;
    this.shown = now;
    this.clear();
    if (!done) {
      put(this.found, this.table ? h("p", { class: "muted" }, "Not followed yet.") : null);
      return;
    }
    const { verdict, good, timed, logs, machines, notes, alarms, times, courses } = done.json as Followed;
    const maps = courses.map((own) => this.course(own, timed));
    put(
      this.found,
      stale ? older("Older than its table", `${this.table} changed after it was followed. Follow it again.`) : null,
      h("div", { class: `banner ${good ? "good" : "warn"}` }, h("strong", {}, verdict), ...notes.map((note) => h("p", {}, note))),
      h("p", { class: "muted" }, `${this.table}: ${logs} logs, ${machines} machine${machines === 1 ? "" : "s"}.`),
      alarms.length ? table(alarms, times) : null,
      h("div", { class: "maps" }, ...maps.map(({ map }) => map.element)),
    );
    for (const { draw } of maps) draw();
  }

  private course(own: Course, timed: boolean): { map: PointMap; draw: () => void } {
    const title = `${own.parameter.replaceAll("_", " ")}${own.machine ? ` of ${own.machine}` : ""} (${own.law})`;
    const label = unit(own.unit);
    const map = new PointMap(title, [timed ? "time [d]" : "logs", `${own.parameter.replaceAll("_", " ")}${label ? ` [${label}]` : ""}`], 206, ["logs, 95 %", "level"]);
    const array = (values: number[]) => Float64Array.from(values);
    this.maps.push(map);
    return { map, draw: () => map.draw({ x: array(own.x), y: array(own.y), low: array(own.low), high: array(own.high) }, undefined, { x: array(own.levels.x), y: array(own.levels.y) }) };
  }
}

function table(alarms: Alarm[], times: string[][]): HTMLElement {
  const change = (size: number, { relative, unit: of }: Alarm) => `${size < 0 ? "" : "+"}${relative ? `${short(100 * size)} %` : quantity(size, of)}`;
  const row = (own: Alarm, k: number) => h("tr", {}, h("th", { scope: "row" }, own.machine || "–"), h("td", {}, own.parameter.replaceAll("_", " ")), h("td", {}, own.limit ?? own.kind), ...times[k]!.map((time) => h("td", {}, time)), h("td", { class: "number" }, quantity(own.before, own.unit)), h("td", { class: "number" }, quantity(own.after, own.unit)), h("td", { class: "number strong" }, change(own.size, own)), h("td", { class: "number" }, own.ci95 ? own.ci95.map((end) => change(end, own)).join(" … ") : ""));
  return h("table", { class: "beside" }, h("caption", {}, "What changed"), h("thead", {}, h("tr", {}, ...["machine", "parameter", "what", "since", "found", "before", "after", "change", "95 % interval"].map((text) => h("th", { scope: "col" }, text)))), h("tbody", {}, ...alarms.map(row)));
}
