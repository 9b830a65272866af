// Work as it goes: how far it is, how to stop it, and what it printed.

import { post, type Job } from "./api";
import { attempt, cleaned, h, put } from "./dom";
import { seconds, short } from "./numbers";
import { state } from "./state";

/** The latest work of a kind that fits. */
export function latest(kind: string, fits: (job: Job) => boolean = () => true): Job | null {
  const all = [...state.jobs.values()].filter((job) => job.kind === kind && fits(job));
  return all.sort((a, b) => b.id - a.id)[0] ?? null;
}

export function isRunning(job: Job | null): boolean {
  return job !== null && (job.state === "running" || job.state === "stopping");
}

export async function begin(asked: unknown): Promise<number | undefined> {
  return attempt(() => post<number>("/api/jobs", asked));
}

/** What shows that work goes on: made once for each, since it is told of several times a second. */
class Progress {
  readonly facts = h("span");
  readonly stop: HTMLButtonElement;
  readonly bar = h("progress", { max: "100" });
  readonly root: HTMLElement;

  constructor(id: number) {
    this.stop = h("button", { onclick: () => void stopped(id) });
    this.root = h("div", { class: "progress" }, h("div", { class: "row" }, this.facts, this.stop), this.bar);
  }
}

const going = new Map<number, Progress>();

/** All work that goes on, whichever log or folder it is about, each with a button that stops it. */
export class Working {
  readonly element = h("section", { class: "working hidden", "aria-label": "Work that goes on" });
  private readonly title = h("h2", {}, "At work");
  private readonly lines = new Map<number, { about: HTMLElement; far: HTMLElement; root: HTMLElement }>();

  draw(): void {
    const running = [...state.jobs.values()].filter(isRunning);
    put(this.element, this.title, ...running.map((job) => this.line(job)));
    this.element.classList.toggle("hidden", !running.length);
  }

  private line(job: Job): HTMLElement {
    let own = this.lines.get(job.id);
    if (!own) {
      const [about, far] = [h("span", { class: "name", title: job.command }), h("span", { class: "size" })];
      const stop = h("button", { class: "quiet", "aria-label": `Stop ${job.kind} ${job.about}`, onclick: () => void stopped(job.id) }, "Stop");
      own = { about, far, root: h("div", { class: "row" }, about, far, stop) };
      this.lines.set(job.id, own);
    }
    own.about.textContent = cleaned(`${job.kind} ${job.about}`);
    own.far.textContent = job.state === "stopping" ? "stopping …" : `${Math.round(100 * job.fraction)} %`;
    return own.root;
  }
}

/** Asks work to stop; what it found until then is kept. */
async function stopped(id: number): Promise<void> {
  await attempt(() => post(`/api/jobs/${id}/stop`, {}));
}

/** A bar with what is being done, and a button that stops it and keeps what was found. */
export function progress(job: Job): HTMLElement {
  const shown = going.get(job.id) ?? new Progress(job.id);
  going.set(job.id, shown);
  const percent = Math.round(100 * job.fraction);
  const facts = [
    job.stage ?? "reading",
    job.error_percent === null ? "" : `error ${short(job.error_percent)} %`,
    `${seconds(job.seconds)} so far`,
    job.left === null || job.left < 1 ? "" : `this step ${seconds(job.left)} more`,
  ];
  shown.facts.textContent = facts.filter(Boolean).join(" · ");
  const stopping = job.state === "stopping";
  const label = stopping ? "stopping …" : "Stop and keep what was found";
  shown.stop.disabled = stopping;
  if (shown.stop.textContent !== label) shown.stop.textContent = label;
  shown.bar.value = percent;
  shown.bar.setAttribute("aria-label", `${job.kind}: ${job.stage ?? "reading"}`);
  return shown.root;
}

/** Why work failed. */
export function failed(job: Job): HTMLElement {
  return h("div", { class: "banner bad", role: "alert" }, h("strong", {}, "Not done"), h("p", {}, job.text));
}

/** What the command line prints, folded. */
export function printed(job: Job): HTMLElement {
  return h("details", {}, h("summary", {}, "As the command line prints it"), h("pre", { tabindex: "0" }, job.text.trimEnd()));
}

/** The verdict in a word. */
export function verdict(job: Job): HTMLElement | null {
  const words: Record<string, [string, string]> = {
    trustworthy: ["good", "May be relied on"],
    "not-trustworthy": ["warn", "Not to be relied on as it is"],
    interrupted: ["warn", "Stopped: what was found until then"],
  };
  const found = job.verdict ? words[job.verdict] : undefined;
  return found ? h("div", { class: `banner ${found[0]}` }, h("strong", {}, found[1])) : null;
}
