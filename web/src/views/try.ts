// The axis of a study with parameters that are moved by sliders, simulated at each change: what is left of the error where the
// machine is not quite what its model says.

import { post } from "../api";
import { choice, field, h, put } from "../dom";
import { Lines } from "../lines";
import { length, quantity, short, shownUnit } from "../numbers";
import { Plane, type PlaneData } from "../plane";
import { state } from "../state";

interface Knob { name: string; symbol: string; unit: string; value: number; low: number; high: number; range: "interval" | "open" | "given"; elements: number }
interface Line { time: number[]; error: number[] }
interface Run { compensator: string; rms_error: number; peak_error: number; reversal_peaks: number[]; reduction_percent: number | null; whole: Line; reversal: Line }
interface Tried {
  paths: string[]; controllers: string[]; compensators: string[]; compensator: number; knobs: Knob[]; second_knobs: Knob[]; unit: string;
  seconds: number; whole_seconds: number; from_seconds: number; samples: number; runs: Run[]; plane: PlaneData | null;
}

const STEPS = 200;
const RANGES = { interval: "", open: "open", given: "±20 %" };
const WHY = { interval: "95 % interval of the identification", open: "the log leaves an end of its interval open: from a third to three times the value", given: "it has no interval: 20 % to both sides" };

export class Try {
  readonly element = h("section", { class: "try hidden", "aria-label": "Try it" });
  private readonly choices = h("div", { class: "choices" });
  private readonly knobs = h("div", {});
  private readonly table = h("div", {});
  private readonly said = h("p", { class: "muted small", "aria-live": "polite" });
  private readonly whole = new Lines("Tracking error", 150, "");
  private readonly reversal = new Lines("About a reversal", 150, "The part that is simulated has no two reversals.");
  private readonly plane = new Plane();
  private study = "";
  private which: { path: number; controller: number; compensator: number | null } = { path: 0, controller: 0, compensator: null };
  /** Of each axis. */
  private values: [Record<string, number>, Record<string, number>] = [{}, {}];
  /** For what the controls are made. */
  private made = "";
  private busy = false;
  private again = false;
  private ended = false;

  constructor() {
    const back = h("button", { class: "quiet", onclick: () => { this.values = [{}, {}]; this.made = ""; void this.ask(); } }, "As identified");
    put(
      this.element,
      h("div", { class: "head" }, h("h3", {}, "What if the machine is not quite what the model says?"), h("span", { class: "gap" }), back),
      h("p", { class: "muted small" }, "Move a parameter of the simulated axis; the compensation keeps the values of the model."),
      this.choices,
      h("div", { class: "tuning" }, this.knobs, h("div", { class: "pictures" }, h("div", { class: "maps" }, this.whole.element, this.reversal.element, this.plane.element), this.table, this.said)),
    );
  }

  end(): void {
    this.ended = true;
    this.whole.end();
    this.reversal.end();
  }

  /** Another study, or the same after its files changed. */
  of(study: string): void {
    const model = study.replace(/[^/]*$/, "model.toml");
    const seen = [study, model].map((name) => state.workspace.files.find((own) => own.name === name)?.modified);
    const now = JSON.stringify([study, seen]);
    if (now === this.study) return;
    this.study = now;
    this.which = { path: 0, controller: 0, compensator: null };
    this.values = [{}, {}];
    this.made = "";
    this.element.classList.toggle("hidden", !study);
    if (study) void this.ask();
  }

  /** Simulates what is set; of changes in the meantime only the last. */
  private async ask(): Promise<void> {
    if (this.busy) {
      this.again = true;
      return;
    }
    this.busy = true;
    const [study] = JSON.parse(this.study) as [string];
    const began = performance.now();
    try {
      const tried = await post<Tried>("/api/trial", { study, ...this.which, values: this.values[0], second_values: this.values[1] });
      if (!this.ended) this.draw(tried, performance.now() - began);
    } catch (error) {
      put(this.said, `Not simulated: ${error instanceof Error ? error.message : String(error)}`);
    }
    this.busy = false;
    if (this.again && !this.ended) {
      this.again = false;
      void this.ask();
    }
  }

