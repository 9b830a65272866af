// What a result is of, and whether that changed after it was found.

import { get } from "./api";
import { attempt, h } from "./dom";
import { changedAt, entry, exists, hashOf, isOf, logsOf, nameOf, state } from "./state";

export interface Origin { inputs: { path: string; sha256: string; rate_hz?: number }[]; axis: { file?: string } }

/** The result of a folder. */
export async function readResult<T extends Origin>(folder: string): Promise<T> {
  return JSON.parse((await get<{ text: string }>("/api/text", { name: `${folder}/result.json` })).text) as T;
}

/** The logs and the axis file of a result, and which of them changed after it. */
export function whence(own: Origin, folder: string): (HTMLElement | null)[] {
  const logs = own.inputs.map((input) => ({ name: nameOf(input.path), sha256: input.sha256 }));
  const inputs = [...new Set(logs.map((log) => log.name))];
  const axis = own.axis.file ? nameOf(own.axis.file) : null;
  const found = changedAt(`${folder}/result.json`);
  const later = (name: string) => changedAt(name) > found;
  // A log that was read is known by its hash, another one by its time.
  const other = inputs.filter((name) => (hashOf(name) ? !logs.some((log) => log.name === name && log.sha256 === hashOf(name)) : later(name)));
  const changed = axis && later(axis) ? [...other, axis] : other;
  return [
    h("p", { class: "muted" }, `${folder}: of ${inputs.join(", ")}${axis ? `, read as ${axis} says` : ", read as found"}.`),
    changed.length ? older("Older than what it is of", `${changed.join(", ")} changed after this was identified. Identify again to see what that makes of it.`) : null,
    ofAnother(folder),
  ];
}

/** The same of a study or a model: of the result that it is in, else of the logs that it comes from. */
export async function whenceOf(file: string): Promise<(HTMLElement | null)[]> {
  const folder = file.replace(/\/?[^/]*$/, "");
  const own = exists(`${folder}/result.json`) ? await attempt(() => readResult(folder)) : undefined;
  if (own) return whence(own, folder);
  const found = entry(file);
  return found ? [h("p", { class: "muted" }, `${file}: ${found.of.length ? `of ${logsOf(found)}` : "of no log"}.`), ofAnother(file)] : [];
}

/** The largest sample rate of the logs that a model is of, Hz, where it is that of a result. */
export async function rateOf(model: string): Promise<number | undefined> {
  const folder = model.replace(/\/?[^/]*$/, "");
  const own = exists(`${folder}/result.json`) ? await attempt(() => readResult(folder)) : undefined;
  const rates = (own?.inputs ?? []).map((input) => input.rate_hz ?? 0).filter((rate) => rate > 0);
  return rates.length ? Math.max(...rates) : undefined;
}

/** That something comes from other logs than the one that is chosen. */
function ofAnother(name: string): HTMLElement | null {
  const { log } = state.chosen;
  const own = entry(name);
  if (!own?.of.length || !log || isOf(own, log)) return null;
  const same = own.of.some((one) => one.name === log);
  return older(`Not of ${log}`, same ? `${log} is another recording now than the one that this is of.` : `This is of ${logsOf(own)}. Choose that log beside, or identify ${log}.`);
}

/** Something that is not of what stands beside it. */
export function older(title: string, text: string): HTMLElement {
  return h("div", { class: "banner warn" }, h("strong", {}, title), h("p", {}, text));
}
