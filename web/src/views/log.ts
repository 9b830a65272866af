// A log: what it holds, its traces, the stretches that are used, and friction beside them.

import { binary, post, type About, type Column, type Marks, type Stretch } from "../api";
import { commandLine } from "../command";
import { checked } from "../checked";
import { attempt, choice, field, h, put, say } from "../dom";
import { begin, failed, isRunning, latest, progress } from "../jobs";
import { PointMap } from "../map";
import { short, unit } from "../numbers";
import { editor } from "../editor";
import { aboutLog, AXIS, axisToWrite, changedAt, choose, files, onChange, refresh, state } from "../state";
import { Trace, type Band, type Panel, type Tick } from "../trace";

const ROLES: [string, string][] = ["time", "position", "velocity", "acceleration", "force", "reference", "external", "temperature", "load"].map((role) => [role, role]);

/** As what a log was read when it was checked, by the number of the work. */
const checkedAs = new Map<number, string>();

export class LogView {
  readonly element = h("div", { class: "view log" });
  private readonly command = commandLine();
  private readonly head = h("div", { class: "head" });
  private readonly center = h("div", { class: "center" });
  private readonly right = h("div", { class: "right" });
  private readonly heading = h("h3", {}, "Check");
  private readonly checked = h("section", { "aria-label": "What the log can determine" });
  private readonly stop: () => void;
  private trace: Trace | null = null;
  private maps: PointMap[] = [];
  private about: About | null = null;
  private shown = "";
  private from = h("input", { type: "number", "aria-label": "Brush from, s", step: "any", min: "0", onchange: () => this.typed() });
  private to = h("input", { type: "number", "aria-label": "Brush to, s", step: "any", min: "0", onchange: () => this.typed() });
  private mapDue = 0;
  private marking = false;
  private drawn = "";
  /** Closes the column that is being corrected. */
  private closeOpen: () => void = () => {};
  /** What was brushed and seen of a log that is drawn again. */
  private kept: { log: string; brush: Stretch | null; view: Stretch } | null = null;

  constructor() {
    put(this.element, this.head, h("div", { class: "columns" }, this.center, this.right), this.command.element);
    this.stop = onChange((reason) => {
      if (reason === "jobs") this.drawChecked();
      else void this.load();
    });
    void this.load();
  }

  end(): void {
    this.stop();
    this.clear();
  }

  private clear(): void {
    if (this.trace) this.kept = { log: this.drawn, brush: this.trace.brushed, view: this.trace.shown };
    this.trace?.end();
    this.trace = null;
    for (const map of this.maps) map.end();
    this.maps = [];
  }

  private async load(): Promise<void> {
    const { log, axis } = state.chosen;
    if (!log) {
      this.clear();
      this.shown = "";
      put(this.head, h("h2", {}, "Begin with a log"));
      put(this.center, h("div", { class: "welcome" }, h("p", {}, "Drop the recording of a servo axis anywhere on this page: time, position or velocity, and force, torque or current. Columns and units are found and can be corrected."), h("p", {}, "Nothing leaves this machine. The file is copied into the folder of this page, where the command line finds it too.")));
      put(this.right);
      this.command.show("stiction check LOG");
      return;
    }
    const file = state.workspace.files.find((own) => own.name === log);
    const axisFile = state.workspace.files.find((own) => own.name === axis);
    const now = JSON.stringify([log, file?.modified, axis, axisFile?.modified]);
    if (now === this.shown) return;
    this.shown = now;
    // Marks are drawn already; nothing else of the log has changed with them.
    if (this.marking) return;
    this.command.of({ kind: "check", log, axis });
    const about = await aboutLog(log, axis);
    if (this.shown !== now) return;
    if (!about) {
      this.clear();
      put(this.head, h("h2", {}, log));
      put(this.center, h("p", {}, "This file could not be read."));
      put(this.right);
      return;
    }
    this.about = about;
    this.draw(log, about);
  }

