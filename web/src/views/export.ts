// The compensator as code or numbers for a controller.

import { get, open } from "../api";
import { commandLine } from "../command";
import { attempt, choice, field, h, put, warned } from "../dom";
import { begin, failed, isRunning, latest, printed, progress } from "../jobs";
import { older, rateOf, whenceOf } from "../origin";
import { changedAt, exists, files, fits, follow, labelled, onChange, state } from "../state";

const WORDS: Record<string, string> = {
  c: "C99", cpp: "C++ for Arduino and others", ros2: "C++ as a ROS 2 node's class", st: "Structured Text (IEC 61131-3)", tcpou: "TwinCAT 3 objects", plcopen: "PLCopen XML",
  rust: "Rust, no_std", mujoco: "MuJoCo joint", modelica: "Modelica", urdf: "URDF joint", sdf: "SDFormat joint", isaaclab: "Isaac Lab actuator", hal: "LinuxCNC HAL component",
  fmu: "FMU 2.0 and 3.0", matlab: "MATLAB, Octave and Simulink", tf5200: "TwinCAT CNC friction table", "drive-table": "Numbers for a drive's own compensation",
};

/** What may be fed forward beside friction. */
const BESIDE = ["mass", "gravity", "cogging"];

interface Exported { warnings: { code: string; message: string }[]; written: string[]; trustworthy: boolean }

export class ExportView {
  readonly element = h("div", { class: "view export" });
  private readonly command = commandLine();
  private readonly form = h("section", { class: "form", "aria-label": "What is exported" });
  private readonly found = h("section", { class: "found", "aria-label": "The files", "aria-live": "polite" });
  private readonly whence = h("div", {});
  private readonly stop: () => void;
  private targets: { name: string; simulated: boolean }[] = [];
  private model = "";
  private target = "c";
  private cycle = "";
  /** Time between two samples of the log that the model is of, s. */
  private ofLog = 0.001;
  private gain = "";
  private limit = "";
  private rated = "";
  private adapt = false;
  private beside: string[] = [];
  private replace = false;
  private out = "";

  constructor() {
    put(this.element, h("div", { class: "head" }, h("h2", {}, "Export"), h("span", { class: "muted" }, "the compensator as code or numbers for a controller")), h("div", { class: "split" }, this.form, h("div", { class: "center" }, this.whence, this.found)), this.command.element);
    this.model = this.usual();
    this.stop = onChange((reason) => {
      const moves = reason !== "jobs" && (!this.model || !fits(this.model));
      if (moves) this.model = this.usual();
      if (reason === "files" || moves) this.drawForm();
      else if (reason === "chosen") void this.drawOrigin();
      this.drawFound();
    });
    void attempt(async () => {
      this.targets = await get("/api/targets");
      this.drawForm();
    });
    this.drawFound();
  }

  end(): void { this.stop(); }

  /** The model of the chosen result, else another one of the chosen log. */
  private usual(): string {
    const own = `${state.chosen.result}/model.toml`;
    return exists(own) ? own : (files("model").find((file) => fits(file.name))?.name ?? "");
  }

  private pick(model: string): void {
    this.model = model;
    this.drawForm();
    this.drawFound();
    const result = model.replace(/\/?[^/]*$/, "");
    void follow(model, exists(`${result}/result.json`) ? { result } : {});
  }

  /** Whether the target is code that runs on a controller, and no table or joint of a simulator. */
  private get runs(): boolean {
    const simulated = this.targets.find((own) => own.name === this.target)?.simulated ?? false;
    return !simulated && !["tf5200", "drive-table"].includes(this.target);
  }

  private asked() {
    const number = (text: string) => (text === "" ? null : Number(text));
    const { runs } = this;
    return { kind: "export", model: this.model, target: this.target, cycle_time: number(this.cycle) ?? this.ofLog, gain: number(this.gain), limit: number(this.limit), rated_force: number(this.rated), adapt: runs && this.adapt, beside: runs ? this.beside : [], out: this.out, force: this.replace };
  }

