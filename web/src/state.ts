// What is chosen, kept in the fragment of the address: a reload and a second tab see the same.

import { get, type About, type Entry, type Job, type Which, type Workspace } from "./api";
import { attempt, say } from "./dom";
import { showIn } from "./numbers";

export type View = "log" | "identify" | "study" | "plan" | "export" | "change" | "drift";
export const VIEWS: [View, string][] = [["log", "Log"], ["identify", "Identify"], ["study", "Study"], ["plan", "Plan"], ["export", "Export"], ["change", "Before and after"], ["drift", "Drift"]];

export interface Chosen { view: View; log: string | null; axis: string | null; result: string | null }

export const state = {
  workspace: { folder: "", version: "", files: [], units: [] } as Workspace,
  jobs: new Map<number, Job>(),
  chosen: { view: "log", log: null, axis: null, result: null } as Chosen,
};

type Reason = "chosen" | "files" | "jobs";
const listeners = new Set<(reason: Reason) => void>();

/** Calls back when something changed; returns how to end that. */
export function onChange(listener: (reason: Reason) => void): () => void {
  listeners.add(listener);
  return () => listeners.delete(listener);
}

export function changed(reason: Reason): void {
  for (const listener of [...listeners]) listener(reason);
}

export function files(...kinds: string[]): Entry[] {
  return state.workspace.files.filter((file) => kinds.includes(file.kind));
}

export function entry(name: string): Entry | undefined {
  return state.workspace.files.find((file) => file.name === name);
}

export function exists(name: string): boolean {
  return entry(name) !== undefined;
}

/** What is in a log, read once for all who ask until the log or its axis file changes. */
let read = { key: "", about: Promise.resolve<About | null>(null) };

export function aboutLog(log: string, axis: string | null): Promise<About | null> {
  const key = JSON.stringify([log, changedAt(log), axis, changedAt(axis ?? "")]);
  if (key !== read.key) read = { key, about: attempt(() => get<About>("/api/log", { name: log, axis })).then((own) => own ?? null) };
  return read.about;
}

/** Hashes of the logs that were read. */
const hashes = new Map<string, string>();

function version(log: string): string {
  return JSON.stringify([log, entry(log)?.bytes, changedAt(log)]);
}

/** The hash of a log as it is now, where it was read. */
export function hashOf(log: string): string | undefined {
  return hashes.get(version(log));
}

/** Reads the chosen log for its hash, which says more than its name what is of it. */
async function identifyLog(): Promise<void> {
  const { log, axis } = state.chosen;
  if (!log) return;
  const own = version(log);
  if (hashes.has(own)) return;
  const about = await aboutLog(log, axis);
  if (!about?.sha256 || hashes.has(own)) return;
  hashes.set(own, about.sha256);
  changed("chosen");
}

/** Whether something comes from a log: from the same bytes, or before these were read from a log of its name. */
export function isOf(own: Entry, log: string): boolean {
  const hash = hashOf(log);
  return own.of.some((one) => (hash ? one.sha256 === hash : one.name === log));
}

/** Whether something may be shown for the chosen log by itself: it comes from it, from no log, or from none of the folder. */
export function fits(name: string): boolean {
  const own = entry(name);
  const { log } = state.chosen;
  return !own || !log || isOf(own, log) || !own.of.some((one) => one.name !== log && exists(one.name));
}

/** The names of the logs that something comes from. */
export function logsOf(own: Entry): string {
  return [...new Set(own.of.map((one) => one.name))].join(", ");
}

/** Files to choose from, each with the log that it comes from where that is another one than the chosen. */
export function labelled(...kinds: string[]): [value: string, label: string][] {
  const { log } = state.chosen;
  return files(...kinds).map((own) => [own.name, own.of.length && !(log && isOf(own, log)) ? `${own.name} (of ${logsOf(own)})` : own.name]);
}

/** Reads the address, then chooses what is there for what it leaves open. */
export function readAddress(): void {
  const given = new URLSearchParams(location.hash.slice(1));
  const view = given.get("view") as View | null;
  state.chosen.view = VIEWS.some(([own]) => own === view) ? view! : "log";
  for (const key of ["log", "axis", "result"] as const) state.chosen[key] = given.get(key) || null;
  settle();
}

function settle(): void {
  const { chosen } = state;
  if (chosen.log && !exists(chosen.log)) chosen.log = null;
  if (chosen.axis && !exists(chosen.axis)) chosen.axis = null;
  if (chosen.result && !exists(chosen.result)) chosen.result = null;
  chosen.log ??= files("log")[0]?.name ?? null;
  chosen.result ??= files("result").filter((own) => !chosen.log || isOf(own, chosen.log)).sort((a, b) => b.modified - a.modified)[0]?.name ?? null;
}

/** Chooses something, and shows it in the address; another view or file can be gone back from. */
export function choose(what: Partial<Chosen>): void {
  const before = { ...state.chosen };
  Object.assign(state.chosen, what);
  // The result of one log is none of another.
  if (state.chosen.log !== before.log && !what.result) state.chosen.result = null;
  settle();
  const out = new URLSearchParams();
  for (const [key, value] of Object.entries(state.chosen)) if (value) out.set(key, value);
  const moved = (["view", "log", "result"] as const).some((key) => what[key] !== undefined && state.chosen[key] !== before[key]);
  history[moved ? "pushState" : "replaceState"](null, "", `#${out}`);
  changed("chosen");
  void identifyLog();
}

/** Chooses something with the log that a file comes from: what is shown and the line below it are of one log. */
export async function follow(name: string, what: Partial<Chosen>): Promise<void> {
  const { log } = state.chosen;
  const own = entry(name);
  const from = own && !(log && isOf(own, log)) ? own.of.map((one) => one.name).find(exists) : log;
  if (from && from !== log) await chooseLog(from, what);
  else choose(what);
}

/** The name in the folder of a path that a result has. */
export function nameOf(path: string): string {
  const before = `${state.workspace.folder}/`;
  return path.startsWith(before) ? path.slice(before.length) : path;
}

/** The axis file of the folder, unless a log has its own. */
export const AXIS = "axis.toml";

/** The name of a log without its ending. */
export function stem(log: string): string {
  return log.replace(/\.[^./]*$/, "");
}

/** The axis file that corrections of the chosen log go to: that which it is read with, else one that is begun. */
export function axisToWrite(): string {
  const { log, axis } = state.chosen;
  return axis ?? (exists(AXIS) && log ? `${stem(log)}.axis.toml` : AXIS);
}

let asked = 0;

/** Chooses a log with the axis file that it is read with. */
export async function chooseLog(log: string, what: Partial<Chosen> = {}): Promise<void> {
  asked += 1;
  const mine = asked;
  const found = await attempt(() => get<Which>("/api/axis", { log }));
  if (mine !== asked) return;
  choose({ log, axis: found?.axis ?? null, ...what });
  if (found?.not) say(`${found.not} names columns that ${log} does not have, so the log is read as it is found. What you correct goes to ${axisToWrite()}.`);
}

/** When a file was changed last, ms; 0 where there is none. */
export function changedAt(name: string): number {
  return entry(name)?.modified ?? 0;
}

/** Reads what is in the folder. */
export async function refresh(): Promise<void> {
  const had = !state.workspace.version || exists(AXIS);
  state.workspace = await get<Workspace>("/api/workspace");
  showIn(state.workspace.units);
  // The axis file of the usual name is used once it is there.
  if (!had && exists(AXIS)) state.chosen.axis ??= AXIS;
  settle();
  changed("files");
  void identifyLog();
}