  private draw(log: string, about: About): void {
    this.clear();
    const facts = about.refused ? "columns to decide" : `${about.samples.toLocaleString("en").replaceAll(",", " ")} samples · ${short(about.rate_hz)} Hz · ${short(about.seconds)} s · ${about.motion}`;
    put(this.head, h("h2", { title: log }, log), h("span", { class: "muted" }, facts), h("button", { class: "primary next", disabled: Boolean(about.refused) || !about.channels.some((own) => own.name === "force"), title: about.refused || about.channels.some((own) => own.name === "force") ? null : "No column is the force: click the one that holds force, torque or current.", onclick: () => choose({ view: "identify" }) }, "Identify friction →"));
    put(this.right, this.columns(about), this.findings(about));
    this.drawChecked();
    if (about.refused) {
      put(this.center, h("div", { class: "banner warn", role: "alert" }, h("strong", {}, "Something has to be said of this log before it can be read"), h("p", {}, about.refused), h("p", {}, `On the right: click a column to say what it is and its unit; the kind of axis and, without a column of time, the sample rate stand below. It goes into ${axisToWrite()}.`)), ...this.undecided(log, about));
      return;
    }
    const channel = (name: string) => about.channels.find((own) => own.name === name);
    const panels: Panel[] = [];
    const position = [channel("reference"), channel("position")].filter((own) => own !== undefined);
    if (position.length) panels.push({ title: "position", channels: position });
    const velocity = channel("velocity");
    if (velocity) panels.push({ title: velocity.derived ? "velocity*" : "velocity", channels: [velocity] });
    const force = [channel("external"), channel("force")].filter((own) => own !== undefined);
    if (force.length) panels.push({ title: "force", channels: force });
    for (const name of ["load", "temperature"]) {
      const own = channel(name);
      if (own) panels.push({ title: name, channels: [own] });
    }
    const source = { name: log, axis: state.chosen.axis };
    const trace = new Trace({ source, panels, from: 0, to: about.seconds, height: panels.length > 3 ? 76 : 88, label: `Traces of ${log}`, brushed: (stretch) => this.brushed(stretch) });
    this.trace = trace;
    const speed = unit(velocity?.unit ?? "");
    const forceUnit = unit(about.force_unit);
    this.maps = [
      new PointMap("Friction over velocity", [`velocity [${speed}]`, `force [${forceUnit}]`], 206),
      new PointMap("Force over position", [`position [${unit(channel("position")?.unit ?? "")}]`, `force [${forceUnit}]`], 206),
    ];
    put(
      this.center,
      trace.element,
      this.brushBar(),
      h("p", { class: "muted small" }, "Drag to brush, wheel to zoom, Shift-drag to move, double-click for all.", velocity?.derived ? " * of the position, over a short window" : ""),
      h("div", { class: "maps" }, ...this.maps.map((map) => map.element)),
      this.checked,
    );
    this.marked(about.marks);
    const kept = this.kept?.log === log ? this.kept : null;
    this.drawn = log;
    if (kept) trace.show(kept.view[0], kept.view[1]);
    trace.select(kept?.brush ?? null);
  }

  /** The columns of a file over its time or rows, which are seen before it is said what they are. */
  private undecided(log: string, about: About): HTMLElement[] {
    const title = (number: string) => {
      const column = about.columns.find((own) => String(own.number) === number);
      const name = column?.name || `column ${number}`;
      return column?.unit && !name.includes(column.unit) ? `${name} [${column.unit}]` : name;
    };
    if (!about.channels.length) return [];
    const panels = about.channels.map((channel): Panel => ({ title: title(channel.name), channels: [channel] }));
    this.trace = new Trace({ source: { name: log, axis: state.chosen.axis }, panels, from: about.span[0], to: about.span[1], height: 76, over: about.over, label: `Columns of ${log}` });
    return [this.trace.element];
  }

  private brushBar(): HTMLElement {
    const mark = (as: string, label: string, title: string) => h("button", { title, onclick: () => void this.mark(as) }, label);
    return h(
      "div",
      { class: "brush", role: "group", "aria-label": "The brushed stretch" },
      h("span", {}, "from ", this.from, " s"),
      h("span", {}, "to ", this.to, " s"),
      h("button", { class: "quiet", onclick: () => { const own = this.trace?.brushed; if (own) this.trace?.show(own[0], own[1]); } }, "Zoom"),
      h("span", { class: "gap" }),
      mark("crop", "Crop", "Keep this stretch of the log alone"),
      mark("fit", "Fit", "Fit this stretch"),
      mark("validate", "Validate", "Do not fit this stretch; hold the law against it"),
      mark("leave-out", "Leave out", "Use this stretch for nothing"),
      mark("nothing", "Clear", "Use the whole log again"),
    );
  }

  private typed(): void {
    const [from, to] = [this.from.valueAsNumber, this.to.valueAsNumber];
    if (to > from) this.trace?.select([from, to]);
  }

  private brushed(stretch: Stretch | null): void {
    this.from.value = stretch ? stretch[0].toFixed(4) : "";
    this.to.value = stretch ? stretch[1].toFixed(4) : "";
    clearTimeout(this.mapDue);
    this.mapDue = window.setTimeout(() => void attempt(() => this.drawMaps(stretch)), 60);
  }