  private drawForm(): void {
    const models = files("model");
    if (!models.length) {
      put(this.form, h("p", {}, "There is no model yet: identify one first."));
      this.command.show("stiction export result/model.toml --target c --out code");
      return;
    }
    void this.drawOrigin();
    const model = field("Model", choice([...(this.model ? [] : [["", "choose"] as [string, string]]), ...labelled("model")], this.model, (value) => { if (value) this.pick(value); }));
    if (!this.model) {
      put(this.form, h("p", {}, `There is no model of ${state.chosen.log} yet: identify it first, or choose another model.`), model);
      this.command.show("stiction export MODEL --target c --out code");
      return;
    }
    const folder = this.model.includes("/") ? this.model.slice(0, this.model.lastIndexOf("/") + 1) : "";
    this.out = `${folder}${this.target}`;
    const again = () => this.command.of(this.asked());
    const number = (value: string, placeholder: string, set: (value: string) => void) => {
      const own = h("input", { type: "number", step: "any", min: "0", value, placeholder, oninput: () => { set(own.value); again(); } });
      return own;
    };
    const out = h("input", { type: "text", value: this.out, spellcheck: "false", oninput: () => { this.out = out.value.trim(); again(); } });
    const adapt = h("input", { type: "checkbox", checked: this.adapt, onchange: () => { this.adapt = adapt.checked; again(); } });
    const replace = h("input", { type: "checkbox", checked: this.replace, onchange: () => { this.replace = replace.checked; again(); } });
    const part = (name: string) => {
      const own = h("input", { type: "checkbox", checked: this.beside.includes(name), onchange: () => {
        this.beside = BESIDE.filter((each) => (each === name ? own.checked : this.beside.includes(each)));
        again();
      } });
      return h("label", {}, own, ` ${name}`);
    };
    const simulated = this.targets.find((own) => own.name === this.target)?.simulated ?? false;
    put(
      this.form,
      model,
      field("Target", choice(this.targets.map((own): [string, string] => [own.name, WORDS[own.name] ?? own.name]), this.target, (value) => { this.target = value; this.drawForm(); })),
      field("Time between two calls [s]", number(this.cycle, String(this.ofLog), (value) => { this.cycle = value; })),
      simulated || this.target === "drive-table" ? null : field("Share that is compensated", number(this.gain, "0.75", (value) => { this.gain = value; }), "0 to 1; what is left keeps the loop calm"),
      simulated || this.target === "drive-table" ? null : field("Largest force", number(this.limit, "from the law", (value) => { this.limit = value; })),
      this.target === "tf5200" ? field("Rated force of the motor", number(this.rated, "", (value) => { this.rated = value; })) : null,
      this.runs ? h("label", { class: "check" }, adapt, " levels follow the machine") : null,
      this.runs ? h("fieldset", {}, h("legend", {}, "Fed forward beside friction"), h("div", { class: "row" }, ...BESIDE.map(part))) : null,
      field("Folder for the files", out),
      h("label", { class: "check" }, replace, " replace files of the same names"),
      h("button", { class: "primary wide", onclick: () => void begin(this.asked()) }, "Export"),
    );
    again();
  }

  /** What the model is of, where it is that of a result. */
  private async drawOrigin(): Promise<void> {
    const { model } = this;
    const [found, rate] = [await whenceOf(model), await rateOf(model)];
    if (model !== this.model) return;
    put(this.whence, ...found);
    const ofLog = rate ? Number(Math.min(Math.max(1 / rate, 1e-6), 0.1).toPrecision(4)) : 0.001;
    if (ofLog === this.ofLog) return;
    this.ofLog = ofLog;
    this.drawForm();
  }

  private drawFound(): void {
    const job = latest("export", (own) => own.about === this.model);
    if (!job) {
      put(this.found, h("p", { class: "muted" }, "Nothing exported yet. Every export comes with vectors with which the target can test itself."));
      return;
    }
    if (isRunning(job)) {
      put(this.found, progress(job));
      return;
    }
    if (job.state === "failed" || !job.folder) {
      put(this.found, failed(job));
      return;
    }
    const folder = job.folder;
    const exported = job.json as Exported;
    put(
      this.found,
      h("div", { class: "row spread" }, h("h3", {}, folder), h("button", { class: "primary", onclick: () => void attempt(() => open(folder, "zip")) }, "Download as zip")),
      changedAt(job.about) > changedAt(`${folder}/${exported.written[0]}`) ? older("Older than its model", `${job.about} changed after these files were written. Export again.`) : null,
      exported.trustworthy ? h("div", { class: `banner ${exported.warnings.length ? "warn" : "good"}` }, h("strong", {}, exported.warnings.length ? "May be used within what the warnings say" : "Every number may be relied on")) : h("div", { class: "banner warn" }, h("strong", {}, "The identification does not trust every number of this law")),
      exported.warnings.length ? warned(exported.warnings) : h("p", { class: "muted" }, "No warnings."),
      h("ul", { class: "files" }, ...exported.written.map((name) => h("li", {}, h("button", { title: `Save ${name}`, onclick: () => void attempt(() => open(`${folder}/${name}`, "save")) }, h("span", { class: "name" }, name))))),
      printed(job),
    );
  }
}
