// Work as it goes: how far it is, how to stop it, and what it printed.

import { post, type Job } from "./api";
import { attempt, h } from "./dom";
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

/** A bar with what is being done, and a button that stops it and keeps what was found. */
export function progress(job: Job): HTMLElement {
  const percent = Math.round(100 * job.fraction);
  const facts = [
    job.stage ?? "reading",
    job.error_percent === null ? "" : `error ${short(job.error_percent)} %`,
    `${seconds(job.seconds)} so far`,
    job.left === null || job.left < 1 ? "" : `this step ${seconds(job.left)} more`,
  ];
  return h(
    "div",
    { class: "progress" },
    h("div", { class: "row" }, h("span", {}, facts.filter(Boolean).join(" · ")), h("button", { disabled: job.state === "stopping", onclick: () => void attempt(() => post(`/api/jobs/${job.id}/stop`, {})) }, job.state === "stopping" ? "stopping …" : "Stop and keep what was found")),
    h("progress", { max: "100", value: String(percent), "aria-label": `${job.kind}: ${job.stage ?? "reading"}` }),
  );
}

/** What the command line prints, or why the work failed. */
export function printed(job: Job): HTMLElement {
  if (job.state === "failed") return h("div", { class: "banner bad", role: "alert" }, h("strong", {}, "Not done"), h("p", {}, job.text));
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
