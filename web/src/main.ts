// The page: a bar with the views, the files of the folder beside it, and the view that is chosen.

import "uplot/dist/uPlot.min.css";
import "./style.css";
import { begin, NoSession, upload, watch, type Job } from "./api";
import { attempt, choice, field, h, put, say } from "./dom";
import { Working } from "./jobs";
import { bytes } from "./numbers";
import { changed, choose, chooseLog, exists, files, follow, logsOf, onChange, readAddress, refresh, state, VIEWS, type View } from "./state";
import { ChangeView } from "./views/change";
import { DriftView } from "./views/drift";
import { ExportView } from "./views/export";
import { IdentifyView } from "./views/identify";
import { LogView } from "./views/log";
import { PlanView } from "./views/plan";
import { StudyView } from "./views/study";

interface Shown { element: HTMLElement; end(): void }

const made: Record<View, () => Shown> = {
  log: () => new LogView(),
  identify: () => new IdentifyView(),
  study: () => new StudyView(),
  plan: () => new PlanView(),
  export: () => new ExportView(),
  change: () => new ChangeView(),
  drift: () => new DriftView(),
};

const tabs = h("nav", { "aria-label": "Views" });
const side = h("aside", { "aria-label": "Files of the folder" });
const working = new Working();
const main = h("main", { id: "main", tabindex: "-1" });
const folder = h("span", { class: "folder" });
const picker = h("input", { type: "file", multiple: true, class: "hidden", tabindex: "-1", "aria-hidden": "true", onchange: () => void take([...(picker.files ?? [])]) });

/** Puts files into the folder and shows the last log of them. */
async function take(dropped: File[]): Promise<void> {
  for (const file of dropped) {
    const there = exists(file.name);
    if (there && !confirm(`${file.name} is in the folder already. Replace it?`)) continue;
    await attempt(async () => {
      say(`reading ${file.name} (${bytes(file.size)}) …`);
      await upload(file, there);
      await refresh();
      put(document.getElementById("said")!);
      if (files("log").some((own) => own.name === file.name)) await chooseLog(file.name, { view: "log" });
      else say(`${file.name} is in the folder. It is not listed as a log: ${/\.(csv|json|parquet)$/i.test(file.name) ? "stiction writes files of that name, so give a log another one" : "its ending is not one of a log"}.`);
    });
  }
  picker.value = "";
}

function drawTabs(): void {
  put(tabs, ...VIEWS.map(([view, label]) => h("button", { "aria-current": state.chosen.view === view ? "page" : null, onclick: () => choose({ view }) }, label)));
}

function drawSide(): void {
  const { chosen, workspace } = state;
  put(folder, h("bdi", {}, workspace.folder));
  const logs = files("log");
  const axes = files("axis");
  put(
    side,
    h("button", { class: "drop", onclick: () => picker.click() }, h("strong", {}, "Choose logs"), h("span", {}, "or drop them anywhere")),
    h("h2", {}, "Logs"),
    logs.length
      ? h("ul", { class: "files" }, ...logs.map((file) => h("li", {}, h("button", { "aria-current": file.name === chosen.log ? "true" : null, title: file.name, onclick: () => void chooseLog(file.name, { view: "log" }) }, h("span", { class: "name" }, file.name), h("span", { class: "size" }, bytes(file.bytes))))))
      : h("p", { class: "muted" }, "None yet. CSV, MATLAB, HDF5, Parquet, TwinCAT and others."),
    working.element,
    h("h2", {}, "What is known of the axis"),
    field("Axis file", choice([["", "none: as found"], ...axes.map((file): [string, string] => [file.name, file.name])], chosen.axis ?? "", (axis) => choose({ axis: axis || null }))),
    h("h2", {}, "Results"),
    files("result").length
      ? h("ul", { class: "files" }, ...files("result").map((file) => h("li", {}, h("button", { "aria-current": file.name === chosen.result ? "true" : null, title: file.name, onclick: () => void follow(file.name, { result: file.name, view: "identify" }) }, h("span", { class: "name" }, file.name), h("span", { class: "size" }, `of ${logsOf(file)}`)))))
      : h("p", { class: "muted" }, "None yet."),
  );
}

/** The view in which work of a kind is begun. */
function viewOf({ kind, about }: Job): View {
  return ({ check: about.includes(", ") ? "change" : "log", simulate: "study" } as Record<string, View>)[kind] ?? (kind as View);
}

let shown: Shown | null = null;
let view: View | null = null;

function draw(): void {
  drawTabs();
  drawSide();
  if (view === state.chosen.view) return;
  view = state.chosen.view;
  shown?.end();
  shown = made[view]();
  put(main, shown.element);
}

async function start(): Promise<void> {
  const page = document.getElementById("page")!;
  const said = h("div", { id: "said", role: "status", "aria-live": "polite" });
  try {
    await begin();
    await refresh();
  } catch (error) {
    const why = error instanceof Error ? error.message : String(error);
    put(page, h("main", { class: "closed" }, h("h1", {}, "stiction studio"), h("p", {}, error instanceof NoSession ? "This browser has no session here." : "The page could not begin."), h("p", {}, why)));
    return;
  }
  put(
    page,
    h("a", { class: "skip", href: "#main", onclick: (event: Event) => { event.preventDefault(); main.focus(); } }, "Skip to the view"),
    h("header", {}, h("h1", {}, "stiction", h("span", {}, " studio")), tabs, folder),
    h("div", { class: "body" }, side, main),
    said,
    picker,
  );
  addEventListener("dragover", (event) => { event.preventDefault(); document.body.classList.add("dragging"); });
  addEventListener("dragleave", (event) => { if (!event.relatedTarget) document.body.classList.remove("dragging"); });
  addEventListener("drop", (event) => {
    event.preventDefault();
    document.body.classList.remove("dragging");
    void take([...(event.dataTransfer?.files ?? [])]);
  });
  // Back and forth, or an address that was typed.
  addEventListener("popstate", () => { readAddress(); choose({}); });
  // Files may be written by other programs meanwhile.
  addEventListener("focus", () => void attempt(refresh));
  readAddress();
  const { log, axis } = state.chosen;
  if (log && !axis) await chooseLog(log);
  onChange((reason) => {
    if (reason === "jobs") working.draw();
    else draw();
  });
  choose({});
  const ended = new Set<number>();
  let first = true;
  void watch(
    (job) => {
      const before = state.jobs.get(job.id);
      state.jobs.set(job.id, job);
      if (["done", "failed"].includes(job.state) && before && before.state !== job.state && !ended.has(job.id)) {
        ended.add(job.id);
        if (state.chosen.view !== viewOf(job)) say(`${job.kind} ${job.about}: ${job.state === "failed" ? `not done. ${job.text}` : "done"}`, job.state === "failed" ? "error" : "note");
        void attempt(refresh);
      }
      onJobs();
    },
    (why) => {
      if (why) say(why, "error");
      else if (!first) put(said);
      first = false;
    },
  );
}

let told = 0;
/** Tells the views of jobs, once a frame. */
function onJobs(): void {
  cancelAnimationFrame(told);
  told = requestAnimationFrame(() => changed("jobs"));
}

void start();