  private async drawMaps(stretch: Stretch | null): Promise<void> {
    const { about } = this;
    if (!about) return;
    const [from, to] = stretch ?? about.marks.crop ?? [0, about.seconds];
    const buffer = await binary("/api/map", { name: state.chosen.log, axis: state.chosen.axis, from, to });
    const [count = 0] = new Uint32Array(buffer, 0, 2);
    const [velocity, force, position] = [0, 1, 2].map((at) => new Float64Array(buffer, 8 + 8 * count * at, count));
    this.maps[0]?.draw({ x: velocity!, y: force! });
    this.maps[1]?.draw({ x: position!, y: force! });
  }

  private async mark(as: string): Promise<void> {
    const { log } = state.chosen;
    const stretch = this.trace?.brushed;
    if (as !== "nothing" && !stretch) {
      say("Brush a stretch first: drag over the trace, or type from and to.");
      return;
    }
    if (as !== "nothing" && !(this.to.valueAsNumber > this.from.valueAsNumber)) {
      say("What stands in from and to is no stretch: two times in seconds, from before to.", "error");
      return;
    }
    const axis = axisToWrite();
    const [from, to] = stretch ?? [0, 0];
    const marks = await attempt(() => post<Marks>("/api/mark", { log, axis, as, from, to, seconds: this.about?.seconds ?? 0 }));
    if (!marks || !this.about) return;
    this.about.marks = marks;
    this.marked(marks);
    say(`written to ${axis}`);
    this.marking = state.chosen.axis === axis;
    state.chosen.axis = axis;
    await attempt(refresh);
    choose({ axis });
    this.marking = false;
  }

  private marked(marks: Marks): void {
    const { about } = this;
    if (!about) return;
    const bands: Band[] = [];
    const [first, last] = marks.crop ?? [0, about.seconds];
    if (first > 0) bands.push({ from: 0, to: first, kind: "crop" });
    if (last < about.seconds) bands.push({ from: last, to: about.seconds, kind: "crop" });
    for (const [from, to] of marks.fit) bands.push({ from, to, kind: "fit" });
    const validate = marks.validate_all ? [[first, last] as Stretch] : marks.validate;
    for (const [from, to] of validate) bands.push({ from, to, kind: "validate" });
    for (const out of about.excluded) bands.push({ from: out.from_s, to: out.to_s, kind: "excluded" });
    const ticks = about.findings.filter((own) => own.at_s !== null).map((own): Tick => ({ at: own.at_s!, kind: own.severity === "warning" ? "warning" : "note", text: own.message }));
    this.trace?.mark(bands, ticks);
  }

  private columns(about: About): HTMLElement {
    const list = h("ul", { class: "columns-list" });
    put(list, ...about.columns.slice(0, 40).map((column) => this.column(column)));
    const kind = choice([["", about.motion || "kind?"], ["linear", "linear"], ["rotary", "rotary"]], "", (value) => { if (value) void this.correct({ role: "kind", unit: value }); });
    kind.setAttribute("aria-label", "Kind of motion");
    return h(
      "section",
      {},
      h("h3", {}, "Columns"),
      h("p", { class: "muted small" }, `Click one to correct it; it is written to ${axisToWrite()}.`),
      list,
      h("div", { class: "row small" }, "The axis is ", kind),
      about.columns.some((column) => column.role === "time") ? null : this.rate(about),
      this.axisFile(),
    );
  }

  /** How often a log without a column of time was sampled. */
  private rate(about: About): HTMLElement {
    const rate = h("input", { type: "text", "aria-label": "Sample rate", value: about.rate_hz > 0 ? `${about.rate_hz} Hz` : "", placeholder: "1 kHz", spellcheck: "false" });
    const save = (event: Event) => {
      event.preventDefault();
      void this.correct({ role: "rate", unit: rate.value.trim() });
    };
    return h("form", { class: "rate small", onsubmit: save }, h("span", {}, "No column is the time. Samples come at"), h("div", { class: "row" }, rate, h("button", { type: "submit" }, "Write the rate")));
  }

  /** The axis file that the log is read with: its text, and how to part from one that is of another machine. */
  private axisFile(): HTMLElement | null {
    const { axis, log } = state.chosen;
    if (!axis) return null;
    const place = h("div", {});
    void editor(axis, `Text of ${axis}`).then((own) => put(place, own));
    const shared = axis === AXIS && files("log").length > 1;
    const part = async () => {
      const own = await attempt(() => post<string>("/api/axis", { log }));
      if (!own) return;
      await attempt(refresh);
      choose({ axis: own });
      say(`${own} is begun for ${log} alone`);
    };
    return h("div", { class: "small" }, shared ? h("p", { class: "muted" }, `Read as ${axis} says, as other logs of this folder with such columns are. `, h("button", { class: "quiet", onclick: () => void part() }, "This log is of another machine")) : null, place);
  }

