// A file of the folder as text, for what no view has a control for; written once the engine can read it.

import { get, post } from "./api";
import { attempt, h, say } from "./dom";
import { refresh } from "./state";

/** What was typed and is not written yet, with the text that it began as: kept while other views are looked at. */
const drafts = new Map<string, { before: string; text: string }>();

export async function editor(name: string, label: string): Promise<HTMLElement> {
  const read = await attempt(() => get<{ text: string }>("/api/text", { name }));
  const draft = drafts.get(name);
  let before = draft?.before ?? read?.text ?? "";
  const typed = () => {
    save.disabled = area.value === before;
    back.disabled = save.disabled;
    if (save.disabled) drafts.delete(name);
    else drafts.set(name, { before, text: area.value });
  };
  const area = h("textarea", { rows: "14", spellcheck: "false", "aria-label": `Text of ${name}`, oninput: typed });
  area.value = draft?.text ?? before;
  const save = h("button", {
    disabled: !draft,
    onclick: () => void attempt(async () => {
      await post("/api/text", { name, text: area.value, before }, "PUT");
      before = area.value;
      typed();
      say(`${name} is written`);
      await refresh();
    }),
  }, `Write ${name}`);
  const back = h("button", {
    class: "quiet",
    disabled: !draft,
    onclick: () => void attempt(async () => {
      before = (await get<{ text: string }>("/api/text", { name })).text;
      area.value = before;
      typed();
    }),
  }, "Take back");
  return h("details", { open: draft !== undefined }, h("summary", {}, label), area, h("div", { class: "row" }, save, back));
}
