// What a log determines, as `stiction check` finds it.

import type { Found, Job } from "./api";
import { h, warned } from "./dom";
import { quantity } from "./numbers";

interface Row { name: string; symbol: string; verdict: string; value: number | null; unit: string; remark: string }
export interface Checked { refused: string | null; rows: Row[]; findings: Found[]; conditioning: string[]; next: string[]; command: string }

const TAGS: Record<string, string> = { determined: "good", possible: "good" };

/** Shows it, but for findings that are shown already. */
export function checked(job: Job, known: Found[]): HTMLElement {
  const { refused, rows, findings, conditioning, next, command } = (job.json as { logs: [Checked] }).logs[0];
  const more = findings.filter((own) => !known.some((one) => one.code === own.code));
  const row = (own: Row) => h("tr", {}, h("th", { scope: "row" }, own.name.replaceAll("_", " "), " ", h("span", { class: "symbol" }, own.symbol)), h("td", {}, h("span", { class: `tag ${TAGS[own.verdict] ?? "warn"}` }, own.verdict)), h("td", { class: "number" }, own.value === null ? "" : quantity(own.value, own.unit)), h("td", { class: "small" }, own.remark));
  return h(
    "div",
    { class: "found" },
    h("div", { class: `banner ${refused ? "warn" : "good"}` }, h("strong", {}, refused ? "Not to be relied on as it is" : "A law fits this log and may be used"), refused ? h("p", {}, refused) : null),
    rows.length ? h("table", {}, h("caption", {}, rows.some((own) => own.symbol) ? "What the log determines" : "What its motion can show"), h("tbody", {}, ...rows.map(row))) : null,
    more.length ? warned(more) : null,
    conditioning.length ? h("details", {}, h("summary", {}, "How it is conditioned"), h("ul", {}, ...conditioning.map((line) => h("li", { class: "small" }, line)))) : null,
    h("div", {}, h("h3", {}, "Next"), ...next.map((line) => (line.startsWith(" ") ? h("pre", {}, line.trim()) : h("p", {}, line))), h("pre", { tabindex: "0" }, command)),
  );
}