  private draw(tried: Tried, milliseconds: number): void {
    const made = JSON.stringify([this.study, tried.paths, tried.controllers, tried.compensators, tried.second_knobs.length]);
    if (made !== this.made) this.controls(tried);
    this.made = made;
    const lines = (of: (run: Run) => Line) => tried.runs.map((run) => ({ name: run.compensator, x: of(run).time, y: of(run).error })).filter((line) => line.x.length);
    this.whole.draw(lines((run) => run.whole), tried.unit);
    this.reversal.draw(lines((run) => run.reversal), tried.unit);
    this.reversal.element.classList.toggle("hidden", Boolean(tried.plane));
    this.plane.element.classList.toggle("hidden", !tried.plane);
    if (tried.plane) this.plane.draw(tried.plane, tried.runs.map((run) => run.compensator), tried.unit);
    const cell = (value: number) => h("td", { class: "number" }, length(value, tried.unit));
    const heads = tried.plane ? ["compensation", "rms off the contour", "largest", "x at reversals", "y at reversals", "largest less by"] : ["compensation", "rms", "largest", "at reversals", "largest less by"];
    put(
      this.table,
      h(
        "table",
        {},
        h("thead", {}, h("tr", {}, ...heads.map((text) => h("th", { scope: "col" }, text)))),
        h("tbody", {}, ...tried.runs.map((run) => h("tr", {}, h("th", { scope: "row" }, run.compensator), cell(run.rms_error), cell(run.peak_error), ...run.reversal_peaks.map(cell), h("td", { class: "number strong" }, run.reduction_percent === null ? "–" : `${short(run.reduction_percent)} %`)))),
      ),
    );
    const all = tried.seconds >= tried.whole_seconds;
    const part = all ? `all ${short(tried.whole_seconds)} s of the path` : `the first ${short(tried.seconds)} s of the ${short(tried.whole_seconds)} s of the path`;
    this.whole.called(tried.plane ? "Deviation from the contour" : "Tracking error");
    put(this.said, `Simulated in ${milliseconds.toFixed(0)} ms as the study does: ${part}, of which errors count from ${short(tried.from_seconds)} s on; no watchdog. Simulate runs all of it, with every compensator, and says what may be promised.`);
  }

  private controls(tried: Tried): void {
    const pick = (label: string, names: string[], at: number, key: "path" | "controller" | "compensator") => names.length > 1 ? field(label, choice(names.map((name, k): [string, string] => [String(k), name]), String(at), (value) => {
      this.which[key] = Number(value);
      // Another motion may be one of the first axis alone.
      if (key === "path") [this.values[1], this.made] = [{}, ""];
      void this.ask();
    })) : null;
    put(
      this.choices,
      pick("Path", tried.paths, this.which.path, "path"),
      pick("Controller", tried.controllers, this.which.controller, "controller"),
      pick("Compensation", tried.compensators, tried.compensator, "compensator"),
    );
    const group = (name: string, knobs: Knob[], axis: 0 | 1) => [h("h4", {}, name), h("div", { class: "knobs" }, ...knobs.map((knob) => this.knob(knob, axis, `${name} `)))];
    if (tried.plane) put(this.knobs, ...group("x", tried.knobs, 0), ...group("y", tried.second_knobs, 1));
    else put(this.knobs, h("div", { class: "knobs" }, ...tried.knobs.map((knob) => this.knob(knob, 0))));
  }

  private knob(knob: Knob, axis: 0 | 1, of = ""): HTMLElement {
    const label = knob.name.replaceAll("_", " ");
    const text = (value: number) => quantity(value, knob.unit);
    const [, by] = shownUnit(knob.unit);
    const now = this.values[axis][knob.name] ?? knob.value;
    const output = h("output", {}, text(now));
    const slider = h("input", {
      type: "range",
      min: "0",
      max: String(STEPS),
      step: "1",
      "aria-label": of + label,
      title: `${text(knob.low)} to ${text(knob.high)}: ${WHY[knob.range]}`,
    });
    slider.value = String(Math.round((STEPS * (now - knob.low)) / (knob.high - knob.low)));
    const together = knob.elements > 1 ? h("span", { class: "muted", title: "It moves all elements of the law together; each keeps its share." }, ` of ${knob.elements} elements`) : null;
    const item = h("div", { class: knob.name in this.values[axis] ? "knob moved" : "knob" }, h("span", {}, label, " ", h("span", { class: "symbol" }, knob.symbol), together, " ", RANGES[knob.range] ? h("span", { class: "tag warn", title: WHY[knob.range] }, RANGES[knob.range]) : null), output, slider, h("span", { class: "end" }, short(by * knob.low)), h("span", { class: "end" }, short(by * knob.high)));
    slider.addEventListener("input", () => {
      const value = knob.low + ((knob.high - knob.low) * slider.valueAsNumber) / STEPS;
      this.values[axis][knob.name] = value;
      put(output, text(value));
      slider.setAttribute("aria-valuetext", text(value));
      item.classList.add("moved");
      void this.ask();
    });
    slider.setAttribute("aria-valuetext", text(now));
    return item;
  }
}
