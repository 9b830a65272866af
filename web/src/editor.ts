// A file of the folder as text, for what no view has a control for; written once the engine can read it.

import { get, post } from "./api";
import { attempt, h, say } from "./dom";
import { refresh } from "./state";

export async function editor(name: string, label: string): Promise<HTMLElement> {
  const read = await attempt(() => get<{ text: string }>("/api/text", { name }));
  let before = read?.text ?? "";
  const area = h("textarea", { rows: "14", spellcheck: "false", "aria-label": `Text of ${name}`, oninput: () => { save.disabled = area.value === before; } });
  area.value = before;
  const save = h("button", {
    disabled: true,
    onclick: () => void attempt(async () => {
      await post("/api/text", { name, text: area.value, before }, "PUT");
      before = area.value;
      save.disabled = true;
      say(`${name} is written`);
      await refresh();
    }),
  }, `Write ${name}`);
  return h("details", {}, h("summary", {}, label), area, save);
}
