// What is chosen, kept in the fragment of the address: a reload and a second tab see the same.

import { get, type Entry, type Job, type Workspace } from "./api";

export type View = "log" | "identify" | "study" | "plan" | "export";
export const VIEWS: [View, string][] = [["log", "Log"], ["identify", "Identify"], ["study", "Study"], ["plan", "Plan"], ["export", "Export"]];

export interface Chosen { view: View; log: string | null; axis: string | null; result: string | null }

export const state = {
  workspace: { folder: "", version: "", files: [] } as Workspace,
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

export function exists(name: string): boolean {
  return state.workspace.files.some((file) => file.name === name);
}

/** Reads the address, then chooses what is there for what it leaves open. */
export function readAddress(): void {
  const given = new URLSearchParams(location.hash.slice(1));
  const view = given.get("view") as View | null;
  state.chosen.view = VIEWS.some(([own]) => own === view) ? view! : "log";
  for (const key of ["log", "axis", "result"] as const) {
    const name = given.get(key);
    if (name !== null) state.chosen[key] = name || null;
  }
  settle();
}

function settle(): void {
  const { chosen } = state;
  if (chosen.log && !exists(chosen.log)) chosen.log = null;
  if (chosen.axis && !exists(chosen.axis)) chosen.axis = null;
  if (chosen.result && !exists(chosen.result)) chosen.result = null;
  chosen.log ??= files("log")[0]?.name ?? null;
  chosen.result ??= files("result").sort((a, b) => b.modified - a.modified)[0]?.name ?? null;
}

/** Chooses something, and shows it in the address. */
export function choose(what: Partial<Chosen>): void {
  Object.assign(state.chosen, what);
  settle();
  const out = new URLSearchParams();
  for (const [key, value] of Object.entries(state.chosen)) if (value) out.set(key, value);
  history.replaceState(null, "", `#${out}`);
  changed("chosen");
}

/** Reads what is in the folder. */
export async function refresh(): Promise<void> {
  const had = exists("axis.toml");
  state.workspace = await get<Workspace>("/api/workspace");
  // The axis file of the usual name is used once it is there.
  if (!had && exists("axis.toml")) state.chosen.axis ??= "axis.toml";
  settle();
  changed("files");
}
