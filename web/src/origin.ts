// What a result is of, and whether that changed after it was found.

import { get } from "./api";
import { attempt, h } from "./dom";
import { changedAt, exists, nameOf, state } from "./state";

export interface Origin { inputs: { path: string }[]; axis: { file?: string } }

/** The result of a folder. */
export async function readResult<T extends Origin>(folder: string): Promise<T> {
  return JSON.parse((await get<{ text: string }>("/api/text", { name: `${folder}/result.json` })).text) as T;
}

export function isOf(own: Origin, log: string): boolean {
  return own.inputs.some((input) => nameOf(input.path) === log);
}

/** The logs and the axis file of a result, and which of them changed after it. */
export function whence(own: Origin, folder: string): (HTMLElement | null)[] {
  const inputs = [...new Set(own.inputs.map((input) => nameOf(input.path)))];
  const axis = own.axis.file ? nameOf(own.axis.file) : null;
  const found = changedAt(`${folder}/result.json`);
  const later = [...inputs, axis].filter((name) => name && changedAt(name) > found);
  return [
    h("p", { class: "muted" }, `${folder}: of ${inputs.join(", ")}${axis ? `, read as ${axis} says` : ", read as found"}.`),
    later.length ? older("Older than what it is of", `${later.join(", ")} changed after this was identified. Identify again to see what that makes of it.`) : null,
  ];
}

/** The same of the result that a file is of, where it is one of a result. */
export async function whenceOf(file: string): Promise<(HTMLElement | null)[]> {
  const folder = file.replace(/\/?[^/]*$/, "");
  const own = exists(`${folder}/result.json`) ? await attempt(() => readResult(folder)) : undefined;
  return own ? whence(own, folder) : [];
}

/** That a result is of another log than the one that is chosen. */
export function ofAnother(own: Origin): HTMLElement | null {
  const { log } = state.chosen;
  return log && !isOf(own, log) ? older(`Not of ${log}`, "This is the result of another log than the one that is chosen.") : null;
}

/** Something that is not of what stands beside it. */
export function older(title: string, text: string): HTMLElement {
  return h("div", { class: "banner warn" }, h("strong", {}, title), h("p", {}, text));
}