  private column(column: Column): HTMLElement {
    const item = h("li", {});
    const name = column.name || `column ${column.number}`;
    const closed = () => put(item, h("button", { class: `column ${column.role ? "used" : ""}`, title: column.reason, onclick: () => open() }, h("span", { class: "name" }, name), column.range ? h("span", { class: "range" }, `${short(column.range[0])} … ${short(column.range[1])}`) : null, h("span", { class: `role ${column.assumed ? "assumed" : ""}` }, column.role ? `${column.role}${column.unit ? ` · ${column.unit}` : ""}${column.assumed ? " (assumed)" : ""}` : "not used")));
    const open = () => {
      this.closeOpen();
      this.closeOpen = closed;
      let role = column.role ?? "force";
      // `A, scale 96 N/A, sign inverted` as it was understood.
      const [own = "", ...more] = column.unit.split(", ");
      const unitField = h("input", { type: "text", value: own, placeholder: "mm, N, A, 1/min", spellcheck: "false" });
      const scaleField = h("input", { type: "text", value: more.find((part) => part.startsWith("scale "))?.slice(6) ?? "", placeholder: "96 N/A", spellcheck: "false" });
      const invert = h("input", { type: "checkbox", checked: more.includes("sign inverted") });
      const named = this.about?.columns.filter((other) => other.name === column.name).length ?? 2;
      const save = (event: Event) => {
        event.preventDefault();
        void this.correct({ role, column: column.number, name: named === 1 ? column.name : null, unit: unitField.value, scale: scaleField.value, invert: invert.checked });
      };
      const roleField = choice(ROLES, role, (value) => { role = value; });
      put(item, h("form", { class: "correct", onsubmit: save, onkeydown: (event: KeyboardEvent) => { if (event.key === "Escape") closed(); } }, h("strong", {}, name), h("small", { class: "muted" }, column.reason), field("is the", roleField), field("in the unit", unitField), field("times (where the force is a current or voltage)", scaleField), h("label", { class: "check" }, invert, " sign inverted"), h("div", { class: "row" }, h("button", { class: "primary", type: "submit" }, "Write"), h("button", { type: "button", class: "quiet", onclick: closed }, "Cancel"))));
      roleField.focus();
    };
    closed();
    return item;
  }

  private async correct(what: Record<string, unknown>): Promise<void> {
    const axis = axisToWrite();
    const changes = await attempt(() => post<string[]>("/api/correct", { log: state.chosen.log, axis, ...what }));
    if (!changes) return;
    const others = axis === AXIS && files("log").length > 1 ? ". Other logs that are read with it change too" : "";
    say(`${axis}: ${changes.join("; ") || "as it was"}${others}`);
    await refresh();
    choose({ axis });
  }

  private findings(about: About): HTMLElement {
    const list = about.findings.map((own) => h("li", { class: own.severity }, h("button", { class: "quiet", disabled: own.at_s === null, onclick: () => { const at = own.at_s ?? 0; const beside = Math.max(about.seconds / 50, 1e-3); this.trace?.show(at - beside, at + beside); } }, h("code", {}, own.code)), h("span", {}, own.message)));
    return h("section", {}, h("h3", {}, "Findings"), list.length ? h("ul", { class: "findings" }, ...list) : h("p", { class: "muted" }, about.refused ? "Not yet." : "Nothing is wrong with this log."));
  }

  private drawChecked(): void {
    const { log } = state.chosen;
    const job = latest("check", (own) => own.about === log);
    // Asked when it is needed: marks change the axis file and nothing is drawn anew.
    const now = () => JSON.stringify([state.chosen.axis, changedAt(state.chosen.axis ?? ""), changedAt(log ?? "")]);
    const check = async () => {
      const as = now();
      const id = await begin({ kind: "check", log, axis: state.chosen.axis });
      if (id !== undefined) checkedAs.set(id, as);
    };
    const ask = h("button", { disabled: isRunning(job) || !log, onclick: () => void check() }, "What can it determine?");
    const stale = job && !isRunning(job) && checkedAs.get(job.id) !== now();
    put(this.checked, this.heading, isRunning(job) ? progress(job!) : ask, stale ? h("p", { class: "muted" }, "What follows was found before the log or its axis file changed; ask again.") : null, job && !isRunning(job) ? (job.state === "failed" ? failed(job) : checked(job, this.about?.findings ?? [])) : null);
  }
}
